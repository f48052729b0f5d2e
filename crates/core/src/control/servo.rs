//! Servos that turn the joints towards target angles.

use super::Observation;
use crate::world::JointTorque;

/// A proportional-derivative servo on each joint axis, with a torque of `stiffness · (target − angle) − damping · rate`.
#[derive(Debug, Clone)]
pub struct JointServos {
    stiffness_nm_per_rad: f32,
    damping_nms_per_rad: f32,
    /// Rates of each joint's bend and twist before the last step, in rad/s.
    last_rates: Vec<[f32; 2]>,
}

impl JointServos {
    /// Creates servos before the first step, with a stiffness in N·m/rad and a damping in N·m·s/rad.
    pub fn new(stiffness_nm_per_rad: f32, damping_nms_per_rad: f32) -> Self {
        Self { stiffness_nm_per_rad, damping_nms_per_rad, last_rates: Vec::new() }
    }

    /// Writes the torques that turn the joints, from the head, towards these angles of bend and twist, in radians.
    pub fn pull(
        &mut self,
        observation: &Observation,
        targets: impl Iterator<Item = [f32; 2]>,
        torques: &mut [JointTorque],
    ) {
        if self.last_rates.is_empty() {
            self.last_rates
                .extend(observation.joints.iter().map(|now| [now.bend_rad_s, now.twist_rad_s]));
        }
        let torque_nm = |target_rad: f32, angle_rad: f32, rate_rad_s: f32| {
            self.stiffness_nm_per_rad * (target_rad - angle_rad)
                - self.damping_nms_per_rad * rate_rad_s
        };
        // The damping uses the rate in the middle of the step, extrapolated by the method of Adams and Bashforth, because the torque holds
        // for the whole step.
        let middle = |now: f32, last: f32| 1.5 * now - 0.5 * last;
        let joints = targets.zip(observation.joints_ahead()).zip(&self.last_rates);
        for (torque, (([bend_rad, twist_rad], state), last)) in torques.iter_mut().zip(joints) {
            let [bend, twist] = *last;
            torque.bend_nm = torque_nm(bend_rad, state.bend_rad, middle(state.bend_rad_s, bend));
            torque.twist_nm =
                torque_nm(twist_rad, state.twist_rad, middle(state.twist_rad_s, twist));
        }
        for (last, now) in self.last_rates.iter_mut().zip(&observation.joints) {
            *last = [now.bend_rad_s, now.twist_rad_s];
        }
    }
}
