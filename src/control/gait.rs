//! A servo: what pulls a joint towards the angle that a gait wants.

use crate::genome::Gait;

/// A proportional-derivative servo.
#[derive(Debug, Clone, Copy)]
pub struct Servo {
    stiffness_nm_per_rad: f32,
    damping_nms_per_rad: f32,
}

impl Servo {
    /// The servo of a gait.
    pub fn new(gait: &Gait) -> Self {
        Self {
            stiffness_nm_per_rad: gait.stiffness_nm_per_rad,
            damping_nms_per_rad: gait.servo_damping_nms_per_rad,
        }
    }

    /// The torque towards `target_rad` on a joint that stands at `angle_rad` and turns at `rate_rad_s`, in N·m.
    pub fn torque_nm(&self, target_rad: f32, angle_rad: f32, rate_rad_s: f32) -> f32 {
        self.stiffness_nm_per_rad * (target_rad - angle_rad) - self.damping_nms_per_rad * rate_rad_s
    }
}
