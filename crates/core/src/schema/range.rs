//! Ranges of the numbers that settings may have.

use std::ops::RangeInclusive;

use super::parts::Parts;
use crate::check::Invalid;

/// Range of the numbers that a setting may have, and its slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberRange {
    /// Least allowed number.
    pub least: f32,
    /// Greatest allowed number.
    pub most: f32,
    /// Whether only whole numbers are allowed.
    pub is_whole: bool,
    /// Numbers at the ends of the slider. None: the setting has no slider.
    pub slider: Option<[f32; 2]>,
    /// Number from which the slider is logarithmic. None: the slider is linear.
    pub logarithmic_from: Option<f32>,
    /// Numbers that are allowed, but between which none is. None: there is no such gap.
    pub gap: Option<[f32; 2]>,
    /// Parts of the snake or the stairs for which the setting may have separate values.
    pub parts: Parts,
    /// Number with which a panel switches an optional setting on. None: the setting is not optional.
    pub begins_with: Option<f32>,
}

impl NumberRange {
    /// Makes the range of a single number without a slider.
    pub(super) fn of(range: RangeInclusive<f32>) -> Self {
        Self {
            least: *range.start(),
            most: *range.end(),
            is_whole: false,
            slider: None,
            logarithmic_from: None,
            gap: None,
            parts: Parts::One,
            begins_with: None,
        }
    }

    /// Returns whether a number is allowed. NaN is not.
    pub fn allows(&self, number: f32) -> bool {
        let is_in_gap = self.gap.is_some_and(|[from, to]| number > from && number < to);
        (self.least..=self.most).contains(&number) && !is_in_gap
    }

    /// Checks a number; the error calls it `path`.
    pub(super) fn check(&self, path: &str, number: f32) -> Result<(), Invalid> {
        if self.allows(number) { Ok(()) } else { Err(Invalid::new(path, number, self.in_words())) }
    }

    /// Describes the allowed numbers in words, without a unit.
    pub fn in_words(&self) -> String {
        let Self { least, most, gap, .. } = *self;
        let part = |from: f32, to: f32| {
            if from == to { from.to_string() } else { format!("{from} to {to}") }
        };
        match gap {
            None => format!("{least} to {most}"),
            Some([from, to]) => format!("{} or {}", part(least, from), part(to, most)),
        }
    }
}
