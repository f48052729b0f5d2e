//! The scale of a slider: the positions of its values on the rail, and the marks below the rail.

use bevy_egui::egui;

use super::values::rounded;
use crate::studio::ui::theme;
use snakes_core::schema::NumberRange;

/// Share of a logarithmic slider's rail that represents zero, which has no position on a logarithmic scale.
const ZERO_SHARE: f32 = 0.1;
/// Vertical distance between the marks and the middle of the rail, in points: just below the handle.
const MARK_TOP: f32 = 8.5;
/// Length of a mark, in points.
const MARK_LENGTH: f32 = 3.0;
/// Font size of the numbers below the marks, in points. Glyphs of this size are loaded at the start, and fit between
/// two rows.
const NUMBER_SIZE: f32 = theme::SMALL_SIZE - 1.0;
/// Minimum distance between two numbers, in points.
const NUMBER_GAP: f32 = 5.0;
/// Additional height for the numbers below a row, in points.
pub const NUMBERS_HEIGHT: f32 = 8.0;
/// Possible steps between the marks of an angle, in degrees.
const ANGLE_STEPS: [f32; 4] = [5.0, 15.0, 45.0, 90.0];
/// Maximum number of steps between marks on a linear scale.
const MOST_STEPS: f32 = 5.0;

/// The scale of a slider.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    least: f32,
    most: f32,
    /// Smallest positive value of a logarithmic scale; `None` for a linear scale.
    logarithmic_from: Option<f32>,
    is_angle: bool,
}

impl Scale {
    /// Creates the scale of a setting with this range and unit. `least` and `most` are the ends of its slider.
    pub fn of(range: &NumberRange, [least, most]: [f32; 2], unit: &str) -> Self {
        let logarithmic_from = range.logarithmic_from.map(|from| from.max(least));
        Self { least, most, logarithmic_from, is_angle: unit == "°" }
    }

    /// Creates an egui slider for `value` on this scale.
    pub fn slider<'a>(&self, value: &'a mut f32) -> egui::Slider<'a> {
        let slider = egui::Slider::new(value, self.least..=self.most)
            .clamping(egui::SliderClamping::Never)
            .show_value(false);
        if self.logarithmic_from.is_none() {
            return slider;
        }
        slider.logarithmic(true).smallest_positive(f64::from(self.first_positive()))
    }

    /// Returns the value at which the logarithmic part would begin if it extended to the left end of the rail.
    fn first_positive(&self) -> f32 {
        let Some(from) = self.logarithmic_from else { return self.least };
        if self.least > 0.0 {
            return self.least;
        }
        let decades = libm::log10f(self.most / from) / (1.0 - ZERO_SHARE);
        self.most / libm::powf(10.0, decades)
    }

    /// Corrects a value that the egui slider returned. In the part of the rail that represents zero, a drag gives zero;
    /// a key goes from zero to the smallest positive value and back.
    pub fn settled(&self, slid: f32, before: f32, is_dragged: bool) -> f32 {
        match self.logarithmic_from {
            Some(from) if self.least <= 0.0 && slid < from => {
                if is_dragged || slid <= 0.0 || before >= from { 0.0 } else { from }
            }
            _ => slid,
        }
    }

    /// Returns the position of a value on the rail, from 0 to 1.
    fn share(&self, value: f32) -> f32 {
        if self.logarithmic_from.is_none() {
            return ((value - self.least) / (self.most - self.least)).clamp(0.0, 1.0);
        }
        let first = self.first_positive();
        if value <= first {
            return 0.0;
        }
        (libm::log10f(value / first) / libm::log10f(self.most / first)).clamp(0.0, 1.0)
    }

    /// Returns the values with a mark, from left to right.
    fn marks(&self) -> Vec<f32> {
        let Some(from) = self.logarithmic_from else { return self.linear_marks() };
        let first = if self.least > 0.0 { self.least } else { 0.0 };
        let lowest = libm::ceilf(libm::log10f(from) - 1.0e-3) as i32;
        let highest = libm::floorf(libm::log10f(self.most) + 1.0e-3) as i32;
        // Powers of ten are parsed from text, because computed ones would have digits such as 0.000099999.
        let decades = (lowest..=highest).filter_map(|power| format!("1e{power}").parse().ok());
        let mut values: Vec<f32> =
            std::iter::once(first).chain(decades).chain([self.most]).collect();
        values.dedup();
        values
    }

    fn linear_marks(&self) -> Vec<f32> {
        let width = self.most - self.least;
        let of_angle = ANGLE_STEPS.into_iter().find(|step| width / step <= MOST_STEPS);
        let step = of_angle.filter(|_| self.is_angle).unwrap_or_else(|| round_step(width));
        let first = (self.least / step).ceil() as i32;
        let values = (first..).map(|index| index as f32 * step);
        values.take_while(|value| *value <= self.most + step * 1.0e-3).collect()
    }

    /// Draws the marks below the rail of a slider at `rect`, with as many numbers as there is room for.
    pub fn paint(&self, ui: &egui::Ui, rect: egui::Rect) {
        if !ui.is_rect_visible(rect) {
            return;
        }
        // The range of the handle's centre, as egui computes it.
        let radius = rect.height() / 2.5;
        let aside = match ui.visuals().handle_shape {
            egui::style::HandleShape::Circle => radius,
            egui::style::HandleShape::Rect { aspect_ratio } => radius * aspect_ratio,
        };
        let rail = rect.x_range().shrink(aside);
        let color = theme::of(ui).text_weak;
        let top = rect.center().y + MARK_TOP;
        let marks = self.marks();
        let x_of = |value: f32| rail.min + rail.span() * self.share(value);
        let mut numbers: Vec<egui::Rect> = Vec::new();
        // The ends come first, so that they have their numbers even if there is no room for all.
        let numbered = marks.first().into_iter().chain(marks.last()).chain(&marks);
        for value in numbered {
            let font = egui::FontId::proportional(NUMBER_SIZE);
            let galley = ui.painter().layout_no_wrap(rounded(*value), font, color);
            let size = galley.size();
            let most_left = (rect.right() - size.x).max(rect.left());
            let left = (x_of(*value) - size.x / 2.0).clamp(rect.left(), most_left);
            let place = egui::Rect::from_min_size(egui::pos2(left, top + MARK_LENGTH - 1.0), size);
            let gap = egui::vec2(NUMBER_GAP, 0.0);
            if numbers.iter().all(|other| !other.expand2(gap).intersects(place)) {
                ui.painter().galley(place.min, galley, color);
                numbers.push(place);
            }
        }
        for value in marks {
            ui.painter().vline(x_of(value), top..=top + MARK_LENGTH, egui::Stroke::new(1.0, color));
        }
    }
}

/// Returns a round step, 1, 2 or 5 times a power of ten, that divides a width into a few parts.
fn round_step(width: f32) -> f32 {
    let power = libm::powf(10.0, libm::floorf(libm::log10f(width / MOST_STEPS)));
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    let few = steps.into_iter().find(|step| width / step <= MOST_STEPS + 1.0e-3);
    few.unwrap_or(width)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::settings::every_setting;
    use snakes_core::schema::SettingKind;

    fn scale(least: f32, most: f32, logarithmic_from: Option<f32>) -> Scale {
        Scale { least, most, logarithmic_from, is_angle: false }
    }

    #[test]
    fn zero_is_apart_from_small_values_on_a_logarithmic_scale() {
        let friction = scale(0.0, 10.0, Some(0.01));
        assert_eq!(friction.share(0.0), 0.0);
        assert!((friction.share(0.01) - ZERO_SHARE).abs() < 1.0e-3, "{}", friction.share(0.01));
        assert!(friction.share(0.1) > 0.35, "{}", friction.share(0.1));
        assert_eq!(friction.share(10.0), 1.0);
        let linear = scale(0.0, 2.0, None);
        assert_eq!([0.0, 0.5, 1.5, 2.0].map(|value| linear.share(value)), [0.0, 0.25, 0.75, 1.0]);
    }

    #[test]
    fn the_pointer_reaches_zero_and_keys_leave_it() {
        let slip = scale(0.0, 1.0, Some(0.001));
        assert_eq!(slip.settled(0.0005, 0.4, true), 0.0);
        assert_eq!(slip.settled(0.0005, 0.0, false), 0.001, "a key leaves zero");
        assert_eq!(slip.settled(0.0009, 0.001, false), 0.0, "a key returns to zero");
        assert_eq!(slip.settled(0.3, 0.1, true), 0.3);
    }

    #[test]
    fn a_linear_scale_has_round_numbers_and_a_logarithmic_one_has_zero_and_each_decade() {
        let rail = egui::Rect::from_min_size(egui::pos2(10.0, 10.0), egui::vec2(260.0, 18.0));
        for (scale, expected) in [
            (scale(0.0, 1.0, None), &["0", "1", "0.2", "0.4", "0.6", "0.8"][..]),
            (scale(0.0, 2.0, None), &["0", "2", "0.5", "1", "1.5"]),
            (Scale { is_angle: true, ..scale(0.0, 171.88, None) }, &["0", "135", "45", "90"]),
            (scale(0.0, 10.0, Some(0.01)), &["0", "10", "0.01", "0.1", "1"]),
            (scale(0.05, 5.0, Some(0.05)), &["0.05", "5", "0.1", "1"]),
            (scale(0.0, 0.1, Some(1.0e-6)), &["0", "0.1"]),
        ] {
            let context = egui::Context::default();
            let output = context.run_ui(egui::RawInput::default(), |ui| scale.paint(ui, rail));
            let texts = output.shapes.iter().filter_map(|clipped| match &clipped.shape {
                egui::Shape::Text(text) => Some(text.galley.text()),
                _ => None,
            });
            assert_eq!(texts.take(expected.len()).collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn every_slider_has_a_few_marks_in_order_and_ends_within_the_range_of_its_setting() {
        for listed in every_setting() {
            let SettingKind::Number(range) = listed.setting.kind else { continue };
            let range = listed.setting.shown_range(&range);
            let Some(ends @ [from, to]) = range.slider else { continue };
            let is_within = range.least <= from && from < to && to <= range.most;
            assert!(is_within, "{}: {ends:?}", listed.path);
            let scale = Scale::of(&range, ends, listed.setting.shown_unit());
            let marks = scale.marks();
            assert!((2..=9).contains(&marks.len()), "{}: {}", listed.path, marks.len());
            let are_sorted = marks.is_sorted_by(|a, b| scale.share(*a) < scale.share(*b));
            assert!(are_sorted, "{}: {marks:?}", listed.path);
        }
    }
}
