//! How methods compare: their learning curves, and a table that is the curves' legend too.

use std::sync::Arc;

use bevy_egui::egui;
use egui_plot::{FilledArea, HoverPosition, Line, PlotPoints};

use super::axes::{around, axis_name, bounds, number, still};
use crate::evolve::StrategyKind;
use crate::genome::ControllerKind;
use crate::plot::{Axis, Chart, Figure, Role, Series, Shape};
use crate::run::compare::{Quartiles, Row};
use crate::save::{CURVE_POINTS, Comparison};
use crate::studio::look;

/// A comparison that is open, and what of it is on show.
#[derive(Debug)]
pub(super) struct CurvesPanel {
    /// What was compared, in a line.
    about: String,
    evaluations: f64,
    unit: &'static str,
    methods: Vec<Method>,
    controllers: Vec<ControllerKind>,
    /// Whose curves are on show.
    controller: ControllerKind,
    /// Those curves as data.
    figure: Option<(ControllerKind, Arc<Figure>)>,
}

/// A method with one controller, over all seeds.
#[derive(Debug)]
struct Method {
    strategy: StrategyKind,
    controller: ControllerKind,
    /// Quartiles of the best fitness so far, at each point of the budget.
    curve: Vec<(usize, Quartiles)>,
    landed: usize,
    runs: usize,
    /// Evaluations until the first on the landing; infinite if most never get there.
    to_landing: Option<Quartiles>,
    best: Option<Quartiles>,
}

impl Method {
    fn new(row: &Row<'_>) -> Self {
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

    /// The strategy's name, short enough for a table.
    fn name(&self) -> &'static str {
        self.strategy.title().split(" (").next().unwrap_or_default()
    }
}

impl CurvesPanel {
    /// The panel of a comparison.
    pub fn new(comparison: &Comparison) -> Self {
        let methods: Vec<Method> = comparison.rows().iter().map(Method::new).collect();
        let is_there = |kind: &ControllerKind| methods.iter().any(|of| of.controller == *kind);
        let controllers: Vec<ControllerKind> =
            ControllerKind::ALL.into_iter().filter(is_there).collect();
        Self {
            about: format!(
                "Preset {}, {} evaluations each",
                comparison.preset, comparison.evaluations
            ),
            evaluations: f64::from(comparison.evaluations),
            unit: comparison.fitness.unit(),
            // The last has most to show: waves learn more than free signals.
            controller: controllers.last().copied().unwrap_or_default(),
            controllers,
            methods,
            figure: None,
        }
    }

    /// The curves on show as data, worked out once.
    pub fn figure(&mut self) -> Arc<Figure> {
        if let Some((of, figure)) = &self.figure
            && *of == self.controller
        {
            return Arc::clone(figure);
        }
        let figure = Arc::new(self.data());
        self.figure = Some((self.controller, Arc::clone(&figure)));
        figure
    }

    fn data(&self) -> Figure {
        let x_of = |point: usize| self.evaluations * (point + 1) as f64 / CURVE_POINTS as f64;
        let of_method = |method: &Method| {
            let role = Role::Strategy(method.strategy);
            let band = method.curve.iter().map(|(point, of)| [x_of(*point), of.low, of.high]);
            let median = method.curve.iter().map(|(point, of)| [x_of(*point), of.median]);
            let name = format!("{}, middle half", method.name());
            [
                Series::new(&name, role, Shape::Band(band.collect())),
                Series::new(method.name(), role, Shape::Line(median.collect())),
            ]
        };
        let mut series: Vec<Series> = self.on_show().flat_map(of_method).collect();
        // Lines over all bands.
        series.sort_by_key(|series| matches!(series.shape, Shape::Line(_)));
        let ends = self.on_show().flat_map(|of| of.curve.iter());
        let ends = ends.flat_map(|(_, quartiles)| [quartiles.low, quartiles.high]);
        let chart = Chart {
            name: String::new(),
            x: Axis::new("Evaluations", "", 0.0..=self.evaluations),
            y: Axis::new(
                "Best fitness so far",
                self.unit.trim(),
                around(ends, 1.0).unwrap_or(0.0..=1.0),
            ),
            series,
            marks: Vec::new(),
        };
        let note = format!("{}. Lines: median of the seeds.", self.about);
        Figure { note, ..Figure::of(&format!("Methods, {}", self.controller), chart) }
    }

    /// Draws the panel, its curves so many points high.
    pub fn ui(&mut self, ui: &mut egui::Ui, height: f32) {
        ui.label(egui::RichText::new(&self.about).color(look::of(ui).text_weak));
        if self.methods.is_empty() {
            return super::explain(ui, "It has no finished runs.");
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

    fn on_show(&self) -> impl Iterator<Item = &Method> {
        self.methods.iter().filter(|of| of.controller == self.controller)
    }

    fn plot(&self, ui: &mut egui::Ui, height: f32) {
        let y_unit = if self.unit.is_empty() { "" } else { " (m)" };
        ui.label(axis_name(ui, &format!("Best fitness so far{y_unit}, over evaluations")))
            .on_hover_text("Line: median of the seeds; band: the half of them in the middle");
        let ends = self.on_show().flat_map(|of| of.curve.iter());
        let ends = ends.flat_map(|(_, quartiles)| [quartiles.low, quartiles.high]);
        let Some(y_range) = around(ends, 1.0) else {
            return super::explain(ui, "All agents were disqualified.");
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
        let palette = look::of(ui);
        still("curves", height).label_formatter(label).show(ui, |plot| {
            plot.set_plot_bounds(bounds(&(0.0..=self.evaluations), &y_range));
            for method in self.on_show().filter(|of| !of.curve.is_empty()) {
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
                plot.add(band.fill_color(color.gamma_multiply(0.2)).allow_hover(false));
            }
            // Lines over all bands.
            for method in self.on_show() {
                let median = method.curve.iter().map(|(point, of)| [x_of(*point), of.median]);
                let line = Line::new(method.name(), median.collect::<PlotPoints<'_>>());
                plot.line(line.color(palette.strategy(method.strategy)).width(2.0));
            }
        });
    }

    fn table(&self, ui: &mut egui::Ui) {
        let palette = look::of(ui);
        let spacing = [look::GAP * 1.5, look::GAP / 4.0];
        egui::Grid::new("methods").num_columns(4).spacing(spacing).show(ui, |ui| {
            for (text, hint) in [
                ("", ""),
                ("Landed", "Runs in which somebody ended on the landing"),
                ("To landing", "Evaluations until then, median over the seeds"),
                ("Best", "Fitness of the best of a run, median over the seeds"),
            ] {
                ui.label(axis_name(ui, text)).on_hover_text(hint);
            }
            ui.end_row();
            for method in self.on_show() {
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
    use crate::save::{ComparedBest, ComparedRun};
    use crate::score::Fitness;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn comparison() -> Comparison {
        let mut comparison = Comparison::new("climb", String::new(), 300, Fitness::Climb);
        for (strategy, controller, seed, first_on_landing) in [
            (StrategyKind::Ga, ControllerKind::Gait, 1, Some(120)),
            (StrategyKind::Ga, ControllerKind::Gait, 2, Some(140)),
            (StrategyKind::Ga, ControllerKind::Gait, 3, None),
            (StrategyKind::CmaEs, ControllerKind::Gait, 1, None),
            (StrategyKind::Halving, ControllerKind::Signal, 1, None),
        ] {
            let best = ComparedBest { fitness: 24.5, steps_climbed: 10, energy_j_per_m: None };
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
    fn the_table_shows_the_methods_of_the_chosen_controller() {
        let mut panel = CurvesPanel::new(&comparison());
        let size = egui::vec2(look::PANEL_WIDTH, 500.0);
        let mut harness =
            Harness::builder().with_size(size).build_ui(|ui| panel.ui(ui, look::PLOT_HEIGHT));
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
