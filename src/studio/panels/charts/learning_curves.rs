//! Comparison of methods: learning curves, and a table that also serves as their legend.

use std::sync::Arc;

use bevy_egui::egui;
use egui_plot::{FilledArea, HoverPosition, Line, PlotPoints};

use crate::studio::ui::plot_axes::{
    axis_name, bounds, fixed_plot, grid, number, padded_range, x_title, y_title,
};
use crate::studio::ui::theme;
use snakes_core::evolve::StrategyKind;
use snakes_core::genome::ControllerKind;
use snakes_core::save::{CURVE_POINTS, Comparison};
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape};
use snakes_lab::run::Quartiles;
use snakes_lab::run::compare::{ComparisonRow, ComparisonTables};

/// An open comparison, with the selected controller.
#[derive(Debug)]
pub(crate) struct CurvesPanel {
    /// Summary of the comparison in one line.
    about: String,
    evaluations: f64,
    unit: &'static str,
    methods: Vec<Method>,
    controllers: Vec<ControllerKind>,
    /// Controller whose curves are shown.
    controller: ControllerKind,
    /// Cached figure of the shown curves.
    figure: Option<(ControllerKind, Arc<Figure>)>,
}

/// Results of a strategy with one controller over all seeds.
#[derive(Debug)]
struct Method {
    strategy: StrategyKind,
    controller: ControllerKind,
    /// Quartiles of the best fitness so far, at each point of the budget.
    curve: Vec<(usize, Quartiles)>,
    landed: usize,
    runs: usize,
    /// Evaluations until the first snake on the landing; infinite if most runs never get there.
    to_landing: Option<Quartiles>,
    best: Option<Quartiles>,
}

impl Method {
    fn new(row: &ComparisonRow<'_>) -> Self {
        Self {
            strategy: row.strategy,
            controller: row.controller,
            curve: row.curve(),
            landed: row.runs.iter().filter(|run| run.first_on_landing.is_some()).count(),
            runs: row.runs.len(),
            to_landing: row.evaluations_to_landing(),
            best: row.fitness(),
        }
    }

    /// Short name of the strategy for the table.
    fn name(&self) -> &'static str {
        self.strategy.title().split(" (").next().unwrap_or_default()
    }
}

impl CurvesPanel {
    /// Panel for a comparison.
    pub fn new(comparison: &Comparison) -> Self {
        let methods: Vec<Method> = comparison.rows().iter().map(Method::new).collect();
        let has_controller =
            |kind: &ControllerKind| methods.iter().any(|of| of.controller == *kind);
        let controllers: Vec<ControllerKind> =
            ControllerKind::ALL.into_iter().filter(has_controller).collect();
        Self {
            about: format!(
                "Preset {}, {} evaluations per run",
                comparison.preset, comparison.evaluations
            ),
            evaluations: f64::from(comparison.evaluations),
            unit: comparison.fitness.unit(),
            // Waves and gaits learn more than free signals, so the last controller is shown first.
            controller: controllers.last().copied().unwrap_or_default(),
            controllers,
            methods,
            figure: None,
        }
    }

    /// Figure of the shown curves, computed once.
    pub fn figure(&mut self) -> Arc<Figure> {
        if let Some((of, figure)) = &self.figure
            && *of == self.controller
        {
            return Arc::clone(figure);
        }
        let figure = Arc::new(self.build_figure());
        self.figure = Some((self.controller, Arc::clone(&figure)));
        figure
    }

    fn build_figure(&self) -> Figure {
        let x_of = |point: usize| self.evaluations * (point + 1) as f64 / CURVE_POINTS as f64;
        let of_method = |method: &Method| {
            let role = Role::Strategy(method.strategy);
            let band = method.curve.iter().map(|(point, of)| [x_of(*point), of.low, of.high]);
            let median = method.curve.iter().map(|(point, of)| [x_of(*point), of.median]);
            let name = format!("{}, middle 50 %", method.name());
            [
                Series::new(&name, role, Shape::Band(band.collect())),
                Series::new(method.name(), role, Shape::Line(median.collect())),
            ]
        };
        let mut series: Vec<Series> = self.shown_methods().flat_map(of_method).collect();
        // Lines are drawn over all bands.
        series.sort_by_key(|series| matches!(series.shape, Shape::Line(_)));
        let ends = self.shown_methods().flat_map(|of| of.curve.iter());
        let ends = ends.flat_map(|(_, quartiles)| [quartiles.low, quartiles.high]);
        let chart = Chart {
            name: String::new(),
            x: Axis::count("Evaluations", 0.0..=self.evaluations),
            y: Axis::new(
                "Best fitness so far",
                self.unit.trim(),
                padded_range(ends, 1.0).unwrap_or(0.0..=1.0),
            ),
            series,
            marks: Vec::new(),
        };
        let note = format!("{}. Lines: median over the seeds.", self.about);
        Figure { note, ..Figure::of(&format!("Methods, {}", self.controller), chart) }
    }

    /// Draws the panel with curves `height` points high.
    pub fn ui(&mut self, ui: &mut egui::Ui, height: f32) {
        ui.label(egui::RichText::new(&self.about).color(theme::of(ui).text_weak));
        if self.methods.is_empty() {
            return crate::studio::ui::text_rows::explain(
                ui,
                "This comparison has no finished runs.",
            );
        }
        ui.horizontal(|ui| {
            ui.label("Controller");
            for kind in &self.controllers {
                let choice = ui.selectable_value(&mut self.controller, *kind, kind.name());
                choice.on_hover_text(kind.words());
            }
        });
        self.plot(ui, height);
        self.table(ui);
    }

    fn shown_methods(&self) -> impl Iterator<Item = &Method> {
        self.methods.iter().filter(|of| of.controller == self.controller)
    }

    fn plot(&self, ui: &mut egui::Ui, height: f32) {
        let y_unit = if self.unit.is_empty() { "" } else { " (m)" };
        y_title(ui, &format!("Best fitness so far{y_unit}"))
            .on_hover_text("Line: median over the seeds. Band: middle 50 % of the seeds");
        let ends = self.shown_methods().flat_map(|of| of.curve.iter());
        let ends = ends.flat_map(|(_, quartiles)| [quartiles.low, quartiles.high]);
        let Some(y_range) = padded_range(ends, 1.0) else {
            return crate::studio::ui::text_rows::explain(ui, "All snakes were disqualified.");
        };
        let x_of = |point: usize| self.evaluations * (point + 1) as f64 / CURVE_POINTS as f64;
        let unit = self.unit;
        let label = |position: &HoverPosition<'_>| match position {
            HoverPosition::NearDataPoint { plot_name, position, .. } => Some(format!(
                "{plot_name}\n{:.2}{unit} after {:.0} evaluations",
                position.y, position.x
            )),
            HoverPosition::Elsewhere { .. } => None,
        };
        let palette = theme::of(ui);
        let plot = fixed_plot("curves", height).x_grid_spacer(grid(true));
        plot.label_formatter(label).show(ui, |plot| {
            plot.set_plot_bounds(bounds(&(0.0..=self.evaluations), &y_range));
            for method in self.shown_methods().filter(|of| !of.curve.is_empty()) {
                let color = palette.strategy(method.strategy);
                let along = |value: fn(&Quartiles) -> f64| -> Vec<f64> {
                    method.curve.iter().map(|(_, quartiles)| value(quartiles)).collect()
                };
                let xs: Vec<f64> = method.curve.iter().map(|(point, _)| x_of(*point)).collect();
                let band = FilledArea::new(
                    method.name(),
                    &xs,
                    &along(|quartiles| quartiles.low),
                    &along(|quartiles| quartiles.high),
                );
                plot.add(band.fill_color(palette.band(color)).allow_hover(false));
            }
            // Lines are drawn over all bands.
            for method in self.shown_methods() {
                let median = method.curve.iter().map(|(point, of)| [x_of(*point), of.median]);
                let line = Line::new(method.name(), median.collect::<PlotPoints<'_>>());
                plot.line(line.color(palette.strategy(method.strategy)).width(2.0));
            }
        });
        x_title(ui, "Evaluations");
    }

    fn table(&self, ui: &mut egui::Ui) {
        let palette = theme::of(ui);
        let spacing = [theme::GAP * 1.5, theme::GAP / 4.0];
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
            for method in self.shown_methods() {
                let color = palette.strategy(method.strategy);
                ui.label(egui::RichText::new(method.name()).color(color).strong())
                    .on_hover_text(method.strategy.words());
                ui.label(format!("{} of {}", method.landed, method.runs));
                let median = |quartiles: Option<Quartiles>| match quartiles {
                    Some(Quartiles { median, .. }) if median.is_finite() => number(median),
                    _ => "never".to_owned(),
                };
                ui.label(median(method.to_landing));
                let best = method.best.map(|quartiles| format!("{:.1}", quartiles.median));
                ui.label(best.unwrap_or_default() + self.unit);
                ui.end_row();
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use snakes_core::save::{ComparedBest, ComparedRun};
    use snakes_core::score::Fitness;

    fn comparison() -> Comparison {
        let mut comparison = Comparison::new("climb", String::new(), 300, Fitness::Climb);
        for (strategy, controller, seed, first_on_landing) in [
            (StrategyKind::Ga, ControllerKind::Gait, 1, Some(120)),
            (StrategyKind::Ga, ControllerKind::Gait, 2, Some(140)),
            (StrategyKind::Ga, ControllerKind::Gait, 3, None),
            (StrategyKind::CmaEs, ControllerKind::Gait, 1, None),
            (StrategyKind::Halving, ControllerKind::Signal, 1, None),
        ] {
            let best = ComparedBest {
                fitness: 24.5,
                steps_climbed: 10,
                energy_j_per_m: None,
                cost_of_transport: None,
                climbing_efficiency: None,
            };
            comparison.add(ComparedRun {
                strategy,
                controller,
                seed,
                evaluations: 300,
                best: Some(best),
                first_on_landing,
                last_mean: None,
                curve: (0..CURVE_POINTS).map(|point| Some(point as f32 / 4.0)).collect(),
                run_hash: String::new(),
            });
        }
        comparison
    }

    #[test]
    fn the_table_shows_the_methods_of_the_selected_controller() {
        let mut panel = CurvesPanel::new(&comparison());
        let size = egui::vec2(theme::PANEL_WIDTH, 500.0);
        let mut harness =
            Harness::builder().with_size(size).build_ui(|ui| panel.ui(ui, theme::PLOT_HEIGHT));
        harness.run();
        for text in ["Genetic algorithm", "2 of 3", "140", "never", "0 of 1", "24.5 m"] {
            assert!(harness.query_all_by_label(text).next().is_some(), "{text}");
        }
        assert!(harness.query_by_label("Halving").is_none());
        harness.get_by_label("signal").click();
        harness.run();
        assert!(harness.query_by_label("Halving").is_some());
        assert!(harness.query_by_label("Genetic algorithm").is_none());
    }
}
