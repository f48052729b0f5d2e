//! Steering a run: start, pause, single generation, reset; seed and population; progress.

use bevy_egui::egui;

use super::title;
use crate::studio::command::Command;
use crate::studio::evolution::{Evolution, Status};
use crate::studio::look;

/// The panel, with what is being typed.
#[derive(Debug, Default)]
pub(super) struct EvolutionPanel {
    /// The seed's text while it is edited or wrong; none while it shows the seed itself.
    seed_text: Option<String>,
}

impl EvolutionPanel {
    /// Draws the panel and adds what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        title(ui, "Evolution");
        ui.horizontal(|ui| {
            let (label, command) = match run.status() {
                Status::Running => ("Pause", Command::Pause),
                Status::Finished => ("New run", Command::Start),
                Status::Ready | Status::Paused => ("Start", Command::Start),
            };
            let start = egui::Button::new(egui::RichText::new(label).strong())
                .fill(look::ACCENT.gamma_multiply(0.55))
                .min_size(egui::vec2(look::GAP * 10.0, 0.0));
            let mut button = |ui: &mut egui::Ui, button: egui::Button<'_>, hint: &str, command| {
                if ui.add(button).on_hover_text(hint).clicked() {
                    asked.push(command);
                }
            };
            button(ui, start, "Evolve in the background (E)", command);
            let single = egui::Button::new("One generation");
            button(
                ui,
                single,
                "Evolve to the end of a generation, then pause (G)",
                Command::SingleGeneration,
            );
            let hint =
                "Throw this run away and prepare a fresh one with the seed and population below";
            button(ui, egui::Button::new("Reset"), hint, Command::Reset);
        });
        self.progress(ui, run);
        self.fields(ui, run, asked);
    }

    fn progress(&self, ui: &mut egui::Ui, run: &Evolution) {
        let (done, population) = run.progress();
        let generations = run.settings().evolution.generations;
        let finished = run.reports().len();
        let (text, share) = match run.status() {
            Status::Finished => (format!("All {generations} generations done"), 1.0),
            status => {
                let held = match status {
                    Status::Ready => ", ready to start",
                    Status::Paused => ", paused",
                    Status::Running | Status::Finished => "",
                };
                let text = format!("Generation {} of {generations}{held}", finished + 1);
                (text, done as f32 / population as f32)
            }
        };
        ui.label(text);
        let inside = match run.run_hash() {
            Some(hash) => format!("run hash {hash:016x}"),
            None => format!("{done} of {population} snakes"),
        };
        ui.add(egui::ProgressBar::new(share).text(inside).fill(look::ACCENT.gamma_multiply(0.6)))
            .on_hover_text("Evaluated snakes of the current generation");
    }

    fn fields(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            let label = ui.label("Seed");
            let mut text = self.seed_text.clone().unwrap_or_else(|| run.next_seed().to_string());
            let field = egui::TextEdit::singleline(&mut text)
                .desired_width(look::GAP * 10.0)
                .margin(egui::Margin::symmetric(8, 4));
            let response = ui
                .add(field)
                .labelled_by(label.id)
                .on_hover_text("The same seed and settings give the same run, bit for bit");
            if response.changed() {
                self.seed_text = Some(text);
            }
            if response.lost_focus() {
                self.seed_text = match self.seed_text.take() {
                    Some(text) => self.commit_seed(text, asked),
                    None => None,
                };
            }
            let label = ui.label("Population");
            let mut population = run.next_population();
            let field = egui::DragValue::new(&mut population).range(1..=100_000).speed(2.0);
            let hint = "Snakes in a generation, 1 to 100000";
            if ui.add(field).labelled_by(label.id).on_hover_text(hint).changed() {
                asked.push(Command::SetPopulation(population));
            }
        });
        if let Some(text) = &self.seed_text
            && text.trim().parse::<u64>().is_err()
        {
            let problem = format!("Seed is \"{text}\"; allowed: 0 to {}", u64::MAX);
            ui.colored_label(look::PROBLEM, problem);
        }
        if run.next_run_differs() {
            let hint = "Reset to begin a run with these values.";
            ui.label(egui::RichText::new(hint).color(look::SECOND));
        }
    }

    /// Sends a seed that is a number; keeps a text that is none, for correction.
    fn commit_seed(&self, text: String, asked: &mut Vec<Command>) -> Option<String> {
        match text.trim().parse() {
            Ok(seed) => {
                asked.push(Command::SetSeed(seed));
                None
            }
            Err(_) => Some(text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::save::SavesFolder;
    use crate::studio::Options;
    use crate::studio::evolution::Engine;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn run() -> Evolution {
        let folder = std::env::temp_dir().join("snakes-and-stairs-panel-test");
        let options = Options {
            preset: "report".to_owned(),
            settings: Settings::default(),
            seed: 1,
            threads: 1,
            saves: SavesFolder::find(Some(&folder)),
            champion: None,
            window_size: (1280, 720),
            exit_after_frames: None,
        };
        Evolution::new(Engine::new(&options).expect("threads"))
    }

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
}
