//! Comparison of methods: learning curves, and a table with the results of each arm of a study.

use std::collections::BTreeSet;

use bevy_egui::egui;

use super::chart_kind::ChartKind;
use super::draw;
use super::view::ChartView;
use crate::studio::ui::plot_axes::{axis_name, number};
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::genome::ControllerKind;
use snakes_core::save::StudyRuns;
use snakes_lab::plot::Figure;
use snakes_lab::statistics::Quartiles;
use snakes_lab::study::{controllers, curves, short_title};

/// Panel of a study: its learning curves for the selected controller, and its table.
pub(super) struct CurvesPanel {
    study: StudyRuns,
    /// Controller whose learning curves are shown.
    controller: ControllerKind,
    /// Learning curves that are shown.
    pub view: ChartView,
}

impl CurvesPanel {
    /// Creates the panel for the runs of a study.
    pub fn new(study: &StudyRuns) -> Self {
        // Waves and gaits learn more than free signals, so the last controller is selected first.
        let controller = controllers(&study.arms).last().copied().unwrap_or_default();
        Self { view: view(study, controller), study: study.clone(), controller }
    }

    /// Draws the panel. The chart of the curves is `height` points high.
    pub fn ui(&mut self, ui: &mut egui::Ui, height: f32) {
        if self.study.arms.is_empty() {
            return explain(ui, &ChartKind::Methods.empty_text());
        }
        ui.horizontal(|ui| {
            ui.label("Controller");
            for kind in &controllers(&self.study.arms) {
                let choice = ui.selectable_value(&mut self.controller, *kind, kind.name());
                if choice.on_hover_text(kind.words()).changed() {
                    self.view = view(&self.study, *kind);
                }
            }
        });
        draw::draw(ui, "curves", &self.view, height, &[]);
        self.table(ui);
    }

    fn table(&self, ui: &mut egui::Ui) {
        let palette = theme::of(ui);
        let spacing = [theme::GAP * 1.5, theme::GAP / 4.0];
        let shown = self.study.arms.iter().filter(|arm| arm.protocol.controller == self.controller);
        egui::Grid::new("methods").num_columns(4).spacing(spacing).show(ui, |ui| {
            for (text, hint) in [
                ("", ""),
                ("Landed", "Runs in which at least one snake ended on the landing"),
                (
                    "To landing",
                    "Evaluations until the first snake ended on the landing, median over the seeds",
                ),
                ("Best", "Best fitness of a run, median over the seeds"),
            ] {
                ui.label(axis_name(ui, text)).on_hover_text(hint);
            }
            ui.end_row();
            for arm in shown {
                let strategy = arm.protocol.strategy;
                let name = egui::RichText::new(short_title(&arm.protocol));
                ui.label(name.color(palette.strategy(strategy)).strong())
                    .on_hover_text(strategy.words());
                let values = |name| arm.runs.iter().map(move |run| run.number(name));
                let landings = values("first_landing");
                let landed = landings.clone().flatten().count();
                ui.label(format!("{landed} of {}", arm.runs.len()));
                ui.label(match median(landings.map(|landing| landing.unwrap_or(f64::INFINITY))) {
                    Some(median) if median.is_finite() => number(median),
                    _ => "never".to_owned(),
                });
                let best = median(values("fitness").flatten());
                let best = best.map_or(String::new(), |best| format!("{best:.1}"));
                ui.label(best + arm.protocol.fitness.unit());
                ui.end_row();
            }
        });
    }
}

/// Creates the chart of a controller's learning curves, with a summary of the study.
fn view(study: &StudyRuns, controller: ControllerKind) -> ChartView {
    let protocols = || study.arms.iter().map(|arm| &arm.protocol);
    let presets: BTreeSet<&str> = protocols().map(|of| of.preset.as_str()).collect();
    let presets = presets.into_iter().collect::<Vec<_>>().join(", ");
    let budget = protocols().map(|of| of.budget).max().unwrap_or(0);
    let note = format!(
        "Study {}, preset {presets}, {budget} evaluations per run. Lines: median over the seeds.",
        study.study
    );
    let chart = curves(&study.arms, controller).named("");
    let figure = Figure::of(&format!("Methods, {controller}"), chart).with_note(note);
    ChartView { is_of_run: false, ..ChartView::new(figure, Vec::new()) }
}

fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    Quartiles::of(values).map(|quartiles| quartiles.median)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{Sent, clicked, panel};
    use egui_kittest::kittest::Queryable;
    use snakes_core::evolve::StrategyKind;
    use snakes_core::save::{CURVE_POINTS, Protocol, StudiedRun, StudyValue};
    use snakes_core::score::Fitness;

    fn study() -> StudyRuns {
        let mut study = StudyRuns::new("methods");
        for (strategy, controller, seed, first_landing) in [
            (StrategyKind::Ga, ControllerKind::Gait, 1, Some(120.0)),
            (StrategyKind::Ga, ControllerKind::Gait, 2, Some(140.0)),
            (StrategyKind::Ga, ControllerKind::Gait, 3, None),
            (StrategyKind::CmaEs, ControllerKind::Gait, 1, None),
            (StrategyKind::Halving, ControllerKind::Signal, 1, None),
        ] {
            let protocol = Protocol {
                preset: "climb".to_owned(),
                settings: String::new(),
                strategy,
                controller,
                fitness: Fitness::Climb,
                budget: 300,
                stops_at_goal: false,
                changed: None,
            };
            let landing = first_landing.map(|landing| ("first_landing", landing));
            let values = [("fitness", 24.5)].into_iter().chain(landing);
            let number = |(name, value): (&str, f64)| (name.to_owned(), StudyValue::Number(value));
            let run = StudiedRun {
                seed,
                values: values.map(number).collect(),
                curve: (0..CURVE_POINTS).map(|point| Some(point as f32 / 4.0)).collect(),
                run_hash: String::new(),
            };
            study.add(&format!("{strategy}-{controller}"), &protocol, run);
        }
        study
    }

    #[test]
    fn the_table_shows_the_methods_of_the_selected_controller() {
        let mut curves = CurvesPanel::new(&study());
        let size = [theme::PANEL_WIDTH, 500.0];
        let mut panel = panel(size, |ui| curves.ui(ui, theme::PLOT_HEIGHT));
        // The controller is named in the legend and in the table.
        let is_shown = |panel: &Sent<'_>, name| panel.query_all_by_label(name).next().is_some();
        for text in ["Genetic algorithm", "2 of 3", "140", "never", "0 of 1", "24.5 m"] {
            assert!(is_shown(&panel, text), "{text}");
        }
        assert!(!is_shown(&panel, "Halving"));
        clicked(&mut panel, "signal");
        assert!(is_shown(&panel, "Halving") && !is_shown(&panel, "Genetic algorithm"));
    }
}
