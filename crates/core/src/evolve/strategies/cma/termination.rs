//! Termination of a run of CMA-ES: the criteria of the tutorial (arXiv:1604.00772v2, appendix B.3), and the values that they compare.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::candidate::{RankedCandidate, check_floats, finite};
use crate::check::{Invalid, within};

/// Maximum number of past iterations that the criteria compare.
const LONGEST_HISTORY: usize = 20_000;

/// Reason why a run has ended, with the criterion's name in the tutorial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StopReason {
    /// The best values of many iterations are all equal (EqualFunValues).
    EqualValues,
    /// The best values of many iterations, and all values of the latest iteration, differ by less than 1e-12 (TolFun).
    CloseValues,
    /// Neither best nor median values have improved for many iterations (Stagnation).
    Stagnation,
    /// Steps are less than 1e-12 times as long as the first steps (TolX).
    ShortSteps,
    /// Steps are more than 1e4 times as long as the first steps (TolXUp).
    LongSteps,
    /// A fifth of a standard deviation is too small to change a coordinate of the mean (NoEffectCoord).
    CoordinateWithoutEffect,
    /// A tenth of a standard deviation along an axis is too small to change the mean (NoEffectAxis).
    AxisWithoutEffect,
    /// One axis is more than 1e7 times as long as another (ConditionCov).
    Condition,
    /// Numbers of the state left the range of `f64`.
    Numbers,
}

/// Values of the latest iterations, the oldest first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValueHistory {
    /// Best value of each of the latest iterations.
    best: VecDeque<f64>,
    /// Median value of each of the latest iterations.
    median: VecDeque<f64>,
    /// Worst value of the latest iteration.
    pub worst: f64,
}

impl ValueHistory {
    /// Adds the values of an iteration, and keeps only the latest `window` iterations.
    pub fn record(&mut self, ranked: &[RankedCandidate], window: usize) {
        let value = |rank: usize| ranked.get(rank).map_or(0.0, |candidate| finite(candidate.value));
        let last = ranked.len().saturating_sub(1);
        self.best.push_back(value(0));
        self.median.push_back(0.5 * value(last / 2) + 0.5 * value(ranked.len() / 2));
        self.worst = value(last);
        for values in [&mut self.best, &mut self.median] {
            values.drain(..values.len().saturating_sub(window));
        }
    }

    /// Checks that there are at most `iterations` and at most `window` values, and that all are finite.
    pub fn check(&self, iterations: u32, window: usize) -> Result<(), Invalid> {
        let length = self.best.len();
        within("best", length, 0..=window.min(iterations as usize))?;
        for (field, values) in [("best", &self.best), ("median", &self.median)] {
            check_floats(field, &values.iter().copied().collect::<Vec<_>>(), length)?;
        }
        check_floats("worst", &[self.worst], 1)
    }

    /// Returns the smallest and the largest best value of the latest `window` iterations. None if there are fewer iterations.
    pub fn range(&self, window: usize) -> Option<(f64, f64)> {
        let skipped = self.best.len().checked_sub(window)?;
        let latest = self.best.iter().skip(skipped);
        Some(latest.fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x))))
    }

    /// Returns whether, for best and median values, the latest 30 % of `window` iterations were no better than the first 30 %.
    pub fn stagnates(&self, window: usize) -> bool {
        let Some(skipped) = self.best.len().checked_sub(window) else {
            return false;
        };
        let part = window * 3 / 10;
        [&self.best, &self.median].into_iter().all(|values| {
            let first = median(values.iter().skip(skipped).take(part));
            let latest = median(values.iter().rev().take(part));
            latest <= first
        })
    }
}

/// Returns the median; of an even number of values the upper of the two middle ones, and 0 if there are none.
fn median<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    let mut values: Vec<f64> = values.copied().collect();
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Numbers of past iterations that the criteria compare.
#[derive(Debug, Clone, Copy)]
pub struct HistoryWindows {
    /// Number of iterations whose values must differ.
    pub short: usize,
    /// Number of iterations in which the values must improve: the latest 20 %, but not too few. It grows by at most one per iteration, so
    /// that older values need not be stored.
    pub long: usize,
}

impl HistoryWindows {
    /// Returns the windows of a run after `iteration` iterations.
    pub fn new(dimension: usize, population: u32, iteration: u32) -> Self {
        // The unit is 30 n / λ, in iterations.
        let unit = (30 * dimension).div_ceil(population as usize);
        let long = (120 + unit).max(iteration as usize / 5);
        Self { short: (10 + unit).min(LONGEST_HISTORY), long: long.min(LONGEST_HISTORY) }
    }
}
