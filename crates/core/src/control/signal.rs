//! The controller that plays back torque signals.

use super::{Controller, Observation};
use crate::genome::controllers::{TorqueSignals, held_value};
use crate::world::JointTorque;

/// Plays back torque signals. Each point holds until the next one takes effect, the last one to the end.
#[derive(Debug, Clone)]
pub struct SignalPlayer(pub TorqueSignals);

impl Controller for SignalPlayer {
    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let point = observation.point(self.0.points_per_s);
        for (torque, joint) in torques.iter_mut().zip(&self.0.joints) {
            torque.bend_nm = held_value(&joint.bend_nm, point);
            torque.twist_nm = held_value(&joint.twist_nm, point);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::controllers::JointSignals;

    #[test]
    fn a_point_holds_until_the_next_and_the_last_to_the_end() {
        let joints = vec![JointSignals { bend_nm: vec![1.0, 2.0, 3.0], twist_nm: vec![-1.0] }];
        let mut player = SignalPlayer(TorqueSignals { points_per_s: 20.0, joints });
        let mut torques = [JointTorque::default()];
        let bends: Vec<f32> = (0..12)
            .map(|step| {
                let observation = Observation { step, steps_per_s: 60, ..Observation::default() };
                player.act(&observation, &mut torques);
                torques[0].bend_nm
            })
            .collect();
        assert_eq!(bends, [1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0]);
        assert_eq!(torques[0].twist_nm, -1.0);
    }
}
