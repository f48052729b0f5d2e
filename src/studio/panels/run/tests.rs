//! Tests of the run panel.

use super::*;
use crate::studio::panels::testing::{
    self, Sent, assert_fits, assert_shows, click, every_section, press, set, shows, type_into,
};
use crate::studio::state::current_run::prepared_run as run;
use crate::studio::ui::notifications::Notices;
use egui_kittest::kittest::Queryable;
use snakes_core::evolve::{HalvingSettings, StrategyKind};

/// Calls `act` on the panel. Returns the commands that were sent.
fn sent(run: &CurrentRun, act: impl FnOnce(&mut Sent<'_>)) -> Vec<Command> {
    let mut panel = EvolutionPanel::default();
    panel.sheet.unfold(&[METHOD_KEY.to_owned()].into());
    let size = [theme::PANEL_WIDTH, 1600.0];
    testing::sent_by(testing::panel(size, |ui| panel.ui(ui, run, |_| ())), act)
}

#[test]
fn each_button_of_a_run_that_is_ready_runs_or_is_finished_sends_its_command() {
    let (ready, mut running, mut finished) = (run(), run(), run());
    running.start().expect("a thread");
    finished.run_hash = Some(1);
    for (run, label, command) in [
        (&ready, "Start evolution", RunCommand::Start),
        (&ready, "One generation", RunCommand::SingleGeneration),
        (&ready, "New run", RunCommand::New),
        (&running, "Pause evolution", RunCommand::Pause),
        (&finished, "Continue for 6 generations", RunCommand::Extend),
        (&finished, "New run", RunCommand::New),
    ] {
        let sent = sent(run, |harness| {
            let is_finished = run.run_hash.is_some();
            assert_eq!(shows(harness, "One generation"), !is_finished, "none is left");
            harness.get_by_label(label).click();
        });
        assert_eq!(sent, [Command::Run(command)], "{label}");
    }
}

#[test]
fn the_founder_of_the_next_run_can_be_removed() {
    let mut run = run();
    let champion = snakes_core::save::shipped_champion().expect("well formed").champion;
    run.start_next_from(&champion, "Generation 27 of another run, edited").expect("it fits");
    let commands = sent(&run, |harness| {
        assert_fits(harness, theme::PANEL_WIDTH);
        assert!(shows(harness, "\"New run\" starts from \"Generation 27 of another run, edited\""));
        harness.get_by_label("Start from scratch").click();
    });
    assert_eq!(commands, [Command::Plan(PlanCommand::ForgetFounder)]);
}

#[test]
fn a_new_run_is_disabled_while_a_value_is_invalid() {
    let sent = sent(&run(), |harness| {
        type_into(harness, "Population", "a");
        assert!(shows(harness, "Population is \"a\"; allowed: 1 to"));
        click(harness, "New run");
    });
    assert_eq!(sent, []);
}

#[test]
fn a_typed_seed_is_sent_before_the_command_of_a_button() {
    let sent = sent(&run(), |harness| {
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
fn a_valid_number_replaces_the_one_before_on_enter_and_an_invalid_one_is_not_sent() {
    let run = run();
    for (label, text, command) in [
        ("Population", "40", Some(set("evolution.population", "40"))),
        ("Generations", "40", Some(set("evolution.generations", "40"))),
        ("Threads", "40", Some(Command::Run(RunCommand::SetThreads(40)))),
        ("Seed", "23", Some(Command::Plan(PlanCommand::SetSeed(23)))),
        ("Seed", "x", None),
    ] {
        let sent = sent(&run, |harness| {
            type_into(harness, label, text);
            press(harness, egui::Key::Enter);
        });
        assert!(sent.iter().eq(&command), "{label} {text}: {sent:?}");
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
fn the_first_view_has_the_main_settings_and_the_others_and_the_hash_are_below_a_fold() {
    let mut run = run();
    run.set_preset("climb").expect("shipped");
    run.run_hash = Some(0xc0ffee);
    let hash = "Run hash 0000000000c0ffee";
    let mut panel = EvolutionPanel::default();
    let mut harness = testing::panel([400.0, 1600.0], |ui| panel.ui(ui, &run, |_| ()));
    assert_shows(&harness, &["Friction", "Rise", "Bend limit", "Size of first mutations"]);
    let below = ["Seed", "Strategy", hash];
    assert!(below.iter().all(|text| !shows(&harness, text)));
    click(&mut harness, METHOD);
    assert_shows(&harness, &below);
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
    sheet.keep("evolution.halving.parents", "x".to_owned(), Some("wrong".to_owned()), "4");
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
        panel.sheet.unfold(&every_section());
        panel.sheet.unfold(&[METHOD_KEY.to_owned()].into());
        let mut harness = testing::panel([width, 4000.0], |ui| {
            theme::apply(ui.ctx());
            panel.ui(ui, &run, |_| ());
        });
        for title in ["Other strategies", "Torques", "Waves and gaits", "Random snakes"] {
            click(&mut harness, title);
        }
        for kind in &StrategyKind::ALL[1..5] {
            click(&mut harness, kind.title());
        }
        assert_fits(&harness, width);
        // Each section shows its settings when it is unfolded.
        for label in ["Cooling", "Size of first mutations", "Columns and rows", "Neighbours"] {
            assert!(harness.query_all_by_label(label).next().is_some(), "{label}");
        }
    }
}
