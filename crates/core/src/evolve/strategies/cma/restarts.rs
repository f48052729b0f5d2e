//! CMA-ES with restarts.
//!
//! IPOP is after Auger & Hansen 2005, "A Restart CMA Evolution Strategy With Increasing Population Size", and BIPOP after Hansen 2009,
//! "Benchmarking a BI-Population CMA-ES on the BBOB-2009 Function Testbed".

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::candidate::RankedCandidate;
use super::rates::CovarianceShape;
use super::run::Cma;
use crate::check::{Invalid, within};
use crate::evolve::settings::{LARGEST_POPULATION, LARGEST_SAMPLE, RestartKind};
use crate::rng::uniform;

/// Maximum number of times that the population of large runs doubles.
const MOST_DOUBLINGS: u32 = 9;

/// Parameters with which each run begins.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CmaParameters {
    /// First standard deviation of every coordinate, in box widths. Usual values are 0.2 to 0.5.
    pub step: f64,
    /// Number of candidates per iteration of the first run.
    pub population: u32,
    /// Shape of the covariance.
    pub shape: CovarianceShape,
    /// Whether bad candidates make their directions less likely, which usually saves evaluations.
    pub active: bool,
    /// Kind of restart after a run has ended.
    pub restart: RestartKind,
}

/// A series of runs of CMA-ES. The state is complete, so that it continues bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestartedCma {
    /// Parameters with which runs begin.
    pub parameters: CmaParameters,
    /// The current run.
    pub current: Cma,
    pub(super) restarts: u32,
    /// Number of times that the population of the large runs has doubled.
    doublings: u32,
    /// Whether the current run is a small run.
    small: bool,
    /// Maximum number of evaluations of the current run. None: no limit.
    limit: Option<u64>,
    /// Number of evaluations of all small runs that have ended.
    small_evaluations: u64,
    /// Number of evaluations of all large runs that have ended.
    large_evaluations: u64,
}

impl RestartedCma {
    /// Begins a first run around the point `start`.
    pub fn new(parameters: CmaParameters, start: Vec<f64>) -> Result<Self, Invalid> {
        let CmaParameters { step, population, shape, active, restart } = parameters;
        let current = Cma::new(start, step, population, shape, active)?;
        let small = restart == RestartKind::Bipop;
        Ok(Self {
            parameters,
            current,
            restarts: 0,
            doublings: 0,
            small,
            limit: None,
            small_evaluations: 0,
            large_evaluations: 0,
        })
    }

    /// Returns this series with a separate standard deviation for each coordinate of its first run, given as factors of the step.
    #[must_use]
    pub fn with_scales(mut self, scales: &[f64]) -> Self {
        self.current.scale(scales);
        self
    }

    /// Learns from all candidates of the current iteration, best first; see [`Cma::update`]. If the run has then ended, a new run starts at
    /// a random point of the unit box.
    pub fn update(
        &mut self,
        ranked: &[RankedCandidate],
        random: &mut ChaCha8Rng,
    ) -> Result<(), Invalid> {
        self.current.update(ranked)?;
        let spent = self.limit.is_some_and(|limit| self.evaluations() >= limit);
        let ended = spent || self.current.stop.is_some();
        if ended && self.parameters.restart != RestartKind::None {
            self.restart(random)?;
        }
        Ok(())
    }

    /// Checks a state that was read from a file; see [`Cma::check`].
    pub fn check(&self) -> Result<(), Invalid> {
        self.current.check().map_err(|invalid| invalid.inside("current"))?;
        within("doublings", self.doublings, 0..=MOST_DOUBLINGS)?;
        let start = vec![0.5; self.current.mean.len()];
        Self::new(self.parameters.clone(), start)
            .map_err(|invalid| invalid.inside("parameters"))?;
        let CmaParameters { shape, active, .. } = self.parameters;
        if (self.current.shape, self.current.active) != (shape, active) {
            let allowed = "a run with the parameters of the state";
            return Err(Invalid::new("current", "a run with other parameters", allowed));
        }
        Ok(())
    }

    /// Returns the number of evaluations of the current run.
    fn evaluations(&self) -> u64 {
        u64::from(self.current.iteration) * u64::from(self.current.population)
    }

    fn restart(&mut self, random: &mut ChaCha8Rng) -> Result<(), Invalid> {
        let evaluations = self.evaluations();
        let used =
            if self.small { &mut self.small_evaluations } else { &mut self.large_evaluations };
        *used = used.saturating_add(evaluations);
        self.small = self.parameters.restart == RestartKind::Bipop
            && self.small_evaluations < self.large_evaluations;
        let (step, population) = if self.small { self.small_run(random) } else { self.large_run() };
        self.limit = self.small.then_some(self.large_evaluations / 2);
        let CmaParameters { shape, active, .. } = self.parameters;
        let start = random_point(self.current.mean.len(), random);
        self.current = Cma::new(start, step, population, shape, active)?;
        self.restarts = self.restarts.saturating_add(1);
        Ok(())
    }

    /// Returns the step size and the population of the next large run, after doubling the latter.
    fn large_run(&mut self) -> (f64, u32) {
        self.doublings = (self.doublings + 1).min(MOST_DOUBLINGS);
        (self.parameters.step, self.large_population())
    }

    /// Draws the step size and the population of the next small run: σ₀ 10^(-2 U) and ⌊λ₀ (½ λ_large / λ₀)^(U²)⌋, with separate numbers U
    /// from [0, 1).
    fn small_run(&self, random: &mut ChaCha8Rng) -> (f64, u32) {
        let (for_step, for_population) = (uniform(random), uniform(random));
        let first = f64::from(self.parameters.population);
        let ratio = (0.5 * f64::from(self.large_population()) / first).max(1.0);
        let population = first * libm::pow(ratio, for_population * for_population);
        (self.parameters.step * libm::pow(10.0, -2.0 * for_step), population.floor() as u32)
    }

    /// Returns the population of large runs, limited by memory.
    fn large_population(&self) -> u32 {
        let affordable = LARGEST_SAMPLE / self.current.mean.len();
        let affordable = u32::try_from(affordable).unwrap_or(LARGEST_POPULATION);
        let wanted = self.parameters.population.saturating_mul(1 << self.doublings);
        wanted.min(affordable).min(LARGEST_POPULATION)
    }
}

/// Draws a point from the unit box [0, 1)ⁿ.
pub fn random_point(dimension: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    (0..dimension).map(|_| uniform(random)).collect()
}
