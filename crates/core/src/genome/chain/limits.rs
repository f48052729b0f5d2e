//! How much neighbouring blocks may differ, so that the engine holds the joint between them together.

use std::fmt::Display;

use crate::check::Invalid;

/// Largest ratio of the masses of neighbouring blocks. It was measured on a swinging chain with one inner iteration: at a ratio of 10 the
/// joint drifts 0.06 m, at 30 it breaks.
pub const MASS_RATIO: f64 = 8.0;
/// Largest ratio of the largest moments of inertia of neighbouring blocks in a file: that of two blocks of the same shape, of which one
/// has twice the sides.
pub const INERTIA_RATIO: f64 = 32.0;
/// Largest ratio of the largest moments of inertia of neighbouring blocks in bodies that evolution makes.
pub const EVOLVED_INERTIA_RATIO: f64 = 10.0;

/// Returns the largest principal moment of inertia of a box, in kg·m², given its mass in kg and its sides in m.
pub fn inertia_kg_m2(mass_kg: f64, sizes_m: [f32; 3]) -> f64 {
    let squares = sizes_m.map(|size| f64::from(size) * f64::from(size));
    let least = squares.into_iter().fold(f64::INFINITY, f64::min);
    mass_kg / 12.0 * (squares.iter().sum::<f64>() - least)
}

/// Divides the larger of two numbers by the smaller.
pub fn ratio(a: f64, b: f64) -> f64 {
    a.max(b) / a.min(b)
}

/// Checks that two joined blocks or parts differ little enough, given their masses in kg and their largest moments of inertia in kg·m².
/// `pair` names them in the error.
///
/// Returns the ratio that is too large.
pub fn check_pair(
    pair: impl Display,
    [masses, inertias]: [[f64; 2]; 2],
    largest_inertia: f64,
) -> Result<(), Invalid> {
    for (what, [front, rear], most) in
        [("masses", masses, MASS_RATIO), ("moments of inertia", inertias, largest_inertia)]
    {
        let found = ratio(front, rear);
        // The tolerance is for sizes that are rounded to 32 bits.
        if found > most * 1.000_01 {
            let value = format!("in the ratio {found:.1}");
            let allowed = format!("a ratio of 1 to {most}");
            return Err(Invalid::new(format!("{what} of {pair}"), value, allowed));
        }
    }
    Ok(())
}
