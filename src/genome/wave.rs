//! Periodic controllers: a wave for each joint axis, all at one frequency.

use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

use crate::check::{Invalid, within};

/// One wave per joint axis, at one shared frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    /// Frequency of the fundamental of all waves, in Hz.
    pub frequency_hz: f32,
    /// The waves of each joint, from the head.
    pub joints: Vec<JointWaves>,
}

/// The two waves of one joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointWaves {
    /// About the bend axis.
    pub bend: Wave,
    /// About the twist axis.
    pub twist: Wave,
}

/// A Fourier series of few terms: `offset + Σ amplitude_k · sin(2π · k · frequency · t + phase_k)`, k = 1, 2, ...
#[derive(Debug, Clone, PartialEq)]
pub struct Wave {
    /// What it swings around, in the unit of its controller: N·m or radians.
    pub offset: f32,
    /// The terms, from the fundamental up.
    pub harmonics: Vec<Harmonic>,
}

/// One term of a wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// In the unit of the controller: N·m or radians.
    pub amplitude: f32,
    /// Phase at the start, in radians.
    pub phase_rad: f32,
}

/// Joint angles to be reached, and the servo that pulls towards them: a torque of
/// `stiffness · (target − angle) − damping · rate`, clamped to what the joint can.
#[derive(Debug, Clone, PartialEq)]
pub struct Gait {
    /// The target angles, in radians.
    pub waves: Waves,
    /// Torque per angle by which a joint misses its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, in N·m·s/rad.
    pub servo_damping_nms_per_rad: f32,
}

/// What periodic controllers may be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveSpace {
    /// Least frequency, in Hz.
    pub frequency_min_hz: f32,
    /// Greatest frequency, in Hz.
    pub frequency_max_hz: f32,
    /// Terms per wave; 1 is a sine.
    pub harmonics: u32,
    /// Greatest amplitude of a target angle, and of its offset to either side, in radians. Torque waves have
    /// the range of the torque signals.
    pub angle_range_rad: f32,
    /// Least stiffness of the servo, in N·m/rad.
    pub stiffness_min_nm_per_rad: f32,
    /// Greatest stiffness of the servo, in N·m/rad.
    pub stiffness_max_nm_per_rad: f32,
    /// Damping of the servo, in N·m·s/rad. It acts through the torque, with a step's delay, and is limited with
    /// it; the joints' own damping is a part of the body.
    pub servo_damping_nms_per_rad: f32,
}

impl Default for WaveSpace {
    fn default() -> Self {
        Self {
            frequency_min_hz: 0.2,
            frequency_max_hz: 3.0,
            harmonics: 1,
            angle_range_rad: 1.0,
            stiffness_min_nm_per_rad: 50.0,
            stiffness_max_nm_per_rad: 1000.0,
            servo_damping_nms_per_rad: 0.0,
        }
    }
}

/// The range of every frequency, in Hz: half the least rate of physics steps is 5 Hz.
pub const FREQUENCY_RANGE_HZ: RangeInclusive<f32> = 0.01..=20.0;
/// The range of every servo's stiffness, in N·m/rad.
pub const STIFFNESS_RANGE_NM_PER_RAD: RangeInclusive<f32> = 0.0..=1.0e5;
/// The range of every servo's damping, in N·m·s/rad.
pub const SERVO_DAMPING_RANGE: RangeInclusive<f32> = 0.0..=1.0e4;
/// The most terms of a wave.
pub const MOST_HARMONICS: u32 = 5;

impl WaveSpace {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("frequency_min_hz", self.frequency_min_hz, FREQUENCY_RANGE_HZ)?;
        let up_to = |least: f32, range: RangeInclusive<f32>| least..=*range.end();
        let frequencies = up_to(self.frequency_min_hz, FREQUENCY_RANGE_HZ);
        within("frequency_max_hz", self.frequency_max_hz, frequencies)?;
        within("harmonics", self.harmonics, 1..=MOST_HARMONICS)?;
        within("angle_range_rad", self.angle_range_rad, 0.0..=super::LARGEST_LIMIT_RAD)?;
        let least = self.stiffness_min_nm_per_rad;
        within("stiffness_min_nm_per_rad", least, STIFFNESS_RANGE_NM_PER_RAD)?;
        let stiffnesses = up_to(least, STIFFNESS_RANGE_NM_PER_RAD);
        within("stiffness_max_nm_per_rad", self.stiffness_max_nm_per_rad, stiffnesses)?;
        within("servo_damping_nms_per_rad", self.servo_damping_nms_per_rad, SERVO_DAMPING_RANGE)
    }
}

impl Gait {
    /// Checks every value.
    ///
    /// # Errors
    /// The first one that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        within("stiffness_nm_per_rad", self.stiffness_nm_per_rad, STIFFNESS_RANGE_NM_PER_RAD)?;
        let damping = self.servo_damping_nms_per_rad;
        within("servo_damping_nms_per_rad", damping, SERVO_DAMPING_RANGE)?;
        self.waves.check(super::LARGEST_LIMIT_RAD)
    }
}

impl Wave {
    /// Its value after `turns` periods of the fundamental. What it is summed up in keeps its precision for
    /// as long as a trial may last.
    pub fn at(&self, turns: f64) -> f32 {
        let terms = self.harmonics.iter().enumerate().map(|(index, harmonic)| {
            let angle = std::f64::consts::TAU * (index + 1) as f64 * turns;
            f64::from(harmonic.amplitude) * libm::sin(angle + f64::from(harmonic.phase_rad))
        });
        (f64::from(self.offset) + terms.sum::<f64>()) as f32
    }

    fn check(&self, most: f32) -> Result<(), Invalid> {
        within("offset", self.offset, -most..=most)?;
        within("harmonics", self.harmonics.len(), 1..=MOST_HARMONICS as usize)?;
        for harmonic in &self.harmonics {
            within("amplitude", harmonic.amplitude, -most..=most)?;
            // One turn is enough; a little more is no harm.
            within("phase_rad", harmonic.phase_rad, -10.0..=10.0)?;
        }
        Ok(())
    }

    /// A wave of nothing, with that many terms.
    pub(super) fn flat(harmonics: u32) -> Self {
        let term = Harmonic { amplitude: 0.0, phase_rad: 0.0 };
        Self { offset: 0.0, harmonics: vec![term; harmonics as usize] }
    }
}

impl Waves {
    /// Checks every value; `most` is the greatest offset and amplitude.
    ///
    /// # Errors
    /// The first one that is not allowed.
    pub fn check(&self, most: f32) -> Result<(), Invalid> {
        within("frequency_hz", self.frequency_hz, FREQUENCY_RANGE_HZ)?;
        for (index, joint) in self.joints.iter().enumerate() {
            for (axis, wave) in [("bend", &joint.bend), ("twist", &joint.twist)] {
                let place = format!("joints[{index}].{axis}");
                wave.check(most).map_err(|error| error.inside(&place))?;
            }
        }
        Ok(())
    }

    /// Waves of nothing, for that many joints.
    pub(super) fn flat(joints: usize, harmonics: u32) -> Self {
        let joint = JointWaves { bend: Wave::flat(harmonics), twist: Wave::flat(harmonics) };
        Self { frequency_hz: 1.0, joints: vec![joint; joints] }
    }

    /// Every wave in a fixed order: joints from the head, bend before twist.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Wave> {
        self.joints.iter_mut().flat_map(|joint| [&mut joint.bend, &mut joint.twist])
    }

    /// The same, to read.
    pub fn all(&self) -> impl Iterator<Item = &Wave> {
        self.joints.iter().flat_map(|joint| [&joint.bend, &joint.twist])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_is_its_offset_and_its_terms() {
        let term = |amplitude, phase_rad| Harmonic { amplitude, phase_rad };
        let quarter = std::f32::consts::FRAC_PI_2;
        let wave = Wave { offset: 0.5, harmonics: vec![term(2.0, 0.0), term(1.0, quarter)] };
        for (turns, expected) in [(0.0, 1.5), (0.25, 1.5), (0.5, 1.5), (0.75, -2.5), (7.25, 1.5)] {
            assert!((wave.at(turns) - expected).abs() < 1e-5, "{} at {turns}", wave.at(turns));
        }
    }

    #[test]
    fn a_range_the_wrong_way_round_is_refused() {
        let space = WaveSpace { frequency_max_hz: 0.1, ..WaveSpace::default() };
        let error = space.check().expect_err("refused").to_string();
        assert_eq!(error, "frequency_max_hz is 0.1; allowed: 0.2 to 20");
    }
}
