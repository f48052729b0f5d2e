//! Fitness over the generations: the best and the mean.

use bevy_egui::egui;
use egui_plot::{AxisHints, HLine, HoverPosition, Line, LineStyle, Plot, PlotPoints, Points};

use super::title;
use crate::evolve::Settings;
use crate::run::GenerationReport;
use crate::score::Fitness;
use crate::studio::look;

/// The chart.
#[derive(Debug, Default)]
pub(super) struct ChartPanel;

impl ChartPanel {
    /// Draws best and mean of the finished generations.
    pub fn ui(&mut self, ui: &mut egui::Ui, settings: &Settings, reports: &[GenerationReport]) {
        title(ui, "Fitness");
        ui.horizontal(|ui| {
            let text = |text: &str, color| egui::RichText::new(text).color(color);
            let fitness = settings.trial.fitness;
            let what = if fitness == Fitness::Centre {
                "Centre's y in m, by generation:".to_owned()
            } else {
                format!("{}, by generation:", fitness.name().replace('_', " "))
            };
            ui.label(text(&what, look::TEXT_WEAK));
            ui.label(text("best", look::ACCENT).strong());
            ui.label(text("mean", look::SECOND).strong());
        });
        let series = |value: fn(&crate::run::Statistics) -> f64| -> Vec<[f64; 2]> {
            let known = reports.iter().filter_map(|report| {
                let statistics = report.statistics.as_ref()?;
                Some([f64::from(report.generation), value(statistics)])
            });
            known.collect()
        };
        let lines = [
            ("best", series(|statistics| statistics.best), look::ACCENT),
            ("mean", series(|statistics| statistics.mean), look::SECOND),
        ];
        let stairs = HLine::new("the first step", settings.trial.stairs.first_riser_y_m)
            .color(look::TEXT_WEAK)
            .style(LineStyle::dashed_dense());
        // In a low window the champions below it come before a high chart.
        let height = look::CHART_HEIGHT.min(ui.ctx().viewport_rect().height() / 5.0);
        Plot::new("fitness")
            .height(height)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .include_x(1.0)
            .include_x(6.0)
            .custom_x_axes(vec![AxisHints::new_x().label_spacing(14.0..=28.0)])
            .include_y(-8.0)
            .include_y(10.0)
            .x_grid_spacer(egui_plot::uniform_grid_spacer(|_| [1.0, 1.0e3, 1.0e6]))
            .label_formatter(label)
            .show(ui, |plot| {
                plot.hline(stairs);
                for (name, points, color) in lines {
                    plot.line(
                        Line::new(name, PlotPoints::from(points.clone())).color(color).width(2.0),
                    );
                    plot.points(Points::new(name, points).color(color).radius(3.5));
                }
            });
    }
}

/// What stands beside the pointer over a point.
fn label(position: &HoverPosition<'_>) -> Option<String> {
    match position {
        HoverPosition::NearDataPoint { plot_name, position, .. } => {
            Some(format!("generation {:.0}\n{plot_name} {:.2} m", position.x, position.y))
        }
        HoverPosition::Elsewhere { .. } => None,
    }
}
