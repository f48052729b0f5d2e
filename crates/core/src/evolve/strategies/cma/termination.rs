//! Why a run of CMA-ES ends, and the values by which that is decided: the criteria of the tutorial (arXiv:1604.00772v2,
//! appendix B.3).

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::candidate::{RankedCandidate, check_floats, finite};
use crate::check::{Invalid, within};

/// Maximum number of iterations that the criteria look back.
const LONGEST_HISTORY: usize = 20_000;

/// Why a run has ended, with the name in the tutorial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StopReason {
    /// The best values of many iterations are all the same (EqualFunValues).
    EqualValues,
    /// The best values of many iterations, and all values of the latest one, differ by less than 1e-12 (TolFun).
    CloseValues,
    /// Neither best nor median values have improved for many iterations (Stagnation).
    Stagnation,
    /// Steps have become 1e-12 times as long as at first (TolX).
    ShortSteps,
    /// Steps have become 1e4 times as long as at first (TolXUp).
    LongSteps,
    /// A fifth of a standard deviation is too little to change a coordinate of the mean
    /// (NoEffectCoord).
    CoordinateWithoutEffect,
    /// A tenth of a standard deviation along an axis is too little to change the mean (NoEffectAxis).
    AxisWithoutEffect,
    /// One axis is 1e7 times as long as another (ConditionCov).
    Condition,
    /// Numbers left the range of `f64`.
    Numbers,
}

/// The values of the latest iterations, the oldest first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValueHistory {
    /// The best value of each of the latest iterations.
    best: VecDeque<f64>,
    /// The median value of the same iterations.
    median: VecDeque<f64>,
    /// The worst value of the latest iteration.
    pub worst: f64,
}

impl ValueHistory {
    /// Adds an iteration and keeps only the latest `window`.
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

    /// Checks that there are at most `iterations` and at most `window` values, and that they are finite.
    pub fn check(&self, iterations: u32, window: usize) -> Result<(), Invalid> {
        let length = self.best.len();
        within("best", length, 0..=window.min(iterations as usize))?;
        for (field, values) in [("best", &self.best), ("median", &self.median)] {
            check_floats(field, &values.iter().copied().collect::<Vec<_>>(), length)?;
        }
        check_floats("worst", &[self.worst], 1)
    }

    /// The smallest and the largest best value of the latest `window` iterations, if there are any.
    pub fn range(&self, window: usize) -> Option<(f64, f64)> {
        let skipped = self.best.len().checked_sub(window)?;
        let latest = self.best.iter().skip(skipped);
        Some(latest.fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x))))
    }

    /// Whether the latest 30 % of `window` iterations were no better than the first 30 %.
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

/// The middle of some values, the upper one if there are two; 0 if there is none.
fn median<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    let mut values: Vec<f64> = values.copied().collect();
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Numbers of iterations that the criteria look back.
#[derive(Debug, Clone, Copy)]
pub struct HistoryWindows {
    /// For the question whether values still differ.
    pub short: usize,
    /// For the question whether the run stagnates: the latest 20 %, but not too few. It grows by at most one per
    /// iteration, so that nothing older has to be stored.
    pub long: usize,
}

impl HistoryWindows {
    /// The windows of a run after `iteration` iterations.
    pub fn new(dimension: usize, population: u32, iteration: u32) -> Self {
        // 30 n / λ, in iterations.
        let unit = (30 * dimension).div_ceil(population as usize);
        let long = (120 + unit).max(iteration as usize / 5);
        Self { short: (10 + unit).min(LONGEST_HISTORY), long: long.min(LONGEST_HISTORY) }
    }
}
