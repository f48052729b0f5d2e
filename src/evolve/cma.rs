//! One run of the covariance matrix adaptation evolution strategy.
//!
//! The search draws candidates from a normal distribution and moves, scales and shapes it so that
//! what did well becomes likelier. Everything follows Hansen, "The CMA Evolution Strategy: A
//! Tutorial" (arXiv:1604.00772v2); "eq." is an equation and "Table 1" the table of parameters there.
//! For many dimensions the covariance may be kept diagonal (Ros & Hansen 2008, "A Simple Modification
//! in CMA-ES Achieving Linear Time and Space Complexity").
//!
//! Only the four operations, roots and `libm` are used, sums run from the front, and random numbers
//! come from named streams: the same state gives the same bits on every machine.

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::LARGEST_POPULATION;
use super::eigen::{Axes, dot};
use super::restarts::{History, Stop};
use super::search::normal;
use crate::check::{Invalid, within};

/// The most dimensions of a full covariance, whose axes take time cubic in them.
pub const LARGEST_FULL: usize = 256;
/// The most dimensions of a diagonal covariance.
pub const LARGEST_DIAGONAL: usize = 1_000_000;
/// The most coordinates that all candidates of one iteration may have together: 64 MiB.
pub const LARGEST_SAMPLE: usize = 1 << 23;

/// What the covariance can express.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shape {
    /// Every dependence between coordinates.
    Full,
    /// One variance per coordinate: time and memory are linear in the dimension, and learning is
    /// (dimension + 2) / 3 times as fast.
    Diagonal,
}

/// A candidate and what it is worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranked<'a> {
    /// The candidate as it was drawn.
    pub point: &'a [f64],
    /// Larger is better. Not a number counts as the worst there is. The search itself uses ranks
    /// only; values decide no more than when a run has come to its end.
    pub value: f64,
}

impl<'a> Ranked<'a> {
    /// The candidates with their values, best first; equals stay in order.
    pub fn best_first(candidates: &'a [Vec<f64>], values: &[f64]) -> Vec<Self> {
        let pairs = candidates.iter().zip(values);
        let mut ranked: Vec<_> =
            pairs.map(|(point, &value)| Self { point, value: plain(value) }).collect();
        ranked.sort_by(|a, b| b.value.total_cmp(&a.value));
        ranked
    }
}

/// A run without restarts: the whole state, from which it goes on bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cma {
    shape: Shape,
    /// Whether what did badly makes its direction less likely.
    active: bool,
    /// Candidates per iteration, λ.
    pub(super) population: u32,
    /// Iterations that have been learned from, g.
    pub(super) iteration: u32,
    /// The centre of the distribution, m.
    pub(super) mean: Vec<f64>,
    pub(super) initial_step: f64,
    /// The overall standard deviation, σ.
    pub(super) step: f64,
    /// The evolution path of the step size, p_σ.
    step_path: Vec<f64>,
    /// The evolution path of the covariance, p_c.
    pub(super) covariance_path: Vec<f64>,
    /// C without σ²: the lower triangle row by row, or only the diagonal if that is the shape.
    covariance: Vec<f64>,
    pub(super) history: History,
    stop: Option<Stop>,
}

impl Cma {
    /// A run that starts around `mean` with the standard deviation `step` in every coordinate.
    /// `population` is at least 2; the tutorial recommends 4 + ⌊3 ln n⌋. `active` is the default nowadays.
    pub fn new(
        mean: Vec<f64>,
        step: f64,
        population: u32,
        shape: Shape,
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
            history: History::default(),
            stop: None,
        };
        (0..dimension).for_each(|i| run.covariance[diagonal_place(shape, i)] = 1.0);
        run.check()?;
        Ok(run)
    }

    /// Candidates per iteration.
    pub fn population(&self) -> u32 {
        self.population
    }

    /// Iterations that have been learned from.
    pub fn iteration(&self) -> u32 {
        self.iteration
    }

    /// The centre of the distribution, which is the best guess at the optimum.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// The overall standard deviation.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Why the run has come to its end, if it has. It then learns nothing more.
    pub fn stop(&self) -> Option<Stop> {
        self.stop
    }

    /// The candidates of this iteration; `random` gives the stream of the candidate with that index,
    /// and should give others in every iteration. They may lie anywhere: bounds are the caller's.
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

    /// Learns from all candidates of this iteration, best first.
    ///
    /// Fails, and learns nothing, if their number or dimension is another than that of
    /// [`Self::candidates`], or if one is not finite. If numbers leave the range of `f64`, the run
    /// stays as it was and stops.
    pub fn update(&mut self, ranked: &[Ranked]) -> Result<(), Invalid> {
        self.check_candidates(ranked)?;
        if self.stop.is_some() {
            return Ok(());
        }
        let mut next = self.clone();
        next.learn(ranked);
        next.history.record(ranked, next.long_window());
        if next.check().is_ok() {
            next.stop = next.reason_to_stop();
            *self = next;
        } else {
            self.stop = Some(Stop::Numbers);
        }
        Ok(())
    }

    /// Checks a state that was read from a file: whatever passes can be used without a panic, and its
    /// candidates have no more than [`LARGEST_SAMPLE`] coordinates.
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
        self.history.check(self.iteration, self.long_window()).map_err(|e| e.inside("history"))
    }

    /// Whether the run has this shape and is active or not.
    pub(super) fn is_of(&self, shape: Shape, active: bool) -> bool {
        self.shape == shape && self.active == active
    }

    fn check_candidates(&self, ranked: &[Ranked]) -> Result<(), Invalid> {
        if ranked.len() != self.population as usize {
            return Err(Invalid::new("candidates", ranked.len(), self.population.to_string()));
        }
        let mut points = ranked.iter().map(|candidate| candidate.point);
        points.try_for_each(|point| check_floats("candidate", point, self.mean.len()))
    }

    /// The principal axes of C.
    pub(super) fn axes(&self) -> Axes {
        match self.shape {
            Shape::Full => Axes::of_symmetric(&self.covariance, self.mean.len()),
            Shape::Diagonal => Axes::of_diagonal(&self.covariance),
        }
    }

    /// The diagonal of C.
    pub(super) fn variances(&self) -> impl Iterator<Item = f64> {
        let places = (0..self.mean.len()).map(|i| diagonal_place(self.shape, i));
        places.filter_map(|place| self.covariance.get(place).copied())
    }

    /// One iteration (appendix A of the tutorial).
    fn learn(&mut self, ranked: &[Ranked]) {
        let rates = Rates::new(self.mean.len(), self.population, self.shape, self.active);
        let axes = self.axes();
        let shifts: Vec<Vec<f64>> = ranked.iter().map(|c| self.shift_to(c.point)).collect();
        // Eqs. 41 and 42: the mean moves to the weighted mean of the better half.
        let mut shift = vec![0.0; self.mean.len()];
        for (&weight, y) in rates.weights.iter().zip(&shifts).filter(|(weight, _)| **weight > 0.0) {
            add(&mut shift, weight, y);
        }
        add(&mut self.mean, self.step, &shift);
        // Eqs. 43 and 44: steps that go on in one direction are too short, those that undo each
        // other too long.
        let white = axes.turned(&axes.whitened(&shift));
        fade(&mut self.step_path, rates.step_path, rates.selection_mass, &white);
        let length = dot(&self.step_path, &self.step_path).sqrt();
        let surplus = length / rates.expected_length - 1.0;
        self.step *= libm::exp(rates.step_path / rates.damping * surplus);
        // Eq. 45; a path that is still far too long does not stretch the covariance, too.
        let calm = rates.is_calm(length, self.iteration);
        if calm {
            fade(&mut self.covariance_path, rates.path, rates.selection_mass, &shift);
        } else {
            self.covariance_path.iter_mut().for_each(|x| *x *= 1.0 - rates.path);
        }
        self.adapt(&rates, calm, &axes, &shifts);
        self.iteration = self.iteration.saturating_add(1);
    }

    /// y = (x - m) / σ.
    fn shift_to(&self, point: &[f64]) -> Vec<f64> {
        point.iter().zip(&self.mean).map(|(x, m)| (x - m) / self.step).collect()
    }

    /// Eqs. 46 and 47: the covariance forgets a little, and learns its path (rank one) and the shifts
    /// (rank μ); a bad shift counts as if it had the expected length.
    fn adapt(&mut self, rates: &Rates, calm: bool, axes: &Axes, shifts: &[Vec<f64>]) {
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

/// The default parameters of Table 1, which follow from dimension and population.
struct Rates {
    dimension: f64,
    /// w: per rank, best first. The positive ones sum to 1.
    weights: Vec<f64>,
    /// μ_eff: how many candidates the positive weights amount to.
    selection_mass: f64,
    /// c_σ.
    step_path: f64,
    /// d_σ.
    damping: f64,
    /// c_c.
    path: f64,
    /// c_1.
    one: f64,
    /// c_μ.
    many: f64,
    /// The expected length of a standard normal vector (approximated as in the tutorial).
    expected_length: f64,
}

impl Rates {
    fn new(dimension: usize, population: u32, shape: Shape, active: bool) -> Self {
        let n = real(dimension);
        // Eq. 49.
        let middle = libm::log((f64::from(population) + 1.0) / 2.0);
        let mut weights: Vec<f64> =
            (1..=population).map(|rank| middle - libm::log(f64::from(rank))).collect();
        let (good, mass) = sum_and_mass(weights.iter().filter(|weight| **weight > 0.0));
        let (bad, bad_mass) = sum_and_mass(weights.iter().filter(|weight| **weight < 0.0));
        // Eqs. 57 and 58, with the factor of Ros & Hansen for a diagonal.
        let speed = if shape == Shape::Diagonal { (n + 2.0) / 3.0 } else { 1.0 };
        let one = (speed * 2.0 / ((n + 1.3) * (n + 1.3) + mass)).min(1.0);
        let many = speed * 2.0 * (0.25 + mass + 1.0 / mass - 2.0) / ((n + 2.0) * (n + 2.0) + mass);
        let many = many.min(1.0 - one);
        // Eqs. 50 to 53: the third limit keeps the covariance positive definite.
        let limits = [2.0 * bad_mass / (mass + 2.0) + 1.0, (1.0 - one - many) / (n * many)];
        let limit = limits.into_iter().fold(1.0 + one / many, f64::min);
        let bad_scale = if active && many > 0.0 { limit / bad.abs() } else { 0.0 };
        weights.iter_mut().for_each(|w| *w *= if *w > 0.0 { 1.0 / good } else { bad_scale });
        // Eqs. 55 and 56.
        let step_path = (mass + 2.0) / (n + mass + 5.0);
        let surplus = ((mass - 1.0) / (n + 1.0)).sqrt() - 1.0;
        Self {
            dimension: n,
            weights,
            selection_mass: mass,
            step_path,
            damping: 1.0 + 2.0 * surplus.max(0.0) + step_path,
            path: (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n),
            one,
            many,
            expected_length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }

    /// What makes the square of a bad shift, given in white coordinates, n (eq. 46). A candidate on
    /// the mean itself has no direction and teaches nothing.
    fn shrunk(&self, white: &[f64]) -> f64 {
        let square = dot(white, white);
        if square > 0.0 { self.dimension / square } else { 0.0 }
    }

    /// h_σ: whether the path of the step size is not much longer than that of a random walk.
    fn is_calm(&self, length: f64, iteration: u32) -> bool {
        let rest = libm::pow(1.0 - self.step_path, 2.0 * (f64::from(iteration) + 1.0));
        let limit = (1.4 + 2.0 / (self.dimension + 1.0)) * self.expected_length;
        length / (1.0 - rest).sqrt() < limit
    }
}

/// The sum of some weights, and its square over the sum of their squares: how many they amount to.
fn sum_and_mass<'a>(weights: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let (sum, squares) = weights.fold((0.0, 0.0), |(sum, squares), w| (sum + w, squares + w * w));
    (sum, sum * sum / squares)
}

/// vector += factor · other.
fn add(vector: &mut [f64], factor: f64, other: &[f64]) {
    vector.iter_mut().zip(other).for_each(|(x, y)| *x += factor * y);
}

/// An evolution path fades at `rate` and takes up a shift, so that a random walk keeps its variance.
fn fade(path: &mut [f64], rate: f64, mass: f64, shift: &[f64]) {
    let uptake = (rate * (2.0 - rate) * mass).sqrt();
    path.iter_mut().zip(shift).for_each(|(x, y)| *x = (1.0 - rate) * *x + uptake * y);
}

/// covariance += factor · v vᵀ, as much of it as the shape holds.
fn add_square(covariance: &mut [f64], shape: Shape, factor: f64, vector: &[f64]) {
    if shape == Shape::Diagonal {
        covariance.iter_mut().zip(vector).for_each(|(entry, x)| *entry += factor * x * x);
        return;
    }
    let mut rest = covariance.iter_mut();
    for (row, x) in vector.iter().enumerate() {
        vector[..=row].iter().zip(rest.by_ref()).for_each(|(y, entry)| *entry += factor * x * y);
    }
}

/// How many numbers the covariance has.
fn entries(shape: Shape, dimension: usize) -> usize {
    match shape {
        Shape::Full => dimension * (dimension + 1) / 2,
        Shape::Diagonal => dimension,
    }
}

/// Where in the covariance the variance of a coordinate stands.
fn diagonal_place(shape: Shape, coordinate: usize) -> usize {
    match shape {
        Shape::Full => coordinate * (coordinate + 3) / 2,
        Shape::Diagonal => coordinate,
    }
}

/// A count as a float: exact up to 2⁵³.
pub(super) fn real(count: usize) -> f64 {
    count as f64
}

/// A value that can be stored as text and compared: not a number becomes the worst there is.
pub(super) fn plain(value: f64) -> f64 {
    if value.is_nan() { f64::MIN } else { value.clamp(f64::MIN, f64::MAX) }
}

/// Checks that a run of this size fits into memory.
fn check_size(shape: Shape, dimension: usize, population: u32) -> Result<(), Invalid> {
    let largest = if shape == Shape::Full { LARGEST_FULL } else { LARGEST_DIAGONAL };
    within("dimension", dimension, 1..=largest)?;
    within("population", population, 2..=LARGEST_POPULATION)?;
    within("population · dimension", dimension * population as usize, 1..=LARGEST_SAMPLE)
}

/// Checks that so many numbers are there and that all are finite.
pub(super) fn check_floats(field: &str, floats: &[f64], length: usize) -> Result<(), Invalid> {
    if floats.len() != length {
        return Err(Invalid::new(field, format!("{} numbers", floats.len()), length.to_string()));
    }
    match floats.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Invalid::new(field, x, "finite numbers")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod search_tests;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_those_of_pycma() {
        // From pycma 4.5 (recombination_weights.py, with the tutorial's c_1 and c_mu), n and λ = 10.
        let rates = Rates::new(10, 10, Shape::Full, true);
        let pairs = [
            (rates.selection_mass, 3.1672992814107017),
            (rates.one, 0.015283824524751714),
            (rates.many, 0.02355177665041747),
            (rates.weights[0], 0.45627264690340597),
            (rates.weights[1], 0.2707530970017852),
            (rates.weights[8], -0.45286408637842196),
            (rates.weights[9], -0.5497499176973853),
        ];
        for (ours, theirs) in pairs {
            assert!((ours / theirs - 1.0_f64).abs() < 1e-14, "{ours}, not {theirs}");
        }
        let large = Rates::new(10, 80, Shape::Full, true);
        assert!((large.weights[79] / -0.013668176089411909 - 1.0).abs() < 1e-14);
        let passive = Rates::new(10, 10, Shape::Full, false);
        assert!((passive.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!(passive.weights.iter().all(|&weight| weight >= 0.0));
    }

    #[test]
    fn rates_of_every_size_keep_the_covariance_positive() {
        for (n, population) in [(1, 2), (1, 1000), (2, 3), (30, 5), (30, 5000), (10_000, 31)] {
            for shape in [Shape::Full, Shape::Diagonal] {
                let rates = Rates::new(n, population, shape, true);
                let bad = rates.weights.iter().filter(|w| **w < 0.0).fold(0.0, |sum, w| sum - w);
                let left = 1.0 - rates.one - rates.many - rates.many * bad * rates.dimension;
                assert!(left > -1e-12 && rates.many > 0.0, "{n} {population} {shape:?}: {left}");
                assert!(rates.weights.iter().all(|weight| weight.is_finite()));
            }
        }
    }
}
