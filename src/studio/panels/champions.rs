//! The best of every generation, to click and replay.

use bevy_egui::egui;

use super::{explain, row, title};
use crate::evolve::Champion;
use crate::run::GenerationReport;
use crate::studio::command::Command;

/// What of the list is on the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    /// The champion that the studio opened with.
    Opening,
    /// This individual of the current run.
    Found {
        /// The generation that found it; the first is 1.
        generation: u32,
        /// Its index in that generation.
        individual: u32,
    },
}

/// The list.
#[derive(Debug, Default)]
pub(super) struct ChampionsPanel;

impl ChampionsPanel {
    /// Draws the list and adds what was asked for.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        opening: &Champion,
        reports: &[GenerationReport],
        shown: Option<Shown>,
        asked: &mut Vec<Command>,
    ) {
        title(ui, "Champions");
        let hint = "Click to replay";
        let saved = row(ui, shown == Some(Shown::Opening), "Saved", &opening.reached());
        if saved.on_hover_text(hint).clicked() {
            asked.push(Command::ShowOpening);
        }
        for report in reports {
            let generation = report.generation;
            let name = format!("Generation {generation}");
            let Some(champion) = &report.champion else {
                explain(ui, &format!("{name}: all disqualified"));
                continue;
            };
            let individual = champion.origin.individual;
            let is_shown = shown.is_some_and(|shown| shown.is(generation, individual));
            if row(ui, is_shown, &name, &champion.reached()).on_hover_text(hint).clicked() {
                asked.push(Command::ShowGeneration(generation));
            }
        }
        if reports.is_empty() {
            explain(ui, "The best of each generation will appear here.");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, Settings};
    use crate::run::{Control, Experiment, pool};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_click_on_a_generation_shows_its_champion() {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings));
        let pool = pool(1).expect("a pool");
        let mut report = || experiment.run_generation(&pool, &Control::default()).expect("done");
        let reports = [report(), report()];
        let opening = reports[0].champion.as_ref().expect("somebody was healthy");
        let mut harness = Harness::new_ui_state(
            |ui, asked| ChampionsPanel.ui(ui, opening, &reports, Some(Shown::Opening), asked),
            Vec::new(),
        );
        harness.get_by_label_contains("Generation 2").click();
        harness.run();
        assert_eq!(*harness.state(), [Command::ShowGeneration(2)]);
    }
}
