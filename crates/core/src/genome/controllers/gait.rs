//! Gaits: periodic joint angles, and the servo that follows them.

use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo, JointCommands};
use super::wave::Waves;
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::limits::LARGEST_LIMIT_RAD;
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::{SERVO_DAMPING_RANGE, STIFFNESS_RANGE_NM_PER_RAD};

/// Target angles of the joints, and the servo that pulls towards them: a torque of
/// `stiffness · (target − angle) − damping · rate`, clamped to the joint's limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gait {
    /// Torque per angle by which a joint misses its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, in N·m·s/rad.
    pub servo_damping_nms_per_rad: f32,
    /// The target angles, in radians.
    pub waves: Waves,
}

impl ControllerEncoding for Gait {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "gait",
            title: "Gait",
            words: "Periodic joint angles, followed by a servo that senses the joint.",
            senses_surroundings: false,
            settings: &[
                "wave.frequency_min_hz",
                "wave.frequency_max_hz",
                "wave.harmonics",
                "wave.angle_range_rad",
                "wave.twist_range_rad",
                "wave.stiffness_min_nm_per_rad",
                "wave.stiffness_max_nm_per_rad",
                "wave.servo_damping_nms_per_rad",
            ],
        }
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        Self {
            stiffness_nm_per_rad: 0.0,
            servo_damping_nms_per_rad: space.wave.servo_damping_nms_per_rad,
            waves: Waves::zeroed(space, shape),
        }
    }

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        let wave = &space.wave;
        let range =
            GeneRange::Between(wave.stiffness_min_nm_per_rad, wave.stiffness_max_nm_per_rad);
        let (field, name) = (format_args!("stiffness_nm_per_rad"), format_args!("stiffness"));
        visit(Gene { field, name, unit: "N·m/rad", range }, &mut self.stiffness_nm_per_rad);
        let range = GeneRange::Fixed(wave.servo_damping_nms_per_rad);
        let field = format_args!("servo_damping_nms_per_rad");
        let name = format_args!("servo damping");
        visit(Gene { field, name, unit: "N·m·s/rad", range }, &mut self.servo_damping_nms_per_rad);
        self.waves.genes_up_to([wave.angle_range_rad, wave.twist_range_rad], "rad", space, visit);
    }

    fn lengths(&self, visit: &mut dyn FnMut(&'static str, usize)) {
        self.waves.lengths(visit);
    }

    fn joints(&self) -> usize {
        self.waves.joints.len()
    }

    fn frequency_hz(&self) -> f32 {
        self.waves.frequency_hz
    }

    fn check(&self) -> Result<(), Invalid> {
        let (stiffness, damping) = (self.stiffness_nm_per_rad, self.servo_damping_nms_per_rad);
        within("gait.stiffness_nm_per_rad", stiffness, STIFFNESS_RANGE_NM_PER_RAD)?;
        within("gait.servo_damping_nms_per_rad", damping, SERVO_DAMPING_RANGE)?;
        self.waves.check_up_to(LARGEST_LIMIT_RAD).map_err(|error| error.inside("gait"))
    }

    fn widen(&self, space: &mut GenomeSpace) {
        let ranges = [space.wave.angle_range_rad, space.wave.twist_range_rad];
        let [bend_rad, twist_rad] = self.waves.widen_from(ranges, space);
        (space.wave.angle_range_rad, space.wave.twist_range_rad) = (bend_rad, twist_rad);
        let wave = &mut space.wave;
        wave.widen_stiffness(self.stiffness_nm_per_rad);
        wave.servo_damping_nms_per_rad = self.servo_damping_nms_per_rad;
    }

    fn commands(&self, duration_s: f64) -> Option<JointCommands> {
        let joints = self.waves.samples(duration_s);
        let quantity = "target angle in rad";
        Some(JointCommands { quantity, least_range: 1.0, is_held: false, joints })
    }
}
