//! Candidates of CMA-ES with their values, and checks of numbers.

use crate::check::Invalid;

/// A candidate of CMA-ES with its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RankedCandidate<'a> {
    /// Point of the candidate, as it was drawn.
    pub point: &'a [f64],
    /// Value of the candidate. Larger is better; NaN is the worst. The search uses only the ranks of values; the criteria of termination
    /// compare the values themselves.
    pub value: f64,
}

/// Returns a finite value for comparisons: NaN becomes the least value.
pub fn finite(value: f64) -> f64 {
    if value.is_nan() { f64::MIN } else { value.clamp(f64::MIN, f64::MAX) }
}

/// Checks that there are `length` numbers, and that all of them are finite.
pub fn check_floats(field: &str, floats: &[f64], length: usize) -> Result<(), Invalid> {
    if floats.len() != length {
        return Err(Invalid::new(field, format!("{} numbers", floats.len()), length.to_string()));
    }
    match floats.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Invalid::new(field, x, "finite numbers")),
        None => Ok(()),
    }
}
