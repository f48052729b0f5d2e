//! How much neighbouring blocks may differ, so that the engine holds the joint between them together.

use std::fmt::Display;

use crate::check::Invalid;

/// Largest ratio of the masses of neighbouring blocks. Measured on a swinging chain with one inner iteration: at 10 the
/// joint drifts 0.06 m, at 30 it breaks.
pub const MASS_RATIO: f64 = 8.0;
/// Largest ratio of their largest moments of inertia in a file: that of two blocks of the same shape, one of twice the
/// sides.
pub const INERTIA_RATIO: f64 = 32.0;
/// Largest ratio of the largest moments of inertia of neighbours in bodies that evolution makes.
pub const EVOLVED_INERTIA_RATIO: f64 = 10.0;

/// Largest principal moment of inertia of a box, in kg·m².
pub fn inertia_kg_m2(mass_kg: f64, sizes_m: [f32; 3]) -> f64 {
    let squares = sizes_m.map(|size| f64::from(size) * f64::from(size));
    let least = squares.into_iter().fold(f64::INFINITY, f64::min);
    mass_kg / 12.0 * (squares.iter().sum::<f64>() - least)
}

/// The larger of two numbers over the smaller.
pub fn ratio(a: f64, b: f64) -> f64 {
    a.max(b) / a.min(b)
}

/// Checks that two joined blocks or parts differ little enough, given their masses in kg and their largest moments of inertia
/// in kg·m²; `pair` names them.
///
/// # Errors
/// The ratio that is too large.
pub fn check_pair(
    pair: impl Display,
    [masses, inertias]: [[f64; 2]; 2],
    largest_inertia: f64,
) -> Result<(), Invalid> {
    for (what, [front, rear], most) in
        [("masses", masses, MASS_RATIO), ("moments of inertia", inertias, largest_inertia)]
    {
        let found = ratio(front, rear);
        // Sizes are rounded to 32 bits.
        if found > most * 1.000_01 {
            let value = format!("in the ratio {found:.1}");
            let allowed = format!("a ratio of 1 to {most}");
            return Err(Invalid::new(format!("{what} of {pair}"), value, allowed));
        }
    }
    Ok(())
}
