//! Limits of bodies in every space of genomes.

/// Half a turn is where a joint angle wraps around; a limit stays clear of it.
pub const LARGEST_LIMIT_RAD: f32 = 3.0;
/// The range of every size of a block or a part in a file, in metres: that of the sizes in settings.
pub const SIZE_RANGE_M: std::ops::RangeInclusive<f32> = 0.1..=10.0;
/// The range of every density, in kg/m³: from a balloon to tungsten.
pub const DENSITY_RANGE_KG_M3: std::ops::RangeInclusive<f32> = 0.1..=20_000.0;
/// The range of every Young's modulus, in Pa: from a soap bubble to rubber.
pub const MODULUS_RANGE_PA: std::ops::RangeInclusive<f32> = 1.0..=1.0e7;
