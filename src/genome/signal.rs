//! Torque signals: how they are born and how they vary, as the report has it.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{LARGEST_GENOME_TORQUES, LARGEST_TORQUE_NM, POINTS_PER_S_RANGE};
use crate::check::{Invalid, within};

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

    /// The same, to read.
    pub fn all(&self) -> impl Iterator<Item = &Vec<f32>> {
        self.joints.iter().flat_map(|joint| [&joint.bend_nm, &joint.twist_nm])
    }

    /// Checks every value.
    ///
    /// # Errors
    /// The first one that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        within("points_per_s", self.points_per_s, POINTS_PER_S_RANGE)?;
        let points = |joint: &JointSignals| joint.bend_nm.len() + joint.twist_nm.len();
        let torques: usize = self.joints.iter().map(points).sum();
        within("torque points", torques, 1..=LARGEST_GENOME_TORQUES)?;
        for (index, joint) in self.joints.iter().enumerate() {
            for (axis, signal) in [("bend_nm", &joint.bend_nm), ("twist_nm", &joint.twist_nm)] {
                let field = format!("joints[{index}].{axis}");
                if signal.is_empty() {
                    return Err(Invalid::new(field, "empty", "at least one point"));
                }
                let range = -LARGEST_TORQUE_NM..=LARGEST_TORQUE_NM;
                signal.iter().try_for_each(|&torque| within(&field, torque, range.clone()))?;
            }
        }
        Ok(())
    }

    /// How often per second a torque changes its sign, on average over all signals.
    pub(super) fn sign_changes_per_s(&self) -> f32 {
        let changes = |signal: &Vec<f32>| {
            signal.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count()
        };
        let points: usize = self.all().map(Vec::len).sum();
        let changes: usize = self.all().map(changes).sum();
        self.points_per_s * changes as f32 / points.max(1) as f32
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
