//! The controller with periodic torques.

use super::{Controller, Observation};
use crate::genome::controllers::Waves;
use crate::world::JointTorque;

/// Plays waves of torque.
#[derive(Debug, Clone)]
pub struct WavePlayer(pub Waves);

impl Controller for WavePlayer {
    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let periods = observation.periods(self.0.frequency_hz);
        for (torque, joint) in torques.iter_mut().zip(&self.0.joints) {
            torque.bend_nm = joint.bend.at(periods);
            torque.twist_nm = joint.twist.at(periods);
        }
    }
}
