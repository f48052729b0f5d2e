//! The ranges of periodic controllers.

use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

use crate::check::{Invalid, within};
use crate::schema::{Section, SettingGroup, Walk, number, whole};

/// Ranges of the genes of periodic controllers.
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
    /// The section of these settings.
    pub const SECTION: Section =
        Section { title: "Waves and gaits", about: "Ranges of periodic motions." };
}

impl SettingGroup for WaveSpace {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self {
            frequency_min_hz,
            frequency_max_hz,
            harmonics,
            angle_range_rad,
            stiffness_min_nm_per_rad,
            stiffness_max_nm_per_rad,
            servo_damping_nms_per_rad,
        } = self;
        walk.section(Self::SECTION);
        walk.setting(
            number("frequency_min_hz", "Minimum frequency", FREQUENCY_RANGE_HZ)
                .unit("Hz")
                .hint("Slowest motion that a snake may have")
                .slider(0.05, 5.0)
                .logarithmic_from(0.05),
            frequency_min_hz,
        );
        walk.setting(
            number("frequency_max_hz", "Maximum frequency", FREQUENCY_RANGE_HZ)
                .unit("Hz")
                .hint("Fastest motion that a snake may have")
                .slider(0.05, 10.0)
                .logarithmic_from(0.05),
            frequency_max_hz,
        );
        walk.setting(
            whole("harmonics", "Harmonics", 1..=MOST_HARMONICS)
                .hint("1 is a plain sine; more allow richer motions but add genes")
                .slider(1.0, 5.0),
            harmonics,
        );
        walk.setting(
            number("angle_range_rad", "Angle range", 0.0..=super::LARGEST_LIMIT_RAD)
                .unit("rad")
                .hint(
                    "Maximum amplitude of a gait's joint angles, and maximum offset to either side",
                )
                .slider(0.0, 3.0),
            angle_range_rad,
        );
        walk.setting(
            number("stiffness_min_nm_per_rad", "Minimum stiffness", STIFFNESS_RANGE_NM_PER_RAD)
                .unit("N·m/rad")
                .hint("Softest servo that a snake may have: it yields to obstacles")
                .slider(0.0, 5000.0)
                .logarithmic_from(1.0),
            stiffness_min_nm_per_rad,
        );
        walk.setting(
            number("stiffness_max_nm_per_rad", "Maximum stiffness", STIFFNESS_RANGE_NM_PER_RAD)
                .unit("N·m/rad")
                .hint("Stiffest servo that a snake may have: it holds its angles")
                .slider(0.0, 5000.0)
                .logarithmic_from(1.0),
            stiffness_max_nm_per_rad,
        );
        walk.setting(
            number("servo_damping_nms_per_rad", "Servo damping", SERVO_DAMPING_RANGE)
                .unit("N·m·s/rad")
                .hint("How much the servo resists fast turns, in addition to the joint damping")
                .slider(0.0, 200.0)
                .logarithmic_from(1.0),
            servo_damping_nms_per_rad,
        );
    }

    fn check_together(&self) -> Result<(), Invalid> {
        let frequencies = self.frequency_min_hz..=*FREQUENCY_RANGE_HZ.end();
        within("frequency_max_hz", self.frequency_max_hz, frequencies)?;
        let stiffnesses = self.stiffness_min_nm_per_rad..=*STIFFNESS_RANGE_NM_PER_RAD.end();
        within("stiffness_max_nm_per_rad", self.stiffness_max_nm_per_rad, stiffnesses)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_the_wrong_way_round_is_refused() {
        let space = WaveSpace { frequency_max_hz: 0.1, ..WaveSpace::default() };
        let error = crate::schema::check(&space).expect_err("refused").to_string();
        assert_eq!(error, "frequency_max_hz is 0.1; allowed: 0.2 to 20");
    }
}
