//! A run of CMA-ES without restarts.
//!
//! The search draws candidates from a normal distribution, and moves, scales and shapes the distribution so that good candidates become
//! more likely. It follows Hansen, "The CMA Evolution Strategy: A Tutorial" (arXiv:1604.00772v2); "eq." is an equation of the tutorial and
//! "Table 1" its table of parameters. For many dimensions the covariance may be diagonal (Ros & Hansen 2008, "A Simple Modification in
//! CMA-ES Achieving Linear Time and Space Complexity").
//!
//! Only the four operations, roots and `libm` are used, sums run in the order of the elements, and random numbers come from named streams.
//! Equal states therefore give equal bits on every machine.

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::candidate::{RankedCandidate, check_floats};
use super::eigen::{PrincipalAxes, dot};
use super::rates::{CovarianceShape, LearningRates};
use super::termination::{HistoryWindows, StopReason, ValueHistory};
use crate::check::{Invalid, within};
use crate::evolve::settings::{LARGEST_POPULATION, LARGEST_SAMPLE};
use crate::rng::normal;

/// Maximum dimension of a full covariance. The time to find its axes is cubic in the dimension.
pub const LARGEST_FULL: usize = 256;
/// Maximum dimension of a diagonal covariance.
pub const LARGEST_DIAGONAL: usize = 1_000_000;
/// A run of CMA-ES without restarts. The state is complete, so that it continues bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cma {
    pub(super) shape: CovarianceShape,
    /// Whether bad candidates make their directions less likely.
    pub(super) active: bool,
    /// λ: number of candidates per iteration.
    pub population: u32,
    /// g: number of iterations learned.
    pub iteration: u32,
    /// m: centre of the distribution, which is the best estimate of the optimum.
    pub mean: Vec<f64>,
    /// Overall standard deviation at the start.
    pub initial_step: f64,
    /// σ: overall standard deviation.
    pub step: f64,
    /// p_σ: evolution path of the step size.
    step_path: Vec<f64>,
    /// p_c: evolution path of the covariance.
    covariance_path: Vec<f64>,
    /// C, without σ²: the lower triangle row by row, or the diagonal only, depending on the shape.
    covariance: Vec<f64>,
    history: ValueHistory,
    /// Why the run has ended, after which it learns nothing. None while the run continues.
    pub stop: Option<StopReason>,
}

impl Cma {
    /// Begins a run around `mean` with the standard deviation `step` in every coordinate. `population` is at least 2; the tutorial
    /// recommends 4 + ⌊3 ln n⌋. By default, `active` is true.
    pub fn new(
        mean: Vec<f64>,
        step: f64,
        population: u32,
        shape: CovarianceShape,
        active: bool,
    ) -> Result<Self, Invalid> {
        let dimension = mean.len();
        check_size(shape, dimension, population)?;
        let mut run = Self {
            shape,
            active,
            population,
            iteration: 0,
            mean,
            initial_step: step,
            step,
            step_path: vec![0.0; dimension],
            covariance_path: vec![0.0; dimension],
            covariance: vec![0.0; entries(shape, dimension)],
            history: ValueHistory::default(),
            stop: None,
        };
        (0..dimension).for_each(|i| run.covariance[diagonal_index(shape, i)] = 1.0);
        run.check()?;
        Ok(run)
    }

    /// Scales the standard deviation of each coordinate, before the first iteration.
    pub fn scale(&mut self, scales: &[f64]) {
        for (coordinate, scale) in scales.iter().enumerate().take(self.mean.len()) {
            self.covariance[diagonal_index(self.shape, coordinate)] *= scale * scale;
        }
    }

    /// Returns the candidates of the current iteration. `random` returns the stream of the candidate with an index, which should differ in
    /// every iteration. Candidates may have any coordinates: the caller handles bounds.
    pub fn candidates(&self, random: impl Fn(u32) -> ChaCha8Rng) -> Vec<Vec<f64>> {
        let axes = self.axes();
        let candidate = |index| {
            let mut random = random(index);
            let normals: Vec<f64> = (0..self.mean.len()).map(|_| normal(&mut random)).collect();
            // Eqs. 38 to 40.
            let shift = axes.stretched(&normals);
            self.mean.iter().zip(shift).map(|(m, y)| m + self.step * y).collect()
        };
        (0..self.population).map(candidate).collect()
    }

    /// Learns from all candidates of the current iteration, best first.
    ///
    /// If numbers leave the range of `f64`, the run keeps its state and ends.
    ///
    /// # Errors
    /// Fails if the number or dimension of candidates differs from that of [`Self::candidates`], or if a coordinate is not finite. The
    /// state then stays unchanged.
    pub fn update(&mut self, ranked: &[RankedCandidate]) -> Result<(), Invalid> {
        self.check_candidates(ranked)?;
        if self.stop.is_some() {
            return Ok(());
        }
        let mut next = self.clone();
        next.learn(ranked);
        next.history.record(ranked, next.windows().long);
        if next.check().is_ok() {
            next.stop = next.reason_to_stop();
            *self = next;
        } else {
            self.stop = Some(StopReason::Numbers);
        }
        Ok(())
    }

    /// Forgets the values of all iterations so far, because they are not comparable with values of later iterations. The criteria that
    /// compare values begin anew.
    pub fn forget_values(&mut self) {
        self.history = ValueHistory::default();
    }

    /// Checks a state from a file. A run that passes the check cannot panic, and its candidates have at most [`LARGEST_SAMPLE`]
    /// coordinates.
    pub fn check(&self) -> Result<(), Invalid> {
        let dimension = self.mean.len();
        check_size(self.shape, dimension, self.population)?;
        check_floats("mean", &self.mean, dimension)?;
        check_floats("step_path", &self.step_path, dimension)?;
        check_floats("covariance_path", &self.covariance_path, dimension)?;
        check_floats("covariance", &self.covariance, entries(self.shape, dimension))?;
        if let Some(variance) = self.variances().find(|&variance| variance <= 0.0) {
            return Err(Invalid::new("covariance", variance, "a positive diagonal"));
        }
        within("initial_step", self.initial_step, f64::MIN_POSITIVE..=f64::MAX)?;
        within("step", self.step, f64::MIN_POSITIVE..=f64::MAX)?;
        self.history.check(self.iteration, self.windows().long).map_err(|e| e.inside("history"))
    }

    fn windows(&self) -> HistoryWindows {
        HistoryWindows::new(self.mean.len(), self.population, self.iteration)
    }

    /// Returns the reason of the first criterion that is met (appendix B.3 of the tutorial).
    fn reason_to_stop(&self) -> Option<StopReason> {
        let (axes, windows) = (self.axes(), self.windows());
        let variances: Vec<f64> = self.variances().collect();
        let shortest = 1e-12 * self.initial_step;
        let has_short_steps = variances.iter().all(|v| self.step * v.sqrt() < shortest)
            && self.covariance_path.iter().all(|x| self.step * x.abs() < shortest);
        let mut coordinates = self.mean.iter().zip(&variances);
        let has_idle_coordinate = coordinates.any(|(&m, v)| m == m + 0.2 * self.step * v.sqrt());
        let axis = axes.axis(self.iteration as usize);
        let is_idle_axis = self.mean.iter().zip(axis).all(|(&m, x)| m == m + 0.1 * self.step * x);
        let range = self.history.range(windows.short);
        let close = |(low, high): (f64, f64)| high - low.min(self.history.worst) < 1e-12;
        let criteria = [
            (axes.condition() > 1e14, StopReason::Condition),
            (range.is_some_and(|(low, high)| low == high), StopReason::EqualValues),
            (range.is_some_and(close), StopReason::CloseValues),
            (self.history.stagnates(windows.long), StopReason::Stagnation),
            (has_short_steps, StopReason::ShortSteps),
            (self.step * axes.longest() > 1e4 * self.initial_step, StopReason::LongSteps),
            (has_idle_coordinate, StopReason::CoordinateWithoutEffect),
            (is_idle_axis, StopReason::AxisWithoutEffect),
        ];
        criteria.into_iter().find(|(met, _)| *met).map(|(_, reason)| reason)
    }

    fn check_candidates(&self, ranked: &[RankedCandidate]) -> Result<(), Invalid> {
        if ranked.len() != self.population as usize {
            return Err(Invalid::new("candidates", ranked.len(), self.population.to_string()));
        }
        let mut points = ranked.iter().map(|candidate| candidate.point);
        points.try_for_each(|point| check_floats("candidate", point, self.mean.len()))
    }

    /// Returns the principal axes of C.
    fn axes(&self) -> PrincipalAxes {
        match self.shape {
            CovarianceShape::Full => PrincipalAxes::of_symmetric(&self.covariance, self.mean.len()),
            CovarianceShape::Diagonal => PrincipalAxes::of_diagonal(&self.covariance),
        }
    }

    /// Returns the diagonal of C.
    fn variances(&self) -> impl Iterator<Item = f64> {
        let places = (0..self.mean.len()).map(|i| diagonal_index(self.shape, i));
        places.filter_map(|place| self.covariance.get(place).copied())
    }

    /// Performs one iteration (appendix A of the tutorial).
    fn learn(&mut self, ranked: &[RankedCandidate]) {
        let rates = LearningRates::new(self.mean.len(), self.population, self.shape, self.active);
        let axes = self.axes();
        let shifts: Vec<Vec<f64>> = ranked.iter().map(|c| self.shift_to(c.point)).collect();
        // Eqs. 41 and 42: the mean moves to the weighted mean of the better half.
        let mut shift = vec![0.0; self.mean.len()];
        for (&weight, y) in rates.weights.iter().zip(&shifts).filter(|(weight, _)| **weight > 0.0) {
            add(&mut shift, weight, y);
        }
        add(&mut self.mean, self.step, &shift);
        // Eqs. 43 and 44: the step size grows if consecutive shifts have similar directions, and shrinks if they cancel.
        let white = axes.turned(&axes.whitened(&shift));
        fade(&mut self.step_path, rates.step_path, rates.selection_mass, &white);
        let length = dot(&self.step_path, &self.step_path).sqrt();
        let surplus = length / rates.expected_length - 1.0;
        self.step *= libm::exp(rates.step_path / rates.damping * surplus);
        // Eq. 45. While the path of the step size is far too long, the covariance's path gets no shift, so that the covariance does not
        // grow as well.
        let calm = rates.is_calm(length, self.iteration);
        if calm {
            fade(&mut self.covariance_path, rates.path, rates.selection_mass, &shift);
        } else {
            self.covariance_path.iter_mut().for_each(|x| *x *= 1.0 - rates.path);
        }
        self.adapt(&rates, calm, &axes, &shifts);
        self.iteration = self.iteration.saturating_add(1);
    }

    /// Returns y = (x - m) / σ.
    fn shift_to(&self, point: &[f64]) -> Vec<f64> {
        point.iter().zip(&self.mean).map(|(x, m)| (x - m) / self.step).collect()
    }

    /// Applies eqs. 46 and 47: the covariance decays a little, and learns its path (rank one) and the shifts (rank μ). A bad shift counts
    /// as if it had the expected length.
    fn adapt(
        &mut self,
        rates: &LearningRates,
        calm: bool,
        axes: &PrincipalAxes,
        shifts: &[Vec<f64>],
    ) {
        let missing = if calm { 0.0 } else { rates.path * (2.0 - rates.path) };
        let sum = rates.weights.iter().fold(0.0, |sum, weight| sum + weight);
        let keep = 1.0 + rates.one * missing - rates.one - rates.many * sum;
        self.covariance.iter_mut().for_each(|entry| *entry *= keep);
        add_square(&mut self.covariance, self.shape, rates.one, &self.covariance_path);
        for (&weight, y) in rates.weights.iter().zip(shifts).filter(|(weight, _)| **weight != 0.0) {
            let scale = if weight > 0.0 { 1.0 } else { rates.shrunk(&axes.whitened(y)) };
            add_square(&mut self.covariance, self.shape, rates.many * weight * scale, y);
        }
    }
}

/// Computes vector += factor · other.
fn add(vector: &mut [f64], factor: f64, other: &[f64]) {
    vector.iter_mut().zip(other).for_each(|(x, y)| *x += factor * y);
}

/// Lets an evolution path decay at `rate` and adds a shift, scaled so that the path of a random walk keeps its variance.
fn fade(path: &mut [f64], rate: f64, mass: f64, shift: &[f64]) {
    let uptake = (rate * (2.0 - rate) * mass).sqrt();
    path.iter_mut().zip(shift).for_each(|(x, y)| *x = (1.0 - rate) * *x + uptake * y);
}

/// Computes covariance += factor · v vᵀ, for the entries of the shape only.
fn add_square(covariance: &mut [f64], shape: CovarianceShape, factor: f64, vector: &[f64]) {
    if shape == CovarianceShape::Diagonal {
        covariance.iter_mut().zip(vector).for_each(|(entry, x)| *entry += factor * x * x);
        return;
    }
    let mut rest = covariance.iter_mut();
    for (row, x) in vector.iter().enumerate() {
        vector[..=row].iter().zip(rest.by_ref()).for_each(|(y, entry)| *entry += factor * x * y);
    }
}

/// Returns the number of stored entries of a covariance.
fn entries(shape: CovarianceShape, dimension: usize) -> usize {
    match shape {
        CovarianceShape::Full => dimension * (dimension + 1) / 2,
        CovarianceShape::Diagonal => dimension,
    }
}

/// Returns the index of a coordinate's variance, the last entry of its row, among the stored entries of a covariance.
fn diagonal_index(shape: CovarianceShape, coordinate: usize) -> usize {
    entries(shape, coordinate + 1) - 1
}

/// Checks that a run of this size fits into memory.
fn check_size(shape: CovarianceShape, dimension: usize, population: u32) -> Result<(), Invalid> {
    let largest = if shape == CovarianceShape::Full { LARGEST_FULL } else { LARGEST_DIAGONAL };
    within("dimension", dimension, 1..=largest)?;
    within("population", population, 2..=LARGEST_POPULATION)?;
    within("population · dimension", dimension * population as usize, 1..=LARGEST_SAMPLE)
}
