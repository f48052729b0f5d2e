//! Gaits: periodic target angles of the joints, and the servo that follows them.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, JointCommands, LengthVisitor, SERVO_SETTINGS,
    SettingNames, TWIST_SETTINGS,
};
use super::wave::{ANGLE, Waves};
use crate::genome::gene::{GeneRange, Genes, GenomeShape};
use crate::genome::space::GenomeSpace;
use crate::schema::is_default;

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
    /// Angles by which the senses of balance move the twist targets of all joints.
    #[serde(default, skip_serializing_if = "is_default")]
    pub steering: Steering,
}

/// Twist of every joint per value of a sense, in radians. In a chain, a twist tilts the plane in which the parts ahead bend, so the snake turns
/// to the side to which they lean. Senses and twists change their signs in a mirror, so steering prefers no side.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Steering {
    /// Per sine of the head's yaw.
    pub yaw_rad: f32,
    /// Per offset from the middle of the stairs, in half widths.
    pub aside_rad: f32,
    /// Per sine of the roll of the part behind the joint.
    pub roll_rad: f32,
}

impl Steering {
    /// Returns whether a sense moves a target.
    pub fn is_used(&self) -> bool {
        *self != Self::default()
    }
}

impl Gait {
    /// Visits the genes of the servo and of the waves.
    pub(super) fn genes_without_steering(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let servo = [&mut self.stiffness_nm_per_rad, &mut self.servo_damping_nms_per_rad];
        space.wave.servo_genes(servo, genes);
        self.waves.angle_genes(space, genes);
    }
}

impl ControllerEncoding for Gait {
    fn settings() -> SettingNames {
        &[
            FREQUENCY_SETTINGS,
            SERVO_SETTINGS,
            TWIST_SETTINGS,
            &["wave.harmonics", "wave.steering_range_rad"],
        ]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        Self {
            stiffness_nm_per_rad: 0.0,
            servo_damping_nms_per_rad: space.wave.servo_damping_nms_per_rad,
            waves: Waves::zeroed(space, shape),
            steering: Steering::default(),
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.genes_without_steering(space, genes);
        let [_, twist_turns] = space.turning_axes();
        let most_rad = if twist_turns { space.wave.steering_range_rad } else { 0.0 };
        // A gait that does not steer has the genes, and so the hash, of gaits before there was steering.
        if most_rad == 0.0 && !self.steering.is_used() {
            return;
        }
        let Steering { yaw_rad, aside_rad, roll_rad } = &mut self.steering;
        for (field, name, weight) in [
            ("yaw_rad", "steering by yaw", yaw_rad),
            ("aside_rad", "steering by offset", aside_rad),
            ("roll_rad", "steering by roll", roll_rad),
        ] {
            let range = GeneRange::around_zero(most_rad);
            genes.inside("steering.", "", |genes| genes.gene(field, name, ANGLE, range, weight));
        }
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
        let Steering { yaw_rad, aside_rad, roll_rad } = self.steering;
        let most_rad = [yaw_rad, aside_rad, roll_rad].map(f32::abs).into_iter();
        space.wave.steering_range_rad = most_rad.fold(space.wave.steering_range_rad, f32::max);
    }

    fn commands(&self, duration_s: f64) -> Option<JointCommands> {
        // Targets that depend on the senses are no curves over time.
        if self.steering.is_used() {
            return None;
        }
        let joints = self.waves.samples(duration_s);
        let quantity = "target angle in rad";
        Some(JointCommands { quantity, least_range: 1.0, is_held: false, joints })
    }
}
