//! Axes of charts, with round tick steps and readable labels.

use std::ops::RangeInclusive;

use bevy_egui::egui;
use egui_plot::{AxisHints, GridInput, GridMark, Plot, PlotBounds, uniform_grid_spacer};

use super::text_rows::weak;
use super::theme;
use snakes_lab::plot::{Axis, tick_step, tick_text};

/// Maximum number of labels along an axis.
const MAX_LABELS: f64 = 6.0;

/// Creates a chart without pan and zoom, `height` points high.
pub(crate) fn fixed_plot<'a>(id: &str, height: f32, [x, y]: [&Axis; 2]) -> Plot<'a> {
    let labelled = |hints: AxisHints<'a>, axis: &Axis| {
        let is_logarithmic = axis.is_logarithmic;
        hints
            .label_spacing(LABEL_POINTS)
            .formatter(move |mark, _| tick_text(mark.value, mark.step_size, is_logarithmic))
    };
    Plot::new(id)
        .height(height)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_axis_zoom_drag(false)
        .x_grid_spacer(grid(x.is_whole))
        .y_grid_spacer(grid(y.is_whole))
        .custom_x_axes(vec![labelled(AxisHints::new_x(), x)])
        .custom_y_axes(vec![labelled(AxisHints::new_y(), y).min_thickness(theme::AXIS_WIDTH)])
}

/// Distance between labels at which egui_plot fades them in, in points. It is small because [`step`] already spaces the labels.
const LABEL_POINTS: RangeInclusive<f32> = 4.0..=8.0;

/// Returns the tick step for a range: 1, 2 or 5 times a power of ten.
pub(crate) fn step(range: f64) -> f64 {
    tick_step(range, MAX_LABELS, false)
}

/// Returns the grid of an axis. The grid of a count has lines only at whole numbers.
fn grid<'a>(is_whole: bool) -> Box<dyn Fn(GridInput) -> Vec<GridMark> + 'a> {
    uniform_grid_spacer(move |input: GridInput| {
        let step = tick_step(input.bounds.1 - input.bounds.0, MAX_LABELS, is_whole);
        [step, step * 1.0e3, step * 1.0e6]
    })
}

/// Formats a number with three significant digits.
pub(crate) fn number(value: f64) -> String {
    let digits = match value.abs() {
        size if size >= 99.95 => 0,
        size if size >= 9.995 => 1,
        size if size >= 0.0995 || size == 0.0 => 2,
        _ => 3,
    };
    snakes_lab::study::number(value, digits)
}

/// Returns the bounds of a chart, from the ranges of its axes.
pub(crate) fn bounds(x: &RangeInclusive<f64>, y: &RangeInclusive<f64>) -> PlotBounds {
    PlotBounds::from_min_max([*x.start(), *y.start()], [*x.end(), *y.end()])
}

/// Returns the title of an axis in small weak text.
pub(crate) fn axis_name(ui: &egui::Ui, text: &str) -> egui::RichText {
    weak(ui, text).small()
}

/// Draws the title of a vertical axis above its upper end, horizontally.
pub(crate) fn y_title(ui: &mut egui::Ui, text: &str) -> egui::Response {
    ui.add(egui::Label::new(axis_name(ui, text)).truncate())
}

/// Draws the title of a horizontal axis below its middle.
pub(crate) fn x_title(ui: &mut egui::Ui, text: &str) {
    ui.with_layout(egui::Layout::top_down(egui::Align::Center), |ui| {
        ui.add(egui::Label::new(axis_name(ui, text)).truncate());
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_significant_digits() {
        let texts = [0.3, 10_000.0, 12.34, 2.0, 0.0, 0.0123].map(number);
        assert_eq!(texts, ["0.3", "10000", "12.3", "2", "0", "0.012"]);
    }
}
