//! The ranges of the genes of periodic controllers.

use std::ops::RangeInclusive;

use super::gene::{GeneRange, Genes, Quantity};
use crate::check::{Invalid, within};
use crate::schema::{is_default, number, setting_group, whole};

setting_group! {
    /// Ranges of the genes of periodic controllers.
    pub struct WaveSpace in "Waves and gaits": "Ranges of periodic motions." {
        /// Least frequency of waves and beats, in Hz.
        frequency_min_hz: f32 = 0.2,
            number("Minimum frequency", FREQUENCY_RANGE_HZ)
                .unit("Hz")
                .hint("Slowest motion that a snake may have")
                .slider(0.05, 5.0)
                .logarithmic_from(0.05);

        /// Greatest frequency of waves and beats, in Hz.
        frequency_max_hz: f32 = 3.0,
            number("Maximum frequency", FREQUENCY_RANGE_HZ)
                .unit("Hz")
                .hint("Fastest motion that a snake may have")
                .slider(0.05, 10.0)
                .logarithmic_from(0.05);

        /// Number of terms per wave; 1 makes a sine.
        harmonics: u32 = 1,
            whole("Harmonics", 1..=MOST_HARMONICS).advanced()
                .hint("1 is a plain sine; more allow richer motions but add genes")
                .slider(1.0, 5.0);

        /// Greatest amplitude of a target angle of a bend, and of the angle's offset to either side, in radians. Torque waves have the
        /// range of the torque signals instead.
        angle_range_rad: f32 = 1.0,
            number("Bend range", 0.0..=super::LARGEST_LIMIT_RAD)
                .unit("rad")
                .hint("Maximum amplitude of a gait's bends, and maximum offset in either direction")
                .slider(0.0, 3.0);

        /// Greatest amplitude of a target angle of a twist, and of the angle's offset to either side, in radians. With 0, the servo holds
        /// a joint that may twist straight, and the joint yields under load.
        #[serde(default = "one_rad")]
        twist_range_rad: f32 = 1.0,
            number("Twist range", 0.0..=super::LARGEST_LIMIT_RAD)
                .unit("rad")
                .hint(
                    "Maximum amplitude of a gait's twists, and maximum offset in either direction. With 0, a joint that \
                     may twist is held straight and yields under load",
                )
                .slider(0.0, 3.0);

        /// Greatest angle by which a sense of balance moves the twist targets of a gait, in radians per sense. With 0, a gait does not steer.
        #[serde(default, skip_serializing_if = "is_default")]
        steering_range_rad: f32 = 0.0,
            number("Steering range", 0.0..=super::LARGEST_LIMIT_RAD)
                .unit("rad")
                .hint(
                    "How far a gait may twist its joints when the snake heads aside, is beside the middle of the stairs or rolls. \
                     With 0, it does not steer",
                )
                .slider(0.0, 3.0);

        /// Least stiffness of the servo, in N·m/rad.
        stiffness_min_nm_per_rad: f32 = 50.0,
            number("Minimum stiffness", STIFFNESS_RANGE_NM_PER_RAD).advanced()
                .unit("N·m/rad")
                .hint("Softest servo that a snake may have: it yields to obstacles")
                .slider(0.0, 5000.0)
                .logarithmic_from(1.0);

        /// Greatest stiffness of the servo, in N·m/rad.
        stiffness_max_nm_per_rad: f32 = 1000.0,
            number("Maximum stiffness", STIFFNESS_RANGE_NM_PER_RAD).advanced()
                .unit("N·m/rad")
                .hint("Stiffest servo that a snake may have: it holds its angles")
                .slider(0.0, 5000.0)
                .logarithmic_from(1.0);

        /// Damping of the servo, in N·m·s/rad. It is a part of the servo's torque, constant over a step and limited together with it. The
        /// joints' own damping is a part of the body instead.
        servo_damping_nms_per_rad: f32 = 0.0,
            number("Servo damping", SERVO_DAMPING_RANGE).advanced()
                .unit("N·m·s/rad")
                .hint("How much the servo resists fast turns, in addition to the joint damping")
                .slider(0.0, 200.0)
                .logarithmic_from(1.0);
    }

    fn check_together(&self) -> Result<(), Invalid> {
        let frequencies = self.frequency_min_hz..=*FREQUENCY_RANGE_HZ.end();
        within("frequency_max_hz", self.frequency_max_hz, frequencies)?;
        let stiffnesses = self.stiffness_min_nm_per_rad..=*STIFFNESS_RANGE_NM_PER_RAD.end();
        within("stiffness_max_nm_per_rad", self.stiffness_max_nm_per_rad, stiffnesses)
    }
}

impl WaveSpace {
    /// Visits the gene of a frequency.
    pub(super) fn frequency_gene(&self, frequency_hz: &mut f32, genes: &mut Genes<'_>) {
        let range = GeneRange::Between(self.frequency_min_hz, self.frequency_max_hz);
        genes.gene("frequency_hz", "frequency", FREQUENCY, range, frequency_hz);
    }

    /// Visits the genes of a servo's stiffness and damping.
    pub(super) fn servo_genes(
        &self,
        [stiffness_nm_per_rad, damping_nms_per_rad]: [&mut f32; 2],
        genes: &mut Genes<'_>,
    ) {
        let range = self.stiffnesses();
        genes.gene("stiffness_nm_per_rad", "stiffness", STIFFNESS, range, stiffness_nm_per_rad);
        let (field, name) = ("servo_damping_nms_per_rad", "servo damping");
        let range = GeneRange::Fixed(self.servo_damping_nms_per_rad);
        genes.gene(field, name, SERVO_DAMPING, range, damping_nms_per_rad);
    }

    /// Returns the range of the servo's stiffness.
    pub(super) fn stiffnesses(&self) -> GeneRange<'static> {
        GeneRange::Between(self.stiffness_min_nm_per_rad, self.stiffness_max_nm_per_rad)
    }
}

/// Returns the range of twists for files that do not state it, in radians.
fn one_rad() -> f32 {
    1.0
}

/// Range of every frequency, in Hz. It reaches above 5 Hz, half the least rate of physics steps.
pub const FREQUENCY_RANGE_HZ: RangeInclusive<f32> = 0.01..=20.0;
/// The range of every servo's stiffness, in N·m/rad.
pub const STIFFNESS_RANGE_NM_PER_RAD: RangeInclusive<f32> = 0.0..=1.0e5;
/// The range of every servo's damping, in N·m·s/rad.
pub const SERVO_DAMPING_RANGE: RangeInclusive<f32> = 0.0..=1.0e4;
/// Quantity of a frequency.
pub const FREQUENCY: Quantity = Quantity::new("Hz", FREQUENCY_RANGE_HZ);
/// Quantity of the stiffness of a servo.
pub const STIFFNESS: Quantity = Quantity::new("N·m/rad", STIFFNESS_RANGE_NM_PER_RAD);
/// Quantity of the damping of a servo.
pub const SERVO_DAMPING: Quantity = Quantity::new("N·m·s/rad", SERVO_DAMPING_RANGE);
/// Greatest number of terms of a wave.
pub const MOST_HARMONICS: u32 = 5;

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
