//! Steering a run: start, pause, single generation, reset; seed and population; progress.

use bevy_egui::egui;

use super::method::{method, preset_switch};
use super::number_field::NumberField;
use super::{explain, row, title_and};
use crate::evolve::{LARGEST_POPULATION, RunPlan};
use crate::studio::command::Command;
use crate::studio::evolution::{Evolution, Status, news_of};
use crate::studio::look;

/// The panel, with what is being typed.
#[derive(Debug, Default)]
pub(super) struct EvolutionPanel {
    seed: NumberField,
    population: NumberField,
}

impl EvolutionPanel {
    /// Draws the panel and adds what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        title_and(ui, "Evolution", |ui| preset_switch(ui, run, asked));
        // A click on a button also ends what is typed below it; the typed value comes first.
        let mut pressed = Vec::new();
        self.buttons(ui, run, &mut pressed);
        self.progress(ui, run);
        self.fields(ui, run, asked);
        stopped_runs(ui, run, asked);
        asked.append(&mut pressed);
    }

    fn buttons(&self, ui: &mut egui::Ui, run: &Evolution, pressed: &mut Vec<Command>) {
        let is_wrong = self.seed.problem().or(self.population.problem()).is_some();
        let status = run.status();
        let is_finished = status == Status::Finished;
        let (label, start) = match status {
            Status::Running => ("Pause", Command::Pause),
            Status::Finished => ("New run", Command::Start),
            Status::Ready | Status::Paused => ("Start", Command::Start),
        };
        let palette = look::of(ui);
        let first = egui::Button::new(egui::RichText::new(label).strong().color(palette.on_accent))
            .fill(palette.accent)
            .min_size(egui::vec2(look::GAP * 10.0, 0.0));
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
            "Throw this run away and prepare it anew; or, with another seed or population, prepare that"
        };
        ui.horizontal(|ui| {
            for (is_on, button, hint, command) in [
                (!(is_finished && is_wrong), first, first_hint, start),
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

    fn progress(&self, ui: &mut egui::Ui, run: &Evolution) {
        let (done, population) = run.progress();
        let generations = run.settings().evolution.generations;
        let finished = run.reports().len();
        let (text, share) = match run.status() {
            // Larger generations make for fewer of them.
            Status::Finished => (format!("All {finished} generations done"), 1.0),
            status => {
                let held = match status {
                    Status::Ready => ", ready to start",
                    Status::Paused => ", paused",
                    Status::Running | Status::Finished => "",
                };
                let text = format!("Generation {} of {generations}{held}", finished + 1);
                (text, done as f32 / population.max(1) as f32)
            }
        };
        ui.label(text);
        let inside = match run.run_hash() {
            Some(hash) => format!("run hash {hash:016x}"),
            None => format!("{done} of {population} snakes"),
        };
        ui.add(egui::ProgressBar::new(share).text(inside).fill(look::of(ui).accent_soft))
            .on_hover_text("Evaluated snakes of the current generation");
    }

    fn fields(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            let hint = "The same seed and settings give the same run, bit for bit";
            let seed = self.seed.ui(ui, "Seed", hint, run.next_seed(), 0..=u64::MAX);
            asked.extend(seed.map(Command::SetSeed));
            let hint = "Snakes in a generation, 1 to 100000. A run under way takes it from its next generation on, if its \
                        method allows that";
            let range = 1..=LARGEST_POPULATION;
            let now = run.next_population();
            let population = self.population.ui(ui, "Population", hint, now, range);
            asked.extend(population.map(Command::SetPopulation));
        });
        for problem in [self.seed.problem(), self.population.problem()].into_iter().flatten() {
            ui.colored_label(look::of(ui).problem, problem);
        }
        method(ui, run, asked);
        founder(ui, run, asked);
        changes(ui, run);
        if run.next_run_differs() {
            let hint = "Reset to begin a run with these values.";
            ui.label(egui::RichText::new(hint).color(look::of(ui).second));
        }
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
    let lines: Vec<String> = run.changes().iter().map(news_of).collect();
    let text = match lines.len() {
        0 => return,
        1 => "1 setting changed on the way".to_owned(),
        several => format!("{several} settings changed on the way"),
    };
    let label = ui.label(egui::RichText::new(text).color(look::of(ui).second));
    // The latest are what is remembered.
    let latest = lines[lines.len().saturating_sub(MOST_LISTED)..].join("\n");
    label.on_hover_text(latest);
}

/// So many changes are listed; more would not fit into a hint.
const MOST_LISTED: usize = 12;

/// Runs that were stopped before their end, to go on with.
fn stopped_runs(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    let header = egui::CollapsingHeader::new("Continue a stopped run");
    let opened = header.show(ui, |ui| {
        let Some(stopped) = run.stopped() else {
            return explain(ui, "Looking ...");
        };
        if stopped.is_empty() {
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
        asked.push(Command::ListStoppedRuns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::evolution::prepared_run as run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// What the panel sends when a person does `act`.
    fn sent(run: &Evolution, act: impl FnOnce(&mut Harness<'_, Vec<Command>>)) -> Vec<Command> {
        let mut panel = EvolutionPanel::default();
        let mut harness = Harness::new_ui_state(|ui, asked| panel.ui(ui, run, asked), Vec::new());
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
        assert_eq!(type_seed("23"), [Command::SetSeed(123)], "appended to the 1 that was there");
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
                harness.query_by_label_contains("Population is \"500a\"; allowed: 1 to").is_some()
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
        assert_eq!(sent, [Command::SetSeed(19), Command::Start]);
    }
}
