//! Torque signals: how they are drawn and how they vary, as in the report.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, JointCommands, LengthVisitor, SettingNames};
use crate::genome::body::BodyGenes;
use crate::genome::gene::{Feature, GeneRange, Genes, GenomeShape, Quantity, shifted};
use crate::genome::space::{GenomeSpace, LARGEST_GENOME_TORQUES, POINTS_PER_S, TORQUE};

/// One torque signal per joint axis. Each point's torque holds until the next point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorqueSignals {
    /// Number of points that take effect per simulated second.
    pub points_per_s: f32,
    /// The signals of each joint, from the head; all signals have the same number of points.
    pub joints: Vec<JointSignals>,
}

/// The two signals of one joint, in N·m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSignals {
    /// Torque about the bend axis, point by point.
    pub bend_nm: Vec<f32>,
    /// Torque about the twist axis, point by point.
    pub twist_nm: Vec<f32>,
}

impl JointSignals {
    /// Returns the signals with the names of their fields and of their axes.
    fn axes(&self) -> [(&'static str, &'static str, &Vec<f32>); 2] {
        [("bend_nm", "bend", &self.bend_nm), ("twist_nm", "twist", &self.twist_nm)]
    }
}

impl TorqueSignals {
    /// Returns every signal of the snake in a fixed order, for changes: joints from the head, bend before twist.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.joints.iter_mut().flat_map(|joint| [&mut joint.bend_nm, &mut joint.twist_nm])
    }

    /// Returns every signal of the snake in a fixed order, for reading: joints from the head, bend before twist.
    pub fn all(&self) -> impl Iterator<Item = &Vec<f32>> {
        self.joints.iter().flat_map(|joint| [&joint.bend_nm, &joint.twist_nm])
    }
}

impl ControllerEncoding for TorqueSignals {
    fn settings() -> SettingNames {
        &[&["torque_range_nm", "torque_step_nm", "points_per_s"]]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let signal = vec![0.0; space.points(shape.duration_s)];
        let joint = JointSignals { bend_nm: signal.clone(), twist_nm: signal };
        Self { points_per_s: space.points_per_s, joints: vec![joint; shape.joints] }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let range = GeneRange::Fixed(space.points_per_s);
        let name = "points per second";
        genes.gene("points_per_s", name, POINTS_PER_S, range, &mut self.points_per_s);
        let range = GeneRange::around_zero(space.torque_range_nm);
        for (joint, signals) in self.joints.iter_mut().enumerate() {
            point_genes(joint, ["bend", "bend_nm"], TORQUE, range, &mut signals.bend_nm, genes);
            point_genes(joint, ["twist", "twist_nm"], TORQUE, range, &mut signals.twist_nm, genes);
        }
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        signal_lengths(self.joints.iter().map(JointSignals::axes), "torque points", visit);
    }

    fn joints(&self) -> usize {
        self.joints.len()
    }

    fn estimated_frequency_hz(&self) -> Option<f32> {
        Some(sign_changes_hz(self.points_per_s, self.all()))
    }

    fn widen(&self, space: &mut GenomeSpace) {
        space.points_per_s = self.points_per_s;
        let torques = self.all().flatten().map(|torque_nm| torque_nm.abs());
        space.torque_range_nm = torques.fold(space.torque_range_nm, f32::max);
    }

    fn randomize(&mut self, body: &mut BodyGenes, space: &GenomeSpace, rng: &mut ChaCha8Rng) {
        // `check` refuses empty lists. If a list is empty nevertheless, the joint cannot move.
        let choose =
            |limits: &[f32], rng: &mut ChaCha8Rng| limits.choose(rng).copied().unwrap_or(0.0);
        body.bend_limit_rad = choose(&space.bend_limits_rad, rng);
        body.twist_limit_rad = choose(&space.twist_limits_rad, rng);
        body.density_kg_m3 = rng.random_range(space.density_min_kg_m3..=space.density_max_kg_m3);
        for signal in self.all_mut() {
            random_walk(signal, space.torque_range_nm, space.torque_step_nm, rng);
        }
    }

    /// Shifts every point of every signal, and the density by the same share of its range. The joint limits, which are chosen once per
    /// snake, are inherited.
    fn mutate(
        &mut self,
        body: &mut BodyGenes,
        space: &GenomeSpace,
        shift_nm: f32,
        rng: &mut ChaCha8Rng,
    ) {
        for torque_nm in self.all_mut().flatten() {
            *torque_nm = shifted(*torque_nm, shift_nm, space.torque_range_nm, rng);
        }
        let (least, most) = (space.density_min_kg_m3, space.density_max_kg_m3);
        let shift_kg_m3 = space.shift_share(shift_nm) * (most - least);
        body.density_kg_m3 =
            (body.density_kg_m3 + rng.random_range(-shift_kg_m3..=shift_kg_m3)).clamp(least, most);
    }

    fn summary(&self, space: &GenomeSpace) -> Option<Vec<Feature>> {
        let rhythm_hz = self.estimated_frequency_hz().unwrap_or(0.0);
        let mut features = vec![rhythm(rhythm_hz, self.points_per_s)];
        for (joint, signals) in (1..).zip(&self.joints) {
            for (_, axis, torques) in signals.axes() {
                features.push(strength(joint, axis, "N·m", torques, space.torque_range_nm));
            }
        }
        Some(features)
    }

    fn commands(&self, _duration_s: f64) -> Option<JointCommands> {
        let points = |torques: &[f32]| held_points(torques, self.points_per_s);
        let joint = |joint: &JointSignals| [points(&joint.bend_nm), points(&joint.twist_nm)];
        let joints = self.joints.iter().map(joint).collect();
        let quantity = "torque in N·m";
        Some(JointCommands { quantity, least_range: 1000.0, is_held: true, joints })
    }
}

/// Returns the number of the point of a signal that holds in physics step number `step`; the first of both is 0.
pub fn point_at(step: u32, points_per_s: f32, steps_per_s: u32) -> usize {
    let points_per_step = f64::from(points_per_s) / f64::from(steps_per_s);
    (f64::from(step) * points_per_step) as usize
}

/// Returns the value of a signal that holds at a point: the last one after the end, 0 for a signal without points.
pub fn held_value(signal: &[f32], point: usize) -> f32 {
    signal.get(point).or(signal.last()).copied().unwrap_or(0.0)
}

/// Visits the points of a signal of a joint as genes. `axis` and `field` name the signal in words and in files.
pub(super) fn point_genes(
    joint: usize,
    [axis, field]: [&str; 2],
    quantity: Quantity,
    range: GeneRange<'_>,
    signal: &mut [f32],
    genes: &mut Genes<'_>,
) {
    for (point, value) in signal.iter_mut().enumerate() {
        let field = format_args!("joints[{joint}].{field}[{point}]");
        let name = format_args!("joint {} {axis}, point {}", joint + 1, point + 1);
        genes.gene(field, name, quantity, range, value);
    }
}

/// Visits the length of each signal by its field, and the sum of all lengths by the name `all`.
pub(super) fn signal_lengths<'a>(
    joints: impl Iterator<Item = [(&'static str, &'static str, &'a Vec<f32>); 2]>,
    all: &str,
    visit: LengthVisitor<'_>,
) {
    let mut sum = 0;
    for (index, signals) in joints.enumerate() {
        for (field, _, signal) in signals {
            sum += signal.len();
            let name = format_args!("points of joints[{index}].{field}");
            visit(name, signal.len(), 1..=LARGEST_GENOME_TORQUES);
        }
    }
    visit(format_args!("{all}"), sum, 1..=LARGEST_GENOME_TORQUES);
}

/// Returns half the number of sign changes per second, which is the frequency of a sine.
pub(super) fn sign_changes_hz<'a>(
    points_per_s: f32,
    signals: impl Iterator<Item = &'a Vec<f32>>,
) -> f32 {
    let (mut points, mut changes) = (0, 0);
    for signal in signals {
        points += signal.len();
        changes += signal.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count();
    }
    points_per_s * changes as f32 / points.max(1) as f32 / 2.0
}

/// Returns times in seconds and values of a signal whose points hold until the next.
pub(super) fn held_points(signal: &[f32], points_per_s: f32) -> Vec<(f64, f64)> {
    let at_s = |index: usize| index as f64 / f64::from(points_per_s);
    let points = signal.iter().enumerate();
    points.map(|(index, &value)| (at_s(index), f64::from(value))).collect()
}

/// Makes the feature of the frequency of signals. Signals that change their sign with every point have the highest.
pub(super) fn rhythm(rhythm_hz: f32, points_per_s: f32) -> Feature {
    size_feature("rhythm".to_owned(), "Hz", rhythm_hz, points_per_s / 2.0)
}

/// Makes the feature of the mean size of the points of a signal, which are at most `most`.
pub(super) fn strength(
    joint: usize,
    axis: &str,
    unit: &'static str,
    signal: &[f32],
    most: f32,
) -> Feature {
    let sum: f32 = signal.iter().map(|value| value.abs()).sum();
    let mean = sum / signal.len().max(1) as f32;
    size_feature(format!("joint {joint} {axis}, strength"), unit, mean, most)
}

fn size_feature(name: String, unit: &'static str, value: f32, most: f32) -> Feature {
    Feature::new(name, unit, value, GeneRange::Between(0.0, most.max(f32::MIN_POSITIVE)))
}

/// Fills a signal by the random walk of the report: the first point lies anywhere in ±`range_nm`, each next one within ±`step_nm` of the
/// one before, clamped to the range.
fn random_walk(signal: &mut [f32], range_nm: f32, step_nm: f32, rng: &mut ChaCha8Rng) {
    let mut torque_nm = rng.random_range(-range_nm..=range_nm);
    for (index, point) in signal.iter_mut().enumerate() {
        if index > 0 {
            torque_nm = shifted(torque_nm, step_nm, range_nm, rng);
        }
        *point = torque_nm;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    #[test]
    fn a_walk_stays_in_its_range_and_within_its_step() {
        let mut walk = [0.0; 2000];
        random_walk(&mut walk, 1000.0, 300.0, &mut stream(1, 0, 0, Purpose::Birth));
        assert!(walk.iter().all(|torque| torque.abs() <= 1000.0));
        assert!(walk.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 300.0));
        assert!(walk.iter().any(|torque| *torque > 500.0), "the walk explores the range");
        assert!(walk.iter().any(|torque| *torque < -500.0), "on both sides");
    }

    #[test]
    fn first_points_are_spread_evenly_over_the_range() {
        let firsts: Vec<f32> = (0..4000)
            .map(|i| {
                let mut walk = [0.0];
                random_walk(&mut walk, 1000.0, 1000.0, &mut stream(7, 0, i, Purpose::Birth));
                walk[0]
            })
            .collect();
        for quarter in 0..4 {
            let low = -1000.0 + 500.0 * quarter as f32;
            let count = firsts.iter().filter(|&&x| x >= low && x < low + 500.0).count();
            assert!((850..1150).contains(&count), "quarter {quarter} has {count} of 4000");
        }
    }
}
