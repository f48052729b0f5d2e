//! Periodic joint angles, followed by a servo.

use super::{Controller, Observation, Senses};
use crate::genome::controllers::{Gait, Wave};
use crate::world::JointTorque;

/// Pulls every joint towards the angle of a gait.
#[derive(Debug, Clone)]
pub struct GaitFollower(pub Gait);

impl GaitFollower {
    /// The torque of a proportional-derivative servo on a joint axis, in N·m.
    fn torque_nm(&self, target_rad: f32, angle_rad: f32, rate_rad_s: f32) -> f32 {
        self.0.stiffness_nm_per_rad * (target_rad - angle_rad)
            - self.0.servo_damping_nms_per_rad * rate_rad_s
    }
}

impl Controller for GaitFollower {
    fn needs(&self) -> Senses {
        Senses { joints: true }
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let waves = &self.0.waves;
        let periods = observation.periods(waves.frequency_hz);
        let pull = |wave: &Wave, angle_rad, rate_rad_s| {
            self.torque_nm(wave.at(periods), angle_rad, rate_rad_s)
        };
        let joints = waves.joints.iter().zip(observation.joints_ahead());
        for (torque, (joint, state)) in torques.iter_mut().zip(joints) {
            torque.bend_nm = pull(&joint.bend, state.bend_rad, state.bend_rad_s);
            torque.twist_nm = pull(&joint.twist, state.twist_rad, state.twist_rad_s);
        }
    }

    fn boxed_clone(&self) -> Box<dyn Controller> {
        Box::new(self.clone())
    }
}
