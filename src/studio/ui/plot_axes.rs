//! Axes of charts, with round tick steps and readable labels.

use std::ops::RangeInclusive;

use bevy_egui::egui;
use egui_plot::{AxisHints, GridInput, GridMark, Plot, PlotBounds, uniform_grid_spacer};

use super::decimals::{decimals, short};
use super::text_rows::weak;
use super::theme;
use snakes_lab::plot::tick_step;

/// Maximum number of labels along an axis.
const MAX_LABELS: f64 = 6.0;

/// A chart without pan and zoom, `height` points high.
pub(crate) fn fixed_plot<'a>(id: &str, height: f32) -> Plot<'a> {
    Plot::new(id)
        .height(height)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_axis_zoom_drag(false)
        .x_grid_spacer(grid(false))
        .y_grid_spacer(grid(false))
        .custom_x_axes(vec![
            AxisHints::new_x().label_spacing(LABEL_POINTS).formatter(|mark, _| tick_text(mark)),
        ])
        .custom_y_axes(vec![
            AxisHints::new_y()
                .label_spacing(LABEL_POINTS)
                .min_thickness(theme::AXIS_WIDTH)
                .formatter(|mark, _| tick_text(mark)),
        ])
}

/// Label spacing from which egui_plot fades labels in, in points. Small, because [`step`] already spaces them.
const LABEL_POINTS: RangeInclusive<f32> = 4.0..=8.0;

/// The number at a grid line, with the digits that tell it from its neighbours.
fn tick_text(mark: GridMark) -> String {
    let digits = libm::ceil(-libm::log10(mark.step_size) - 1.0e-6).clamp(0.0, 9.0) as usize;
    decimals(mark.value, digits)
}

/// Tick step for a range: 1, 2 or 5 times a power of ten.
pub(crate) fn step(range: f64) -> f64 {
    tick_step(range, MAX_LABELS, false)
}

/// Grid of an axis. That of a count has lines at whole numbers only.
pub(crate) fn grid<'a>(is_whole: bool) -> Box<dyn Fn(GridInput) -> Vec<GridMark> + 'a> {
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
    short(value, digits)
}

/// The range of the values, with a margin; `None` without finite values.
pub(crate) fn padded_range(
    values: impl Iterator<Item = f64>,
    least_width: f64,
) -> Option<RangeInclusive<f64>> {
    let (least, most) = values
        .filter(|value| value.is_finite())
        .fold((f64::MAX, f64::MIN), |(least, most), value| (least.min(value), most.max(value)));
    if least > most {
        return None;
    }
    let missing = (least_width - (most - least)).max(0.0) / 2.0;
    let margin = missing + ((most - least) * 0.07).max(least_width * 0.07);
    Some(least - margin..=most + margin)
}

/// Bounds of a chart.
pub(crate) fn bounds(x: &RangeInclusive<f64>, y: &RangeInclusive<f64>) -> PlotBounds {
    PlotBounds::from_min_max([*x.start(), *y.start()], [*x.end(), *y.end()])
}

/// Label of an axis, in small weak text.
pub(crate) fn axis_name(ui: &egui::Ui, text: &str) -> egui::RichText {
    weak(ui, text).small()
}

/// Title of a vertical axis, above its upper end, where it is read without turning the head.
pub(crate) fn y_title(ui: &mut egui::Ui, text: &str) -> egui::Response {
    ui.add(egui::Label::new(axis_name(ui, text)).truncate())
}

/// Title of a horizontal axis, below its middle.
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

    /// With steps of one half, egui_plot's own labels were "-0", "0", "0" and "1".
    #[test]
    fn neighbouring_ticks_have_different_labels() {
        let text = |value, step_size| tick_text(GridMark { value, step_size });
        assert_eq!([-0.5, 0.0, 0.5, 1.0].map(|at| text(at, 0.5)), ["-0.5", "0.0", "0.5", "1.0"]);
        assert_eq!([0.0, 20.0].map(|at| text(at, 20.0)), ["0", "20"]);
        assert_eq!([-0.0, 0.2].map(|at| text(at, 0.2)), ["0.0", "0.2"]);
        assert_eq!([0.05, 0.1].map(|at| text(at, 0.05)), ["0.05", "0.10"]);
        assert_eq!(text(3000.0, 1000.0), "3000");
    }

    #[test]
    fn a_padded_range_is_never_empty() {
        assert_eq!(padded_range(std::iter::empty(), 1.0), None);
        let range = padded_range([2.0].into_iter(), 1.0).expect("a value");
        assert!(*range.start() <= 1.5 && *range.end() >= 2.5, "{range:?}");
    }
}
