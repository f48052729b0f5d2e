//! Steering a run: start, pause, single generation, reset; progress; how long and by which method it searches.

use bevy_egui::egui;

use super::number_field::NumberField;
use super::parameters::{Section, Sheet, controller, strategies};
use super::progress::progress;
use super::{explain, row, title_and};
use crate::evolve::{RunPlan, StrategyKind};
use crate::run::THREADS_RANGE;
use crate::studio::command::Command;
use crate::studio::evolution::{Evolution, Status, news_of};
use crate::studio::look;

/// The panel, with what is being typed.
#[derive(Debug, Default)]
pub(super) struct EvolutionPanel {
    seed: NumberField,
    threads: NumberField,
    sheet: Sheet,
}

impl EvolutionPanel {
    /// Draws the panel and adds what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        self.sheet.begin(ui, run);
        title_and(ui, "Evolution", |ui| preset_switch(ui, run, asked));
        // A click on a button also ends what is typed below it; the typed value comes first.
        let mut pressed = Vec::new();
        self.buttons(ui, run, &mut pressed);
        progress(ui, run);
        stopped_runs(ui, run, asked);
        self.fields(ui, run, asked);
        asked.append(&mut pressed);
    }

    fn buttons(&self, ui: &mut egui::Ui, run: &Evolution, pressed: &mut Vec<Command>) {
        let is_wrong = self.seed.problem().is_some() || self.sheet.has_problem();
        let status = run.status();
        let is_finished = status == Status::Finished;
        let (label, start) = match status {
            Status::Running => ("Pause", Command::Pause),
            Status::Finished => ("New run", Command::Start),
            Status::Ready | Status::Paused => ("Start", Command::Start),
        };
        let palette = look::of(ui);
        let can_start = !(is_finished && is_wrong);
        let text = egui::RichText::new(label).strong();
        let first = if can_start {
            egui::Button::new(text.color(palette.on_accent)).fill(palette.accent)
        } else {
            egui::Button::new(text)
        };
        let first = first.min_size(egui::vec2(look::GAP * 10.0, 0.0));
        let single = if is_finished {
            "The run is finished; \"New run\" begins another"
        } else {
            "Evolve to the end of a generation, then pause (G)"
        };
        let first_hint = if is_finished && !run.next_run_differs() {
            "Begin a run with the next seed (E)"
        } else {
            "Evolve in the background (E)"
        };
        let reset = if is_wrong {
            "Correct the value below first"
        } else {
            "Throw this run away and prepare it anew; or, if settings were changed, prepare a run with those"
        };
        ui.horizontal(|ui| {
            for (is_on, button, hint, command) in [
                (can_start, first, first_hint, start),
                (
                    !is_finished,
                    egui::Button::new("One generation"),
                    single,
                    Command::SingleGeneration,
                ),
                (!is_wrong, egui::Button::new("Reset"), reset, Command::Reset),
            ] {
                let response = ui.add_enabled(is_on, button);
                if response.on_hover_text(hint).on_disabled_hover_text(hint).clicked() {
                    pressed.push(command);
                }
            }
        });
    }

    fn fields(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            let hint = "The same seed and settings give the same run, bit for bit";
            let seed = self.seed.ui(ui, "Seed", hint, run.next_seed(), 0..=u64::MAX);
            asked.extend(seed.map(Command::SetSeed));
            let hint = "So many snakes are evaluated at a time; more than there are processors is no quicker. The \
                        result is the same for any number";
            let threads = self.threads.ui(ui, "Threads", hint, run.threads(), THREADS_RANGE);
            asked.extend(threads.map(Command::SetThreads));
        });
        for problem in [self.seed.problem(), self.threads.problem()].into_iter().flatten() {
            ui.colored_label(look::of(ui).problem, problem);
        }
        self.sheet.section(ui, run, &strategies::RUN, asked);
        founder(ui, run, asked);
        changes(ui, run);
        if run.next_run_differs() {
            let hint = "Reset to begin a run with these values.";
            ui.label(egui::RichText::new(hint).color(look::of(ui).second));
        }
        self.strategy(ui, run, asked);
        self.controller(ui, run, asked);
    }

    /// The method, with its settings, and those of the others.
    fn strategy(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        let chosen = run.next_settings().evolution.strategy;
        self.sheet.section(ui, run, &strategies::STRATEGY, asked);
        if let Some(section) = strategies::section_of(chosen) {
            self.folded(ui, run, section, true, asked);
        }
        // Novelty search makes its children as the genetic algorithm is told to.
        let is_shared = chosen == StrategyKind::Novelty;
        if is_shared && let Some(section) = strategies::section_of(StrategyKind::Ga) {
            self.folded(ui, run, section, false, asked);
        }
        let others = StrategyKind::ALL
            .into_iter()
            .filter(|kind| *kind != chosen && !(is_shared && *kind == StrategyKind::Ga));
        let header = egui::CollapsingHeader::new("Other strategies");
        let shown = header.show(ui, |ui| {
            for section in others.filter_map(strategies::section_of) {
                self.folded(ui, run, section, false, asked);
            }
        });
        shown.header_response.on_hover_text("What they are told once one of them is chosen");
    }

    /// What drives the joints, and what genomes may be.
    fn controller(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        self.sheet.section(ui, run, &controller::CONTROLLER, asked);
        for section in controller::GENOME {
            self.folded(ui, run, section, false, asked);
        }
    }

    /// A section that folds away.
    fn folded(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        section: &Section,
        is_open: bool,
        asked: &mut Vec<Command>,
    ) {
        // What has nothing to do with the chosen controller says so.
        let kind = run.next_settings().genome.controller;
        let is_idle = !controller::concerns(kind, section);
        let name = egui::RichText::new(section.title);
        let name = if is_idle { name.color(look::of(ui).text_weak) } else { name };
        // One that is chosen opens, whether or not it was opened among the others.
        let header = egui::CollapsingHeader::new(name)
            .id_salt((section.prefix, section.title, is_open))
            .default_open(is_open);
        let shown = header.show_unindented(ui, |ui| {
            if is_idle {
                explain(ui, "The chosen controller has no use for these.");
            }
            self.sheet.section(ui, run, section, asked);
        });
        shown.header_response.on_hover_text(section.about);
    }
}

/// From whom the next run begins, if from anybody, and the way back.
fn founder(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    let Some(name) = run.next_founder() else { return };
    ui.horizontal(|ui| {
        ui.label(format!("Begins from {name}"));
        let button = ui.small_button("From nothing");
        if button.on_hover_text("Draw the first generation of the next run from nothing").clicked()
        {
            asked.push(Command::ForgetFounder);
        }
    });
}

/// What was changed of the current run on its way.
fn changes(ui: &mut egui::Ui, run: &Evolution) {
    let changes = run.changes();
    let text = match changes.len() {
        0 => return,
        1 => "1 setting changed on the way".to_owned(),
        several => format!("{several} settings changed on the way"),
    };
    let label = ui.label(egui::RichText::new(text).color(look::of(ui).second));
    label.on_hover_ui(|ui| {
        // The latest are what is remembered.
        let latest = &changes[changes.len().saturating_sub(MOST_LISTED)..];
        let lines: Vec<String> = latest.iter().map(news_of).collect();
        ui.label(lines.join("\n"));
    });
}

/// So many changes are listed; more would not fit into a hint.
const MOST_LISTED: usize = 12;
/// Draws the way to the report's run, or back to the climb, and adds what was asked for.
fn preset_switch(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    let (label, preset, hint) = if run.next_preset() == REPORT {
        ("The climb", CLIMB, "Take the preset that climbs to the top for the next run")
    } else {
        ("The report's run", REPORT, "Take the report's own method and world for the next run")
    };
    if ui.small_button(label).on_hover_text(hint).clicked() {
        asked.push(Command::SetPreset(preset.to_owned()));
    }
}

/// The preset of the report's run.
const REPORT: &str = "report";
/// The preset of the climb to the landing.
const CLIMB: &str = "climb";

/// Runs that were stopped before their end, to go on with.
fn stopped_runs(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    let header = egui::CollapsingHeader::new("Continue a stopped run");
    let opened = header.show(ui, |ui| {
        let Some(stopped) = run.stopped() else {
            return explain(ui, "Looking ...");
        };
        let mut stopped = stopped.peekable();
        if stopped.peek().is_none() {
            explain(ui, "No other run was stopped before its end.");
        }
        for summary in stopped {
            let RunPlan { preset, seed, settings, .. } = &summary.plan;
            let (finished, all) = (summary.finished, settings.evolution.generations);
            let (name, behind) = (format!("{preset}, seed {seed}"), format!("{finished} of {all}"));
            let hint = format!(
                "{finished} of {all} generations are finished; the current run is kept.\n{}",
                summary.folder.display()
            );
            if row(ui, false, &name, &behind).on_hover_text(hint).clicked() {
                asked.push(Command::Continue(summary.folder.clone()));
            }
        }
    });
    if opened.header_response.clicked() {
        asked.push(Command::ListRuns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::evolution::prepared_run as run;
    use crate::studio::panels::parameters::tests::assert_nothing_is_wider_than;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// What the panel sends when a person does `act`.
    fn sent(run: &Evolution, act: impl FnOnce(&mut Harness<'_, Vec<Command>>)) -> Vec<Command> {
        let mut panel = EvolutionPanel::default();
        let mut harness = Harness::builder()
            .with_size(egui::vec2(look::PANEL_WIDTH, 1600.0))
            .build_ui_state(|ui, asked| panel.ui(ui, run, asked), Vec::new());
        act(&mut harness);
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn each_button_sends_its_command() {
        let run = run();
        for (label, command) in [
            ("Start", Command::Start),
            ("One generation", Command::SingleGeneration),
            ("Reset", Command::Reset),
        ] {
            assert_eq!(sent(&run, |harness| harness.get_by_label(label).click()), [command]);
        }
    }

    #[test]
    fn while_a_run_goes_on_the_first_button_pauses_it() {
        let mut run = run();
        run.start().expect("a thread");
        assert_eq!(sent(&run, |harness| harness.get_by_label("Pause").click()), [Command::Pause]);
    }

    #[test]
    fn the_founder_of_the_next_run_can_be_forgotten() {
        let mut run = run();
        let champion = crate::save::shipped_champion().expect("well formed").champion;
        run.found_run(&champion, "climber").expect("it fits");
        let asked = sent(&run, |harness| {
            assert!(harness.query_by_label("Begins from climber").is_some());
            harness.get_by_label("From nothing").click();
        });
        assert_eq!(asked, [Command::ForgetFounder]);
    }

    #[test]
    fn a_typed_seed_is_sent_when_the_field_is_left_and_a_wrong_one_is_not() {
        let run = run();
        let type_seed = |text: &'static str| {
            sent(&run, move |harness| {
                harness.get_by_label("Seed").focus();
                harness.run();
                harness.get_by_label("Seed").type_text(text);
                harness.run();
                harness.key_press(egui::Key::Enter);
                harness.run();
            })
        };
        assert_eq!(type_seed("23"), [Command::SetSeed(23)], "in place of the 1 that was there");
        assert_eq!(type_seed("x"), []);
    }

    #[test]
    fn with_a_wrong_value_in_a_field_reset_is_off() {
        let run = run();
        let sent = sent(&run, |harness| {
            harness.get_by_label("Population").focus();
            harness.run();
            harness.get_by_label("Population").type_text("a");
            harness.run();
            assert!(
                harness.query_by_label_contains("Population is \"a\"; allowed: 1 to").is_some()
            );
            harness.get_by_label("Reset").click();
            harness.run();
        });
        assert_eq!(sent, []);
    }

    #[test]
    fn a_seed_that_is_still_being_typed_counts_when_a_button_is_clicked() {
        let run = run();
        let sent = sent(&run, |harness| {
            harness.get_by_label("Seed").focus();
            harness.run();
            harness.get_by_label("Seed").type_text("9");
            harness.run();
            harness.get_by_label("Start").click();
            harness.run();
        });
        assert_eq!(sent, [Command::SetSeed(9), Command::Start]);
    }

    /// What is sent when a person clicks on one label after another.
    fn clicked(run: &Evolution, labels: &[&str]) -> Vec<Command> {
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

    fn set(field: &str, text: &str) -> Command {
        Command::SetField { field: field.to_owned(), text: text.to_owned() }
    }

    #[test]
    fn every_strategy_and_controller_can_be_chosen() {
        let run = run();
        for kind in &StrategyKind::ALL[1..] {
            let asked = clicked(&run, &["list Strategy", kind.title()]);
            assert_eq!(asked, [set("evolution.strategy", kind.name())]);
        }
        for (title, name) in [("Wave", "wave"), ("Gait", "gait")] {
            let asked = clicked(&run, &["list Controller", title]);
            assert_eq!(asked, [set("genome.controller", name)]);
        }
    }

    #[test]
    fn the_chosen_strategy_shows_its_settings_and_the_others_can_be_reached() {
        let mut run = run();
        let is_shown = |run: &Evolution, clicks: &[&str], label: &str| {
            let mut is_shown = false;
            sent(run, |harness| {
                for click in clicks {
                    harness.get_by_label(click).click();
                    harness.run();
                }
                is_shown = harness.query_all_by_label(label).next().is_some();
            });
            is_shown
        };
        assert!(is_shown(&run, &[], "Mutation decay"));
        assert!(!is_shown(&run, &[], "Tournament"));
        assert!(is_shown(&run, &["Other strategies", "Genetic algorithm"], "Tournament"));
        run.set_field("evolution.strategy", "cma_es").expect("allowed");
        assert!(!is_shown(&run, &[], "Mutation decay"));
        assert!(is_shown(&run, &[], "Newborns first"));
    }

    #[test]
    fn typed_population_and_threads_are_sent() {
        let run = run();
        for (label, asked) in [
            ("Population", Command::SetPopulation(40)),
            ("Generations", set("evolution.generations", "40")),
            ("Threads", Command::SetThreads(40)),
        ] {
            let sent = sent(&run, |harness| {
                harness.get_by_label(label).focus();
                harness.run();
                harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
                harness.run();
                harness.get_by_label(label).type_text("40");
                harness.run();
                harness.key_press(egui::Key::Enter);
                harness.run();
            });
            assert_eq!(sent, [asked]);
        }
    }

    #[test]
    fn the_reports_run_and_the_climb_are_a_click_from_each_other() {
        let mut run = run();
        assert_eq!(clicked(&run, &["The climb"]), [Command::SetPreset("climb".to_owned())]);
        run.set_preset("climb").expect("shipped");
        assert_eq!(clicked(&run, &["The report's run"]), [Command::SetPreset("report".to_owned())]);
    }

    #[test]
    fn a_wrong_value_in_a_section_that_is_gone_no_longer_stands_in_the_way() {
        let mut run = run();
        let mut sheet = Sheet::default();
        let halving = strategies::section_of(StrategyKind::Halving).expect("it has settings");
        let context = egui::Context::default();
        let is_wrong = |run: &Evolution, sheet: &mut Sheet, is_drawn: bool| {
            for _ in 0..3 {
                drop(context.run_ui(egui::RawInput::default(), |ui| {
                    sheet.begin(ui, run);
                    if is_drawn {
                        sheet.section(ui, run, halving, &mut Vec::new());
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
        for width in [300.0, 459.0, 480.0, 900.0] {
            let mut panel = EvolutionPanel::default();
            let size = egui::vec2(width, 4000.0);
            let mut harness = Harness::builder().with_size(size).build_ui_state(
                |ui, asked| {
                    look::apply(ui.ctx());
                    panel.ui(ui, &run, asked);
                },
                Vec::new(),
            );
            harness.run();
            for title in ["Other strategies", "Torques", "Waves and gaits", "Newborns"] {
                harness.get_by_label(title).click();
                harness.run();
            }
            for kind in &StrategyKind::ALL[1..5] {
                harness.get_by_label(kind.title()).click();
                harness.run();
            }
            assert_nothing_is_wider_than(&harness, width);
            // The named of each section are there.
            for label in ["Cooling", "First step of CMA-ES", "Columns and rows", "Neighbours"] {
                assert!(harness.query_all_by_label(label).next().is_some(), "{label}");
            }
        }
    }
}
