//! Torque signals, played back.

use crate::genome::Signals;
use crate::world::JointTorque;

/// Plays back torque signals: each point holds until the next takes effect, the last one to the end.
#[derive(Debug, Clone)]
pub struct SignalPlayer {
    signals: Signals,
    points_per_step: f64,
}

impl SignalPlayer {
    /// A player for a world that takes `steps_per_s` steps a second.
    pub fn new(signals: Signals, steps_per_s: u32) -> Self {
        let points_per_step = f64::from(signals.points_per_s) / f64::from(steps_per_s);
        Self { signals, points_per_step }
    }

    /// Writes the torques of step number `step` (0 is the first), one per joint from the head.
    pub fn torques(&self, step: u32, torques: &mut [JointTorque]) {
        let point = (f64::from(step) * self.points_per_step) as usize;
        let at_point = |signal: &[f32]| signal.get(point).or(signal.last()).copied().unwrap_or(0.0);
        for (torque, joint) in torques.iter_mut().zip(&self.signals.joints) {
            torque.bend_nm = at_point(&joint.bend_nm);
            torque.twist_nm = at_point(&joint.twist_nm);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::JointSignals;

    #[test]
    fn a_point_holds_until_the_next_and_the_last_to_the_end() {
        let joints = vec![JointSignals { bend_nm: vec![1.0, 2.0, 3.0], twist_nm: vec![-1.0] }];
        let player = SignalPlayer::new(Signals { points_per_s: 20.0, joints }, 60);
        let mut torques = [JointTorque::default()];
        let bends: Vec<f32> = (0..12)
            .map(|step| {
                player.torques(step, &mut torques);
                torques[0].bend_nm
            })
            .collect();
        assert_eq!(bends, [1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0]);
        assert_eq!(torques[0].twist_nm, -1.0);
    }
}
