//! Points drawn at random from ranges, because random streams, logarithms and exponentials decide bits, too.
//!
//! The ranges are those of a search for the settings of the preset `report`.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use xxhash_rust::xxh3::Xxh3Default;

use snakes_core::evolve::Settings;
use snakes_core::rng::{Purpose, stream};

/// Least and greatest value of each coordinate.
const RANGES: [(f32, f32); 9] = [
    (2.0, 12.0),
    (1.0, 60.0),
    (0.3, 10.0),
    (1.0, 2.0),
    (5.0, 500.0),
    (1.0, 1000.0),
    (0.2, 8.0),
    (0.0, 0.8),
    (0.0, 3.0),
];

/// Description of these points in the list of computations.
pub const DRAWN_POINTS: &str = "100 points of the search for settings";

/// Returns a hash over twenty streams. Each has the point of the default settings, then four drawn points.
pub fn hash_of_drawn_points() -> u64 {
    let mut hash = Xxh3Default::new();
    let mut add = |value: f32| hash.update(&value.to_bits().to_le_bytes());
    let start = default_point();
    for seed in 0..20 {
        start.into_iter().for_each(&mut add);
        for number in 1..5 {
            let mut rng = stream(seed, 0, number, Purpose::Calibration);
            RANGES.iter().for_each(|&(least, most)| add(drawn(least, most, &mut rng)));
        }
    }
    hash.digest()
}

fn default_point() -> [f32; 9] {
    let Settings { trial, genome, .. } = Settings::default();
    [
        trial.duration_s,
        genome.points_per_s,
        genome.density_min_kg_m3,
        genome.density_max_kg_m3 / genome.density_min_kg_m3,
        trial.agent.joint_damping_nms_per_rad.at(0),
        trial.agent.angular_damping_per_s,
        trial.surface.friction,
        trial.surface.bounce,
        trial.surface.dampen_per_s,
    ]
}

/// Draws a value evenly on a logarithmic scale. If the range begins at 0, draws either 0 or evenly.
fn drawn(least: f32, most: f32, rng: &mut ChaCha8Rng) -> f32 {
    let value = if least > 0.0 {
        libm::expf(rng.random_range(libm::logf(least)..=libm::logf(most)))
    } else if rng.random_range(0..2) == 0 {
        return 0.0;
    } else {
        rng.random_range(least..=most)
    };
    let unit = if value >= 100.0 {
        1.0
    } else if value >= 10.0 {
        10.0
    } else {
        100.0
    };
    (libm::roundf(value * unit) / unit).clamp(least, most)
}
