//! Tests of the run panel.

use super::*;
use crate::studio::panels::settings::tests::{assert_nothing_is_wider_than, click, every_section};
use crate::studio::panels::testing::{self, Sent, press, set, shows, type_into};
use crate::studio::state::current_run::prepared_run as run;
use crate::studio::ui::notifications::Notices;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use snakes_core::evolve::{HalvingSettings, StrategyKind};

/// Calls `act` on the panel. Returns the commands that were sent.
fn sent(run: &CurrentRun, act: impl FnOnce(&mut Sent<'_>)) -> Vec<Command> {
    let mut panel = EvolutionPanel::default();
    panel.unfold(&[HOW_IT_LEARNS.to_owned()].into());
    let mut harness = Harness::builder()
        .with_size(egui::vec2(theme::PANEL_WIDTH, 1600.0))
        .build_ui_state(|ui, commands| panel.ui(ui, run, |_, _| {}, commands), Vec::new());
    act(&mut harness);
    harness.run();
    harness.state().clone()
}

#[test]
fn each_button_sends_its_command() {
    let run = run();
    for (label, command) in [
        ("Start evolution", Command::Run(RunCommand::Start)),
        ("One generation", Command::Run(RunCommand::SingleGeneration)),
        ("New run", Command::Run(RunCommand::New)),
    ] {
        assert_eq!(sent(&run, |harness| harness.get_by_label(label).click()), [command]);
    }
}

#[test]
fn a_finished_run_offers_more_generations_and_a_new_run() {
    let mut run = run();
    run.run_hash = Some(1);
    for (label, command) in
        [("Continue for 6 generations", RunCommand::Extend), ("New run", RunCommand::New)]
    {
        let sent = sent(&run, |harness| {
            assert!(!shows(harness, "One generation"), "there is none left");
            harness.get_by_label(label).click();
        });
        assert_eq!(sent, [Command::Run(command)]);
    }
}

#[test]
fn the_first_button_pauses_a_running_run() {
    let mut run = run();
    run.start().expect("a thread");
    assert_eq!(
        sent(&run, |harness| harness.get_by_label("Pause evolution").click()),
        [Command::Run(RunCommand::Pause)]
    );
}

#[test]
fn the_founder_of_the_next_run_can_be_removed() {
    let mut run = run();
    let champion = snakes_core::save::shipped_champion().expect("well formed").champion;
    run.start_next_from(&champion, "climber").expect("it fits");
    let commands = sent(&run, |harness| {
        assert!(harness.query_by_label("Starts from \"climber\"").is_some());
        harness.get_by_label("Start from scratch").click();
    });
    assert_eq!(commands, [Command::Plan(PlanCommand::ForgetFounder)]);
}

#[test]
fn a_valid_seed_is_sent_on_enter_and_an_invalid_one_is_not() {
    let run = run();
    let type_seed = |text: &'static str| {
        sent(&run, move |harness| {
            type_into(harness, "Seed", text);
            press(harness, egui::Key::Enter);
        })
    };
    assert_eq!(
        type_seed("23"),
        [Command::Plan(PlanCommand::SetSeed(23))],
        "in place of the 1 that was there"
    );
    assert_eq!(type_seed("x"), []);
}

#[test]
fn a_new_run_is_disabled_while_a_value_is_invalid() {
    let run = run();
    let sent = sent(&run, |harness| {
        type_into(harness, "Population", "a");
        assert!(shows(harness, "Population is \"a\"; allowed: 1 to"));
        click(harness, "New run");
    });
    assert_eq!(sent, []);
}

#[test]
fn a_typed_seed_is_sent_before_the_command_of_a_button() {
    let run = run();
    let sent = sent(&run, |harness| {
        type_into(harness, "Seed", "9");
        click(harness, "Start evolution");
    });
    assert_eq!(sent, [Command::Plan(PlanCommand::SetSeed(9)), Command::Run(RunCommand::Start)]);
}

/// Clicks on these labels. Returns the commands that were sent.
fn clicked(run: &CurrentRun, labels: &[&str]) -> Vec<Command> {
    sent(run, |harness| {
        for label in labels {
            match label.strip_prefix("list ") {
                Some(list) => {
                    let role = egui::accesskit::Role::ComboBox;
                    harness.get_by_role_and_label(role, list).click();
                }
                None => harness.get_by_label(label).click(),
            }
            harness.run();
        }
    })
}

#[test]
fn every_strategy_and_controller_can_be_chosen() {
    let run = run();
    for kind in &StrategyKind::ALL[1..] {
        let commands = clicked(&run, &["list Strategy", kind.title()]);
        assert_eq!(commands, [set("evolution.strategy", kind.name())]);
    }
    for (title, name) in [("Wave", "wave"), ("Gait", "gait")] {
        let commands = clicked(&run, &["list Controller", title]);
        assert_eq!(commands, [set("genome.controller", name)]);
    }
}

#[test]
fn the_selected_strategy_shows_its_settings_and_the_others_are_reachable() {
    let mut run = run();
    let is_shown = |run: &CurrentRun, clicks: &[&str], label: &str| {
        let mut is_shown = false;
        sent(run, |harness| {
            for label in clicks {
                click(harness, label);
            }
            is_shown = harness.query_all_by_label(label).next().is_some();
        });
        is_shown
    };
    assert!(is_shown(&run, &[], "Mutation decay"));
    assert!(!is_shown(&run, &[], "Tournament size"));
    assert!(is_shown(&run, &["Other strategies", "Genetic algorithm"], "Tournament size"));
    run.set_field("evolution.strategy", "cma_es").expect("allowed");
    assert!(!is_shown(&run, &[], "Mutation decay"));
    assert!(is_shown(&run, &[], "Random snakes first"));
}

#[test]
fn typed_population_and_threads_are_sent() {
    let run = run();
    for (label, commands) in [
        ("Population", set("evolution.population", "40")),
        ("Generations", set("evolution.generations", "40")),
        ("Threads", Command::Run(RunCommand::SetThreads(40))),
    ] {
        let sent = sent(&run, |harness| {
            harness.get_by_label(label).focus();
            harness.run();
            harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
            harness.run();
            harness.get_by_label(label).type_text("40");
            harness.run();
            press(harness, egui::Key::Enter);
        });
        assert_eq!(sent, [commands]);
    }
}

#[test]
fn one_button_runs_the_reports_experiment_and_one_the_standard_climb() {
    let mut run = run();
    let begun = |preset: &str| {
        [Command::Plan(PlanCommand::SetPreset(preset.to_owned())), Command::Run(RunCommand::New)]
    };
    assert_eq!(clicked(&run, &["Run the standard climb"]), begun("climb"));
    run.set_preset("climb").expect("shipped");
    assert_eq!(clicked(&run, &["Run the report's experiment"]), begun("report"));
}

#[test]
fn the_first_view_has_the_main_settings_and_the_others_are_below_a_fold() {
    let mut run = run();
    run.set_preset("climb").expect("shipped");
    let mut panel = EvolutionPanel::default();
    let mut harness = Harness::builder()
        .with_size(egui::vec2(theme::PANEL_WIDTH, 1600.0))
        .build_ui_state(|ui, commands| panel.ui(ui, &run, |_, _| {}, commands), Vec::new());
    harness.run();
    for shown in ["Friction", "Rise", "Bend limit", "Initial step size"] {
        assert!(harness.query_all_by_label_contains(shown).next().is_some(), "{shown}");
    }
    assert!(!shows(&harness, "Seed") && !shows(&harness, "Strategy"));
    click(&mut harness, HOW_IT_LEARNS);
    assert!(shows(&harness, "Seed") && shows(&harness, "Strategy"));
}

#[test]
fn the_hash_of_a_finished_run_is_told_below_the_fold_and_by_a_command() {
    let mut run = run();
    run.run_hash = Some(0xc0ffee);
    let hash = "Run hash 0000000000c0ffee";
    let mut panel = EvolutionPanel::default();
    let mut harness =
        testing::panel([400.0, 1600.0], |ui, commands| panel.ui(ui, &run, |_, _| {}, commands));
    assert!(!shows(&harness, hash));
    testing::clicked(&mut harness, HOW_IT_LEARNS);
    harness.run();
    assert!(shows(&harness, hash));
    drop(harness);
    let mut notices = Notices::default();
    run.apply(&RunCommand::ShowHash, &mut notices).expect("finished");
    assert_eq!(notices.last(), Some(hash));
    run.run_hash = None;
    run.apply(&RunCommand::ShowHash, &mut notices).expect_err("there is none yet");
}

#[test]
fn an_invalid_value_of_a_hidden_section_is_ignored() {
    let mut run = run();
    let mut sheet = Sheet::default();
    let halving = HalvingSettings::SECTION;
    let context = egui::Context::default();
    let is_wrong = |run: &CurrentRun, sheet: &mut Sheet, is_drawn: bool| {
        for _ in 0..3 {
            drop(context.run_ui(egui::RawInput::default(), |ui| {
                sheet.begin(ui, run);
                if is_drawn {
                    sheet.section(ui, halving);
                }
            }));
        }
        sheet.has_problem()
    };
    assert!(!is_wrong(&run, &mut sheet, true));
    sheet.keep_wrong("evolution.halving.parents", "x", "4");
    assert!(is_wrong(&run, &mut sheet, true));
    assert!(!is_wrong(&run, &mut sheet, false), "out of sight");
    run.set_field("evolution.halving.parents", "5").expect("allowed");
    assert!(!is_wrong(&run, &mut sheet, true), "out of date");
}

#[test]
fn at_every_width_nothing_is_wider_than_the_panel() {
    let run = run();
    for width in [300.0, theme::PANEL_WIDTH, 459.0, 480.0, 900.0] {
        let mut panel = EvolutionPanel::default();
        panel.unfold(&every_section());
        panel.unfold(&[HOW_IT_LEARNS.to_owned()].into());
        let size = egui::vec2(width, 4000.0);
        let mut harness = Harness::builder().with_size(size).build_ui_state(
            |ui, commands| {
                theme::apply(ui.ctx());
                panel.ui(ui, &run, |_, _| {}, commands);
            },
            Vec::new(),
        );
        harness.run();
        for title in ["Other strategies", "Torques", "Waves and gaits", "Random snakes"] {
            click(&mut harness, title);
        }
        for kind in &StrategyKind::ALL[1..5] {
            click(&mut harness, kind.title());
        }
        assert_nothing_is_wider_than(&harness, width);
        // Each section shows its settings when it is unfolded.
        for label in ["Cooling", "Initial step size", "Columns and rows", "Neighbours"] {
            assert!(harness.query_all_by_label(label).next().is_some(), "{label}");
        }
    }
}
