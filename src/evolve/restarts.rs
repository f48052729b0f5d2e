//! When a run of CMA-ES has come to its end, and what starts after it.
//!
//! The criteria are those of the tutorial (arXiv:1604.00772v2, appendix B.3). The restarts are those
//! of Auger & Hansen 2005, "A Restart CMA Evolution Strategy With Increasing Population Size" (IPOP),
//! and of Hansen 2009, "Benchmarking a BI-Population CMA-ES on the BBOB-2009 Function Testbed"
//! (BIPOP).

use std::collections::VecDeque;

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::LARGEST_POPULATION;
use super::cma::{Cma, LARGEST_SAMPLE, Ranked, Shape, check_floats, plain};
use super::search::uniform;
use crate::check::{Invalid, within};

/// The most iterations that stagnation is judged by.
const LONGEST_HISTORY: usize = 20_000;
/// How often the population of large runs may double.
const MOST_DOUBLINGS: u32 = 9;

/// Why a run has come to its end. In brackets: what the tutorial calls it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stop {
    /// The best values of many iterations are all the same (EqualFunValues).
    EqualValues,
    /// They, and all values of the latest iteration, differ by less than 1e-12 (TolFun).
    CloseValues,
    /// Neither best nor median values have become better for long (Stagnation).
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
    /// Numbers would have left the range of `f64`.
    Numbers,
}

/// The values that ends are judged by, the oldest first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// The best value of each of the latest iterations.
    best: VecDeque<f64>,
    /// The median value of the same iterations.
    median: VecDeque<f64>,
    /// The worst value of the latest iteration.
    worst: f64,
}

impl History {
    /// Takes up an iteration and forgets all but the latest `window`.
    pub(super) fn record(&mut self, ranked: &[Ranked], window: usize) {
        let value = |rank: usize| ranked.get(rank).map_or(0.0, |candidate| plain(candidate.value));
        let last = ranked.len().saturating_sub(1);
        self.best.push_back(value(0));
        self.median.push_back(0.5 * value(last / 2) + 0.5 * value(ranked.len() / 2));
        self.worst = value(last);
        for values in [&mut self.best, &mut self.median] {
            values.drain(..values.len().saturating_sub(window));
        }
    }

    /// Checks that the values are those of at most `iterations`, at most `window`, and finite.
    pub(super) fn check(&self, iterations: u32, window: usize) -> Result<(), Invalid> {
        let length = self.best.len();
        within("best", length, 0..=window.min(iterations as usize))?;
        for (field, values) in [("best", &self.best), ("median", &self.median)] {
            check_floats(field, &values.iter().copied().collect::<Vec<_>>(), length)?;
        }
        check_floats("worst", &[self.worst], 1)
    }

    /// The smallest and the largest best value of the latest `window` iterations, if there are any.
    fn range(&self, window: usize) -> Option<(f64, f64)> {
        let skipped = self.best.len().checked_sub(window)?;
        let latest = self.best.iter().skip(skipped);
        Some(latest.fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x))))
    }

    /// Whether the latest 30 % of `window` iterations were no better than the first 30 %.
    fn stagnates(&self, window: usize) -> bool {
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

impl Cma {
    /// 30 n / λ, the unit of the windows below, in iterations.
    fn window_unit(&self) -> usize {
        (30 * self.mean.len()).div_ceil(self.population as usize)
    }

    /// The iterations that are asked whether values still differ.
    fn short_window(&self) -> usize {
        (10 + self.window_unit()).min(LONGEST_HISTORY)
    }

    /// The iterations that are asked whether the run stagnates: the latest 20 %, but not too few.
    /// The window grows by at most one per iteration, so that nothing else need be remembered.
    pub(super) fn long_window(&self) -> usize {
        (120 + self.window_unit()).max(self.iteration as usize / 5).min(LONGEST_HISTORY)
    }

    /// The first criterion that is met.
    pub(super) fn reason_to_stop(&self) -> Option<Stop> {
        let axes = self.axes();
        let axis = axes.axis(self.iteration as usize);
        let range = self.history.range(self.short_window());
        let close = |(low, high): (f64, f64)| high - low.min(self.history.worst) < 1e-12;
        let criteria = [
            (axes.condition() > 1e14, Stop::Condition),
            (range.is_some_and(|(low, high)| low == high), Stop::EqualValues),
            (range.is_some_and(close), Stop::CloseValues),
            (self.history.stagnates(self.long_window()), Stop::Stagnation),
            (self.has_short_steps(), Stop::ShortSteps),
            (self.step * axes.longest() > 1e4 * self.initial_step, Stop::LongSteps),
            (self.has_idle_coordinate(), Stop::CoordinateWithoutEffect),
            (self.is_idle_axis(&axis), Stop::AxisWithoutEffect),
        ];
        criteria.into_iter().find(|(met, _)| *met).map(|(_, stop)| stop)
    }

    fn has_short_steps(&self) -> bool {
        let limit = 1e-12 * self.initial_step;
        self.variances().all(|variance| self.step * variance.sqrt() < limit)
            && self.covariance_path.iter().all(|x| self.step * x.abs() < limit)
    }

    fn has_idle_coordinate(&self) -> bool {
        self.mean.iter().zip(self.variances()).any(|(&m, v)| m == m + 0.2 * self.step * v.sqrt())
    }

    fn is_idle_axis(&self, axis: &[f64]) -> bool {
        self.mean.iter().zip(axis).all(|(&m, x)| m == m + 0.1 * self.step * x)
    }
}

/// What happens after a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RestartKind {
    /// Nothing: its distribution stays as it is.
    None,
    /// A run with twice the population, up to 2⁹ times the first.
    Ipop,
    /// Either that, or a run with a small population and a small step size, whichever kind has used
    /// fewer evaluations. As in Hansen's pycma 4.5, the first run counts as small, and a small run
    /// ends after half of the evaluations that the large ones have used.
    Bipop,
}

/// How runs begin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CmaSettings {
    /// The first standard deviation of every coordinate, in box widths. Authors take 0.2 to 0.5.
    pub step: f64,
    /// Candidates per iteration of the first run.
    pub population: u32,
    /// What the covariance can express.
    pub shape: Shape,
    /// Whether bad candidates count, too; as a rule it saves evaluations.
    pub active: bool,
    /// What happens after a run.
    pub restart: RestartKind,
}

/// Runs, one after the other: the whole state, from which they go on bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Restarting {
    settings: CmaSettings,
    current: Cma,
    restarts: u32,
    /// How often the population of the large runs has doubled.
    doublings: u32,
    /// Whether the current run is a small one.
    small: bool,
    /// Evaluations after which the current run ends at the latest.
    limit: Option<u64>,
    /// Evaluations of all small runs that have ended.
    small_evaluations: u64,
    /// Evaluations of all large runs that have ended.
    large_evaluations: u64,
}

impl Restarting {
    /// A first run around `start`.
    pub fn new(settings: CmaSettings, start: Vec<f64>) -> Result<Self, Invalid> {
        let current =
            Cma::new(start, settings.step, settings.population, settings.shape, settings.active)?;
        let small = settings.restart == RestartKind::Bipop;
        Ok(Self {
            settings,
            current,
            restarts: 0,
            doublings: 0,
            small,
            limit: None,
            small_evaluations: 0,
            large_evaluations: 0,
        })
    }

    /// How runs begin.
    pub fn settings(&self) -> &CmaSettings {
        &self.settings
    }

    /// The current run.
    pub fn current(&self) -> &Cma {
        &self.current
    }

    /// How many runs have ended and been followed by another.
    pub fn restarts(&self) -> u32 {
        self.restarts
    }

    /// How many candidates the current iteration has. Restarts change it.
    pub fn population(&self) -> u32 {
        self.current.population()
    }

    /// The candidates of this iteration; see [`Cma::candidates`].
    pub fn candidates(&self, random: impl Fn(u32) -> ChaCha8Rng) -> Vec<Vec<f64>> {
        self.current.candidates(random)
    }

    /// Learns from all candidates of this iteration, best first; see [`Cma::update`]. If the run has
    /// come to its end, the next starts at a point, drawn from `random`, of the unit box.
    pub fn update(&mut self, ranked: &[Ranked], random: &mut ChaCha8Rng) -> Result<(), Invalid> {
        self.current.update(ranked)?;
        let spent = self.limit.is_some_and(|limit| self.evaluations() >= limit);
        let ended = spent || self.current.stop().is_some();
        if ended && self.settings.restart != RestartKind::None {
            self.restart(random)?;
        }
        Ok(())
    }

    /// Checks a state that was read from a file; see [`Cma::check`].
    pub fn check(&self) -> Result<(), Invalid> {
        self.current.check().map_err(|invalid| invalid.inside("current"))?;
        within("doublings", self.doublings, 0..=MOST_DOUBLINGS)?;
        let start = vec![0.5; self.current.mean().len()];
        Self::new(self.settings.clone(), start).map_err(|invalid| invalid.inside("settings"))?;
        let CmaSettings { shape, active, .. } = self.settings;
        if !self.current.is_of(shape, active) {
            return Err(Invalid::new("current", "another kind of run", "what the settings say"));
        }
        Ok(())
    }

    /// Evaluations of the current run.
    fn evaluations(&self) -> u64 {
        u64::from(self.current.iteration()) * u64::from(self.current.population())
    }

    fn restart(&mut self, random: &mut ChaCha8Rng) -> Result<(), Invalid> {
        let evaluations = self.evaluations();
        let used =
            if self.small { &mut self.small_evaluations } else { &mut self.large_evaluations };
        *used = used.saturating_add(evaluations);
        self.small = self.settings.restart == RestartKind::Bipop
            && self.small_evaluations < self.large_evaluations;
        let (step, population) = if self.small { self.small_run(random) } else { self.large_run() };
        self.limit = self.small.then_some(self.large_evaluations / 2);
        let CmaSettings { shape, active, .. } = self.settings;
        let start = random_point(self.current.mean().len(), random);
        self.current = Cma::new(start, step, population, shape, active)?;
        self.restarts = self.restarts.saturating_add(1);
        Ok(())
    }

    /// Step size and population of the next large run.
    fn large_run(&mut self) -> (f64, u32) {
        self.doublings = (self.doublings + 1).min(MOST_DOUBLINGS);
        (self.settings.step, self.large_population())
    }

    /// Step size and population of the next small run: σ₀ 10^(-2 U) and
    /// ⌊λ₀ (½ λ_large / λ₀)^(U²)⌋ with two numbers U from [0, 1).
    fn small_run(&self, random: &mut ChaCha8Rng) -> (f64, u32) {
        let (for_step, for_population) = (uniform(random), uniform(random));
        let first = f64::from(self.settings.population);
        let ratio = (0.5 * f64::from(self.large_population()) / first).max(1.0);
        let population = first * libm::pow(ratio, for_population * for_population);
        (self.settings.step * libm::pow(10.0, -2.0 * for_step), population.floor() as u32)
    }

    /// The population of the latest large run, as far as memory allows.
    fn large_population(&self) -> u32 {
        let affordable = LARGEST_SAMPLE / self.current.mean().len();
        let affordable = u32::try_from(affordable).unwrap_or(LARGEST_POPULATION);
        let wanted = self.settings.population.saturating_mul(1 << self.doublings);
        wanted.min(affordable).min(LARGEST_POPULATION)
    }
}

/// A point drawn from the unit box [0, 1)ⁿ.
pub fn random_point(dimension: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    (0..dimension).map(|_| uniform(random)).collect()
}
