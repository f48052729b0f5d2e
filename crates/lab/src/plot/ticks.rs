//! Positions and labels of the ticks along an axis.

use std::ops::{Range, RangeInclusive};

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;

use super::Axis;

/// An axis of a picture, with round numbers at its ticks.
pub(super) struct TickedAxis {
    range: RangedCoordf64,
    is_logarithmic: bool,
    step: f64,
    ticks: Vec<f64>,
}

impl TickedAxis {
    /// Creates an axis with at most about `most` ticks.
    pub fn new(axis: &Axis, most: f64) -> Self {
        let (start, end) = (*axis.range.start(), *axis.range.end());
        let step = tick_step(end - start, most, axis.is_whole);
        let (range, ticks) = ((start..end).into(), ticks(&axis.range, step));
        Self { range, is_logarithmic: axis.is_logarithmic, step, ticks }
    }

    /// Returns a function that labels the tick at a position.
    pub fn labels(&self) -> impl Fn(&f64) -> String + use<> {
        let Self { step, is_logarithmic, .. } = *self;
        move |position| tick_text(*position, step, is_logarithmic)
    }
}

impl Ranged for TickedAxis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // The plotting library draws no lines between the ticks.
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range.range()
    }
}

/// Returns the step of ticks in a range of this `width`, for at most about `most` ticks: 1, 2 or 5 times a power of ten, and at
/// least 1 for whole numbers.
pub fn tick_step(width: f64, most: f64, is_whole: bool) -> f64 {
    let least = (width / most).max(1.0e-9);
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    let steps = [1.0, 2.0, 5.0].map(|times| times * power);
    let step = steps.into_iter().find(|step| *step >= least).unwrap_or(10.0 * power);
    if is_whole { step.max(1.0) } else { step }
}

/// Returns the multiples of a step within a range.
fn ticks(range: &RangeInclusive<f64>, step: f64) -> Vec<f64> {
    let first = libm::ceil(range.start() / step);
    let count = (libm::floor(range.end() / step) - first + 1.0).max(0.0) as usize;
    (0..count).map(|index| (first + index as f64) * step).collect()
}

/// Returns the label of a tick, with the digits that distinguish it from its neighbours at a distance of `step`. On a logarithmic
/// axis the label is the power of ten.
pub fn tick_text(position: f64, step: f64, is_logarithmic: bool) -> String {
    if is_logarithmic {
        let digits = (-libm::floor(position)).max(0.0) as usize;
        return format!("{:.digits$}", libm::pow(10.0, position));
    }
    let digits = libm::ceil(-libm::log10(step) - 1.0e-6).clamp(0.0, 9.0) as usize;
    let text = format!("{position:.digits$}");
    // Rounding can turn a small negative number into a negative zero, whose sign is removed.
    let is_zero = text.chars().all(|letter| !letter.is_ascii_digit() || letter == '0');
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tick_steps_are_round_and_few() {
        for (width, expected) in [(5.0, 1.0), (6.0, 1.0), (18.0, 5.0), (119.0, 20.0), (0.3, 0.05)] {
            let step = tick_step(width, 6.0, false);
            assert!((step - expected).abs() < 1.0e-9, "{width}: {step}");
        }
    }

    #[test]
    fn counts_have_whole_ticks_however_few_there_are() {
        for (width, expected) in [(0.9, 1.0), (1.1, 1.0), (2.2, 1.0), (7.0, 2.0), (119.0, 20.0)] {
            assert_eq!(tick_step(width, 6.0, true), expected, "{width}");
        }
        assert_eq!(ticks(&(0.96..=3.04), 1.0), [1.0, 2.0, 3.0]);
        assert_eq!(ticks(&(-7.0..=11.0), 5.0), [-5.0, 0.0, 5.0, 10.0]);
        assert!(ticks(&(0.2..=0.8), 1.0).is_empty());
    }

    /// With steps of one half, labels rounded to whole numbers would be "-0", "0", "0" and "1".
    #[test]
    fn neighbouring_ticks_have_different_labels() {
        let text = |position, step| tick_text(position, step, false);
        assert_eq!([-0.5, 0.0, 0.5, 1.0].map(|at| text(at, 0.5)), ["-0.5", "0.0", "0.5", "1.0"]);
        assert_eq!([0.0, 20.0].map(|at| text(at, 20.0)), ["0", "20"]);
        assert_eq!([-0.0, 0.2].map(|at| text(at, 0.2)), ["0.0", "0.2"]);
        assert_eq!([0.05, 0.1].map(|at| text(at, 0.05)), ["0.05", "0.10"]);
        assert_eq!((text(3000.0, 1000.0), text(0.004, 0.002)), ("3000".into(), "0.004".into()));
        let powers = [-2.0, -1.0, 0.0, 3.0].map(|at| tick_text(at, 1.0, true));
        assert_eq!(powers, ["0.01", "0.1", "1", "1000"]);
    }
}
