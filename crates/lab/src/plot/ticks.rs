//! Places of the numbers along an axis.

use std::ops::{Range, RangeInclusive};

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;

use super::Axis;

/// An axis of a picture, with its numbers at the ticks of this module.
pub(super) struct TickedAxis {
    range: RangedCoordf64,
    step: f64,
    ticks: Vec<f64>,
}

impl TickedAxis {
    /// An axis with at most about `most` numbers.
    pub fn new(axis: &Axis, most: f64) -> Self {
        let (start, end) = (*axis.range.start(), *axis.range.end());
        let step = tick_step(end - start, most, axis.is_whole);
        Self { range: (start..end).into(), step, ticks: ticks(&axis.range, step) }
    }

    /// Number of digits after the point that its numbers need.
    pub fn digits(&self) -> usize {
        digits(self.step)
    }
}

impl Ranged for TickedAxis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // There are no lines between the ticks.
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range.range()
    }
}

/// Tick step for a range with at most about `most` ticks: 1, 2 or 5 times a power of ten, and at least 1 for whole
/// numbers.
pub fn tick_step(width: f64, most: f64, is_whole: bool) -> f64 {
    let least = (width / most).max(1.0e-9);
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    let steps = [1.0, 2.0, 5.0].map(|times| times * power);
    let step = steps.into_iter().find(|step| *step >= least).unwrap_or(10.0 * power);
    if is_whole { step.max(1.0) } else { step }
}

/// The multiples of a step within a range.
fn ticks(range: &RangeInclusive<f64>, step: f64) -> Vec<f64> {
    let first = libm::ceil(range.start() / step);
    let count = (libm::floor(range.end() / step) - first + 1.0).max(0.0) as usize;
    (0..count).map(|index| (first + index as f64) * step).collect()
}

/// Number of digits after the point that tell multiples of a step apart.
fn digits(step: f64) -> usize {
    (-libm::floor(libm::log10(step * 1.000_001))).max(0.0) as usize
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

    #[test]
    fn labels_have_as_many_digits_as_the_step_needs() {
        assert_eq!([20.0, 1.0, 0.5, 0.05, 0.002].map(digits), [0, 0, 1, 2, 3]);
    }
}
