//! A candidate with its value, and checks of numbers.

use crate::check::Invalid;

/// A candidate and its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RankedCandidate<'a> {
    /// The candidate as it was drawn.
    pub point: &'a [f64],
    /// Larger is better; NaN is the worst value. The search uses only ranks. Values only decide when a run
    /// terminates.
    pub value: f64,
}

/// A finite value, which can be compared: NaN becomes the worst.
pub fn finite(value: f64) -> f64 {
    if value.is_nan() { f64::MIN } else { value.clamp(f64::MIN, f64::MAX) }
}

/// Checks that there are `length` numbers and that all are finite.
pub fn check_floats(field: &str, floats: &[f64], length: usize) -> Result<(), Invalid> {
    if floats.len() != length {
        return Err(Invalid::new(field, format!("{} numbers", floats.len()), length.to_string()));
    }
    match floats.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Invalid::new(field, x, "finite numbers")),
        None => Ok(()),
    }
}
