//! Parameters of CMA-ES that follow from dimension and population.

use serde::{Deserialize, Serialize};

use super::eigen::dot;

/// The dependences between coordinates that a covariance can express.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CovarianceShape {
    /// The covariance has an entry for every pair of coordinates.
    Full,
    /// The covariance has one variance per coordinate. Time and memory are linear in the dimension, and learning is (dimension + 2) / 3
    /// times as fast.
    Diagonal,
}

/// Default parameters of Table 1 of the tutorial, which follow from dimension and population.
pub struct LearningRates {
    pub dimension: f64,
    /// w: weight of each rank, best first. The positive weights sum to 1.
    pub weights: Vec<f64>,
    /// μ_eff: effective number of candidates with positive weights.
    pub selection_mass: f64,
    /// c_σ: rate of the evolution path of the step size.
    pub step_path: f64,
    /// d_σ: damping of the step size.
    pub damping: f64,
    /// c_c: rate of the evolution path of the covariance.
    pub path: f64,
    /// c_1: learning rate of the covariance's rank-one update.
    pub one: f64,
    /// c_μ: learning rate of the covariance's rank-μ update.
    pub many: f64,
    /// Expected length of a standard normal vector, by the approximation of the tutorial.
    pub expected_length: f64,
}

impl LearningRates {
    pub fn new(dimension: usize, population: u32, shape: CovarianceShape, active: bool) -> Self {
        let n = dimension as f64;
        // Eq. 49 of the tutorial, before scaling.
        let middle = libm::log((f64::from(population) + 1.0) / 2.0);
        let mut weights: Vec<f64> =
            (1..=population).map(|rank| middle - libm::log(f64::from(rank))).collect();
        let (good, mass) = sum_and_mass(weights.iter().filter(|weight| **weight > 0.0));
        let (bad, bad_mass) = sum_and_mass(weights.iter().filter(|weight| **weight < 0.0));
        // Eqs. 57 and 58, with the factor of Ros & Hansen for a diagonal covariance.
        let speed = if shape == CovarianceShape::Diagonal { (n + 2.0) / 3.0 } else { 1.0 };
        let one = (speed * 2.0 / ((n + 1.3) * (n + 1.3) + mass)).min(1.0);
        let many = speed * 2.0 * (0.25 + mass + 1.0 / mass - 2.0) / ((n + 2.0) * (n + 2.0) + mass);
        let many = many.min(1.0 - one);
        // Eqs. 50 to 53. The third limit keeps the covariance positive definite.
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

    /// Returns the factor of a bad shift's square, which makes the square equal to n, given the shift in white coordinates (eq. 46). 0 for
    /// a candidate on the mean, which has no direction.
    pub fn shrunk(&self, white: &[f64]) -> f64 {
        let square = dot(white, white);
        if square > 0.0 { self.dimension / square } else { 0.0 }
    }

    /// Returns h_σ: whether the path of the step size is not much longer than that of a random walk.
    pub fn is_calm(&self, length: f64, iteration: u32) -> bool {
        let rest = libm::pow(1.0 - self.step_path, 2.0 * (f64::from(iteration) + 1.0));
        let limit = (1.4 + 2.0 / (self.dimension + 1.0)) * self.expected_length;
        length / (1.0 - rest).sqrt() < limit
    }
}

/// Returns the sum of weights, and its square over the sum of their squares, which is their effective number.
fn sum_and_mass<'a>(weights: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let (sum, squares) = weights.fold((0.0, 0.0), |(sum, squares), w| (sum + w, squares + w * w));
    (sum, sum * sum / squares)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_those_of_pycma() {
        // The numbers are those of pycma 4.5 (recombination_weights.py, with the tutorial's c_1 and c_mu), for n and λ = 10.
        let rates = LearningRates::new(10, 10, CovarianceShape::Full, true);
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
        let large = LearningRates::new(10, 80, CovarianceShape::Full, true);
        assert!((large.weights[79] / -0.013668176089411909 - 1.0).abs() < 1e-14);
        let passive = LearningRates::new(10, 10, CovarianceShape::Full, false);
        assert!((passive.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!(passive.weights.iter().all(|&weight| weight >= 0.0));
    }

    #[test]
    fn rates_of_every_size_keep_the_covariance_positive() {
        for (n, population) in [(1, 2), (1, 1000), (2, 3), (30, 5), (30, 5000), (10_000, 31)] {
            for shape in [CovarianceShape::Full, CovarianceShape::Diagonal] {
                let rates = LearningRates::new(n, population, shape, true);
                let bad = rates.weights.iter().filter(|w| **w < 0.0).fold(0.0, |sum, w| sum - w);
                let left = 1.0 - rates.one - rates.many - rates.many * bad * rates.dimension;
                assert!(left > -1e-12 && rates.many > 0.0, "{n} {population} {shape:?}: {left}");
                assert!(rates.weights.iter().all(|weight| weight.is_finite()));
            }
        }
    }
}
