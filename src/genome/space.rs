//! The space genomes are drawn from, and the two ways through it: birth and mutation.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::fmt;

use super::signal::{JointSignals, Signals, random_walk, shifted};
use super::{Controller, Descent, Genome, WaveSpace};
use crate::check::{Invalid, within};

/// The kinds of controllers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ControllerKind {
    /// Free torque signals, the report's.
    #[default]
    Signal,
    /// Periodic torques.
    Wave,
    /// Periodic joint angles, followed by a servo.
    Gait,
}

impl ControllerKind {
    /// All of them, the report's first.
    pub const ALL: [Self; 3] = [Self::Signal, Self::Wave, Self::Gait];

    /// The name in flags and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Signal => "signal",
            Self::Wave => "wave",
            Self::Gait => "gait",
        }
    }

    /// What it is, in a few words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Signal => "free torque signals, point after point, as in the report",
            Self::Wave => "periodic torques: a wave per joint axis, one frequency",
            Self::Gait => "periodic joint angles, followed by a servo that feels the joint",
        }
    }
}

impl fmt::Display for ControllerKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// What a genome may be: ranges, lists, the density of points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenomeSpace {
    /// What drives the joints.
    pub controller: ControllerKind,
    /// What periodic controllers may be.
    pub wave: WaveSpace,
    /// A torque, of a signal or a wave, stays within plus and minus this, in N·m. The report has 1000.
    pub torque_range_nm: f32,
    /// A newborn signal's points differ from their predecessors by at most this, in N·m. The report
    /// has 1000.
    pub torque_step_nm: f32,
    /// Torque points that take effect per simulated second. The report found that it matters.
    pub points_per_s: f32,
    /// The bend limits a newborn chooses from, in radians. The report has 0.6, 0.8, 1.0, 1.8.
    pub bend_limits_rad: Vec<f32>,
    /// The twist limits a newborn chooses from, in radians. The report has 0, 0.9, 1.2, 1.5.
    pub twist_limits_rad: Vec<f32>,
    /// Least density of the material, in kg/m³.
    pub density_min_kg_m3: f32,
    /// Greatest density of the material, in kg/m³.
    pub density_max_kg_m3: f32,
}

impl Default for GenomeSpace {
    fn default() -> Self {
        Self {
            controller: ControllerKind::Signal,
            wave: WaveSpace::default(),
            torque_range_nm: 1000.0,
            torque_step_nm: 1000.0,
            points_per_s: 10.0,
            bend_limits_rad: vec![0.6, 0.8, 1.0, 1.8],
            twist_limits_rad: vec![0.0, 0.9, 1.2, 1.5],
            density_min_kg_m3: 2.0,
            density_max_kg_m3: 2.5,
        }
    }
}

/// Half a turn is where a joint angle wraps around; a limit stays clear of it.
pub const LARGEST_LIMIT_RAD: f32 = 3.0;
/// The range of every density, in kg/m³: from a balloon to tungsten.
pub const DENSITY_RANGE_KG_M3: std::ops::RangeInclusive<f32> = 0.1..=20_000.0;
/// The range of torque points per second. Beyond the physics' own rate more points do nothing.
pub const POINTS_PER_S_RANGE: std::ops::RangeInclusive<f32> = 0.1..=1000.0;

/// The largest torque in a file, in N·m: a thousand times the report's.
pub const LARGEST_TORQUE_NM: f32 = 1.0e6;

/// The most torque points in a genome, over all its signals: such a genome still makes a save of less
/// than the 10 MiB that are read again.
pub const LARGEST_GENOME_TORQUES: usize = 600_000;

impl GenomeSpace {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        self.wave.check().map_err(|error| error.inside("wave"))?;
        within("torque_range_nm", self.torque_range_nm, 0.001..=1.0e6)?;
        within("torque_step_nm", self.torque_step_nm, 0.0..=1.0e6)?;
        within("points_per_s", self.points_per_s, POINTS_PER_S_RANGE)?;
        for (field, limits) in [
            ("bend_limits_rad", &self.bend_limits_rad),
            ("twist_limits_rad", &self.twist_limits_rad),
        ] {
            if limits.is_empty() || limits.len() > 100 {
                return Err(Invalid::new(
                    field,
                    format!("{} values", limits.len()),
                    "1 to 100 values",
                ));
            }
            limits.iter().try_for_each(|&limit| within(field, limit, 0.0..=LARGEST_LIMIT_RAD))?;
        }
        within("density_min_kg_m3", self.density_min_kg_m3, DENSITY_RANGE_KG_M3)?;
        within(
            "density_max_kg_m3",
            self.density_max_kg_m3,
            self.density_min_kg_m3..=*DENSITY_RANGE_KG_M3.end(),
        )
    }

    /// How many points a signal needs to last `duration_s`.
    pub fn points(&self, duration_s: f32) -> usize {
        libm::ceilf(duration_s * self.points_per_s).max(1.0) as usize
    }

    /// Draws a genome from nothing: signals by the report's random walk, waves anywhere in their ranges.
    pub fn birth(&self, descent: Descent, rng: &mut ChaCha8Rng) -> Genome {
        if self.controller != ControllerKind::Signal {
            return self.drawn(descent, rng);
        }
        let points = self.points(descent.duration_s);
        // `check` refuses empty lists; a list that is empty all the same means a joint held fast.
        let choose =
            |limits: &[f32], rng: &mut ChaCha8Rng| limits.choose(rng).copied().unwrap_or(0.0);
        let bend_limit_rad = choose(&self.bend_limits_rad, rng);
        let twist_limit_rad = choose(&self.twist_limits_rad, rng);
        let density_kg_m3 = rng.random_range(self.density_min_kg_m3..=self.density_max_kg_m3);
        let mut walk = || random_walk(points, self.torque_range_nm, self.torque_step_nm, rng);
        let joint = |_| JointSignals { bend_nm: walk(), twist_nm: walk() };
        let joints = (0..descent.joints).map(joint).collect();
        let signals = Signals { points_per_s: self.points_per_s, joints };
        let controller = Controller::Signal(signals);
        Genome { bend_limit_rad, twist_limit_rad, density_kg_m3, controller }
    }

    /// A child: the parent with every point of every signal shifted at random within ±`shift_nm`.
    ///
    /// The other genes are shifted too, by the same share of their own ranges; the joint limits, chosen once
    /// per agent, are inherited.
    pub fn mutated(&self, parent: &Genome, shift_nm: f32, rng: &mut ChaCha8Rng) -> Genome {
        let mut child = parent.clone();
        let share = (shift_nm / self.torque_range_nm).min(1.0);
        let Controller::Signal(signals) = &mut child.controller else {
            self.shift_all(&mut child, share, rng);
            return child;
        };
        for torque_nm in signals.all_mut().flatten() {
            *torque_nm = shifted(*torque_nm, shift_nm, self.torque_range_nm, rng);
        }
        let shift_kg_m3 = share * (self.density_max_kg_m3 - self.density_min_kg_m3);
        child.density_kg_m3 = (child.density_kg_m3 + rng.random_range(-shift_kg_m3..=shift_kg_m3))
            .clamp(self.density_min_kg_m3, self.density_max_kg_m3);
        child
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    const DESCENT: Descent = Descent { joints: 4, duration_s: 5.0 };

    fn signals(genome: &mut Genome) -> &mut Signals {
        match &mut genome.controller {
            Controller::Signal(signals) => signals,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_newborn_has_what_the_report_says() {
        let space = GenomeSpace::default();
        let mut bends = Vec::new();
        for individual in 0..200 {
            let mut genome = space.birth(DESCENT, &mut stream(1, 1, individual, Purpose::Birth));
            assert_eq!(signals(&mut genome).joints.len(), 4);
            assert!(signals(&mut genome).joints.iter().all(|joint| joint.bend_nm.len() == 50));
            assert!(space.twist_limits_rad.contains(&genome.twist_limit_rad));
            assert!((2.0..=2.5).contains(&genome.density_kg_m3));
            bends.push(genome.bend_limit_rad);
        }
        for limit in &space.bend_limits_rad {
            assert!(bends.contains(limit), "{limit} rad was never chosen in 200 births");
        }
    }

    #[test]
    fn a_child_differs_from_its_parent_everywhere_but_by_no_more_than_the_range() {
        let space = GenomeSpace::default();
        let mut parent = space.birth(DESCENT, &mut stream(1, 1, 0, Purpose::Birth));
        let mut child = space.mutated(&parent, 25.0, &mut stream(1, 2, 0, Purpose::Mutation));
        assert_eq!(child.bend_limit_rad, parent.bend_limit_rad);
        let pairs =
            signals(&mut child).all_mut().flatten().zip(signals(&mut parent).all_mut().flatten());
        let pairs: Vec<(f32, f32)> = pairs.map(|(child, parent)| (*child, *parent)).collect();
        assert_eq!(pairs.len(), 400);
        for (child, parent) in pairs {
            assert!((child - parent).abs() <= 25.001, "{parent} became {child}");
            assert!(child.abs() <= 1000.0);
            assert!(child != parent || parent.abs() == 1000.0, "{parent} did not change");
        }
    }
}
