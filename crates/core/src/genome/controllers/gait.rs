//! Gaits: periodic target angles of the joints, and the servo that follows them.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, JointCommands, LengthVisitor, SERVO_SETTINGS,
    SettingNames, TWIST_SETTINGS,
};
use super::wave::Waves;
use crate::genome::gene::{Genes, GenomeShape};
use crate::genome::space::GenomeSpace;

/// Target angles of the joints, and the servo that turns the joints towards them with a torque of
/// `stiffness · (target − angle) − damping · rate`, clamped to the joint's limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gait {
    /// Torque per angle between a joint and its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, per rate, in N·m·s/rad.
    pub servo_damping_nms_per_rad: f32,
    /// Waves of the target angles, in radians.
    pub waves: Waves,
}

impl ControllerEncoding for Gait {
    fn settings() -> SettingNames {
        &[FREQUENCY_SETTINGS, SERVO_SETTINGS, TWIST_SETTINGS, &["wave.harmonics"]]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        Self {
            stiffness_nm_per_rad: 0.0,
            servo_damping_nms_per_rad: space.wave.servo_damping_nms_per_rad,
            waves: Waves::zeroed(space, shape),
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let servo = [&mut self.stiffness_nm_per_rad, &mut self.servo_damping_nms_per_rad];
        space.wave.servo_genes(servo, genes);
        self.waves.angle_genes(space, genes);
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        self.waves.lengths(visit);
    }

    fn joints(&self) -> usize {
        self.waves.joints.len()
    }

    fn widen(&self, space: &mut GenomeSpace) {
        let ranges = [space.wave.angle_range_rad, space.wave.twist_range_rad];
        let [bend_rad, twist_rad] = self.waves.widen_from(ranges, space);
        (space.wave.angle_range_rad, space.wave.twist_range_rad) = (bend_rad, twist_rad);
    }

    fn commands(&self, duration_s: f64) -> Option<JointCommands> {
        let joints = self.waves.samples(duration_s);
        let quantity = "target angle in rad";
        Some(JointCommands { quantity, least_range: 1.0, is_held: false, joints })
    }
}
