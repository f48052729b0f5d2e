//! What there is to explore: the front of distance and energy, the archive of the best of every kind, and how
//! methods compare.

use bevy_egui::egui;

use super::archive_map::archive_map;
use super::champions::Shown;
use super::curves::CurvesPanel;
use super::front_plot::front_plot;
use super::{explain, title};
use crate::evolve::StrategyKind;
use crate::save::Comparison;
use crate::studio::command::Command;
use crate::studio::evolution::Evolution;
use crate::studio::look;

/// The panel, with the comparison that is open.
#[derive(Debug)]
pub(super) struct ExplorePanel {
    curves: Option<CurvesPanel>,
}

impl ExplorePanel {
    /// The panel, with a comparison if one is open.
    pub fn new(comparison: Option<&Comparison>) -> Self {
        Self { curves: comparison.map(CurvesPanel::new) }
    }

    /// Draws the panel and adds what was asked for.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        shown: Option<Shown>,
        asked: &mut Vec<Command>,
    ) {
        // Whoever opened a comparison came for it.
        if let Some(curves) = &mut self.curves {
            title(ui, "Comparison");
            curves.ui(ui, look::PLOT_HEIGHT);
        }
        title(ui, "Distance and energy");
        let exploration = run.exploration();
        match exploration.map(|exploration| &exploration.front) {
            Some(front) if front.members().len() > 0 => {
                front_plot(ui, front, shown, look::PLOT_HEIGHT, asked)
            }
            Some(_) => explain(ui, "Nobody has got ahead of the start yet."),
            None => explain(ui, "Who gets furthest for the least energy will appear here."),
        }
        title(ui, "Archive");
        match exploration.and_then(|exploration| exploration.archive.as_ref()) {
            Some(archive) => {
                let unit = run.settings().trial.fitness.unit();
                archive_map(ui, archive, unit, shown, look::MAP_HEIGHT, asked);
            }
            None if run.settings().evolution.strategy == StrategyKind::MapElites => {
                explain(ui, "The best of every kind will appear here.");
            }
            None => explain(ui, "MAP-Elites keeps one: the best of every kind of behaviour."),
        }
        if self.curves.is_none() {
            title(ui, "Comparison");
            explain(
                ui,
                "None is open. \"snakes compare\" makes one, \"snakes --comparison FILE\" opens it.",
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::evolution::{explored_run, prepared_run};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// Whether these texts are in the panel.
    fn has(run: &Evolution, texts: &[&str]) -> Vec<bool> {
        let mut panel = ExplorePanel::new(None);
        let mut asked = Vec::new();
        let harness = Harness::new_ui(|ui| panel.ui(ui, run, None, &mut asked));
        texts.iter().map(|text| harness.query_by_label_contains(text).is_some()).collect()
    }

    #[test]
    fn it_says_what_is_missing_and_only_that() {
        let texts = ["MAP-Elites keeps one", "will appear here", "snakes compare", "Coverage"];
        assert_eq!(has(&prepared_run(), &texts), [true, true, true, false]);
        assert_eq!(has(&explored_run(), &texts), [false, false, true, true]);
    }
}
