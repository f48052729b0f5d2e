//! Torque signals: how they are born and how they vary, as the report has it.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// One torque signal per joint axis. Each holds its value until the next point.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// How many points take effect per simulated second.
    pub points_per_s: f32,
    /// The signals of each joint, from the head; all signals have the same number of points.
    pub joints: Vec<JointSignals>,
}

/// The two signals of one joint, in N·m.
#[derive(Debug, Clone, PartialEq)]
pub struct JointSignals {
    /// Torque about the bend axis, point by point.
    pub bend_nm: Vec<f32>,
    /// Torque about the twist axis, point by point.
    pub twist_nm: Vec<f32>,
}

impl Signals {
    /// Every signal of the snake in a fixed order: joints from the head, bend before twist.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.joints.iter_mut().flat_map(|joint| [&mut joint.bend_nm, &mut joint.twist_nm])
    }
}

/// Draws a signal by the report's random walk: the first point anywhere in ±`range_nm`, each next
/// one within ±`step_nm` of the one before, clamped to the range.
pub fn random_walk(points: usize, range_nm: f32, step_nm: f32, rng: &mut ChaCha8Rng) -> Vec<f32> {
    let mut torque_nm = rng.random_range(-range_nm..=range_nm);
    (0..points)
        .map(|index| {
            if index > 0 {
                torque_nm = shifted(torque_nm, step_nm, range_nm, rng);
            }
            torque_nm
        })
        .collect()
}

/// Shifts a value at random within ±`by` and clamps it to ±`range`.
pub fn shifted(value: f32, by: f32, range: f32, rng: &mut ChaCha8Rng) -> f32 {
    (value + rng.random_range(-by..=by)).clamp(-range, range)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    #[test]
    fn a_walk_stays_in_its_range_and_within_its_step() {
        let walk = random_walk(2000, 1000.0, 300.0, &mut stream(1, 0, 0, Purpose::Birth));
        assert_eq!(walk.len(), 2000);
        assert!(walk.iter().all(|torque| torque.abs() <= 1000.0));
        assert!(walk.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 300.0));
        assert!(walk.iter().any(|torque| *torque > 500.0), "the walk explores the range");
        assert!(walk.iter().any(|torque| *torque < -500.0), "on both sides");
    }

    #[test]
    fn first_points_are_spread_evenly_over_the_range() {
        let firsts: Vec<f32> = (0..4000)
            .map(|i| random_walk(1, 1000.0, 1000.0, &mut stream(7, 0, i, Purpose::Birth))[0])
            .collect();
        for quarter in 0..4 {
            let low = -1000.0 + 500.0 * quarter as f32;
            let count = firsts.iter().filter(|&&x| x >= low && x < low + 500.0).count();
            assert!((850..1150).contains(&count), "quarter {quarter} has {count} of 4000");
        }
    }
}
