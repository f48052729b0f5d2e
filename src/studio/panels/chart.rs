//! Fitness over the generations: the best and the mean.

use std::ops::RangeInclusive;

use bevy_egui::egui;
use egui_plot::{HLine, HoverPosition, Line, LineStyle, PlotPoints, Points};

use super::axes::{bounds, still};
use super::title;
use crate::evolve::Settings;
use crate::run::{GenerationReport, Statistics};
use crate::score::Fitness;
use crate::studio::look;

/// The chart.
#[derive(Debug, Default)]
pub(super) struct ChartPanel;

impl ChartPanel {
    /// Draws best and mean of the finished generations.
    pub fn ui(&mut self, ui: &mut egui::Ui, settings: &Settings, reports: &[GenerationReport]) {
        title(ui, "Fitness");
        let palette = look::of(ui);
        ui.horizontal(|ui| {
            let text = |text: &str, color| egui::RichText::new(text).color(color);
            ui.label(text(&what(settings.trial.fitness), palette.text_weak));
            ui.label(text("best", palette.accent).strong());
            ui.label(text("mean", palette.second).strong());
        });
        let series = |value: fn(&Statistics) -> f64| -> Vec<[f64; 2]> {
            let known = reports.iter().filter_map(|report| {
                let statistics = report.statistics.as_ref()?;
                Some([f64::from(report.generation), value(statistics)])
            });
            known.collect()
        };
        let lines = [
            ("best", series(|statistics| statistics.best), palette.accent),
            ("mean", series(|statistics| statistics.mean), palette.second),
        ];
        let values = lines.iter().flat_map(|(_, points, _)| points).map(|point| point[1]);
        let frame = Frame::new(settings, reports.len(), values);
        // Where there are many the line says it all.
        let has_points = reports.len() <= MOST_POINTS;
        // In a low window the champions below it come before a high chart.
        let room = ui.ctx().viewport_rect().height() - look::WITHOUT_CHART;
        let height = (room / 2.0).clamp(look::LEAST_CHART_HEIGHT, look::CHART_HEIGHT);
        let unit = settings.trial.fitness.unit();
        still("fitness", height).label_formatter(|position| label(position, unit)).show(
            ui,
            |plot| {
                plot.set_plot_bounds(bounds(&frame.x, &frame.y));
                for (name, y_m) in frame.marks {
                    let line = HLine::new(name, y_m).color(palette.text_weak).allow_hover(false);
                    plot.hline(line.style(LineStyle::dashed_dense()));
                }
                for (name, points, color) in lines {
                    plot.line(
                        Line::new(name, PlotPoints::from(points.clone())).color(color).width(2.0),
                    );
                    if has_points {
                        plot.points(Points::new(name, points).color(color).radius(3.5));
                    }
                }
            },
        );
    }
}

/// Up to so many generations each is a point.
const MOST_POINTS: usize = 30;
/// The report's run has six generations: with fewer, the axis is as long as for these.
const FEWEST_GENERATIONS: f64 = 6.0;
/// From how far below the landing the best has it in sight, in metres.
const LANDING_IN_SIGHT_M: f64 = 6.0;

/// What the chart reaches over.
#[derive(Debug, Clone, PartialEq)]
struct Frame {
    x: RangeInclusive<f64>,
    y: RangeInclusive<f64>,
    /// Places on the stairs, by name.
    marks: Vec<(&'static str, f64)>,
}

impl Frame {
    fn new(settings: &Settings, finished: usize, values: impl Iterator<Item = f64>) -> Self {
        let trial = &settings.trial;
        let (mut least, mut most) = (f64::MAX, f64::MIN);
        for value in values.filter(|value| value.is_finite()) {
            (least, most) = (least.min(value), most.max(value));
        }
        let mut marks = Vec::new();
        // A height or a number of steps has no place along the stairs.
        if !matches!(trial.fitness, Fitness::Height | Fitness::StepsClimbed) {
            let first_riser_m = f64::from(trial.stairs.first_riser_y_m);
            let landing_m = f64::from(trial.stairs.riser_y_m(trial.stairs.steps));
            marks.push(("the first step", first_riser_m));
            least = least.min(f64::from(trial.start_y_m));
            if most > landing_m - LANDING_IN_SIGHT_M && trial.stairs.steps > 0 {
                marks.push(("the landing", landing_m));
            }
            most = marks.iter().map(|(_, y_m)| *y_m).fold(most, f64::max);
        } else if least > most {
            (least, most) = (0.0, 1.0);
        }
        let margin = ((most - least) * 0.06).max(0.5);
        let last = (finished as f64).max(FEWEST_GENERATIONS);
        let aside = (last - 1.0) * 0.04;
        Self { x: 1.0 - aside..=last + aside, y: least - margin..=most + margin, marks }
    }
}

/// What is shown.
fn what(fitness: Fitness) -> String {
    match fitness {
        Fitness::Centre => "Centre's y in m, by generation:".to_owned(),
        Fitness::Climb => "Place in m, by generation:".to_owned(),
        other => format!("{}, by generation:", other.name().replace('_', " ")),
    }
}

/// What stands beside the pointer over a point.
fn label(position: &HoverPosition<'_>, unit: &str) -> Option<String> {
    match position {
        HoverPosition::NearDataPoint { plot_name, position, .. } => {
            Some(format!("generation {:.0}\n{plot_name} {:.2}{unit}", position.x, position.y))
        }
        HoverPosition::Elsewhere { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reaches_over_all_generations_and_to_the_landing_once_that_is_in_sight() {
        let settings = Settings::default();
        let of = |finished, values: &[f64]| Frame::new(&settings, finished, values.iter().copied());
        let early = of(0, &[]);
        assert!(*early.x.end() > 6.0 && *early.x.end() < 7.0);
        assert_eq!(early.marks, [("the first step", 3.0)]);
        assert!(early.y.contains(&-7.2) && early.y.contains(&3.0));
        let late = of(120, &[-7.0, 12.0, 29.0]);
        assert!(late.x.contains(&120.0) && late.y.contains(&29.0));
        assert_eq!(late.marks, [("the first step", 3.0), ("the landing", 23.0)]);
        assert_eq!(of(20, &[10.0]).marks.len(), 1, "far below the landing");
    }
}
