//! Target angles, played back and followed by a servo.

use super::servo::JointServos;
use super::{Controller, Observation, Senses};
use crate::genome::controllers::{JointTargets, TargetSignals, held_value};
use crate::world::JointTorque;

/// Pulls every joint towards its target: each target holds until the next takes effect, the last one to the end.
#[derive(Debug, Clone)]
pub struct TargetFollower {
    points_per_s: f32,
    joints: Vec<JointTargets>,
    servo: JointServos,
}

impl TargetFollower {
    /// Creates the follower of targets before the first step.
    pub fn new(targets: TargetSignals) -> Self {
        let TargetSignals { stiffness_nm_per_rad, servo_damping_nms_per_rad, points_per_s, joints } =
            targets;
        let servo = JointServos::new(stiffness_nm_per_rad, servo_damping_nms_per_rad);
        Self { points_per_s, joints, servo }
    }
}

impl Controller for TargetFollower {
    fn needs(&self) -> Senses {
        Senses::JOINTS
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let point = observation.point(self.points_per_s);
        let at_point = |JointTargets { bend_rad, twist_rad }: &JointTargets| {
            [bend_rad, twist_rad].map(|signal| held_value(signal, point))
        };
        let targets = self.joints.iter().map(at_point);
        self.servo.pull(observation, targets, torques);
    }
}

#[cfg(test)]
mod tests {
    use crate::control::ExternalControl;
    use crate::genome::Genome;
    use crate::genome::controllers::RecordedActions;
    use crate::score::{Rollout, Trial, evaluate};
    use crate::world::JointTorque;

    #[test]
    fn r10_recorded_targets_and_torques_replay_the_episode_bit_for_bit() {
        let trial = Trial { duration_s: 4.0, ..Trial::default() };
        let genome = trial.random_genome(3);
        for (servo, steps_per_action) in
            [(Some([800.0, 40.0]), 1), (Some([300.0, 0.0]), 7), (None, 7), (None, 100)]
        {
            let [stiffness, damping] = servo.unwrap_or_default();
            let senses = trial.agent.senses;
            let mut control = ExternalControl::new(&trial.physics, senses, stiffness, damping);
            let mut outside = Rollout::new(&genome, &trial);
            let (mut values, mut torques) = (Vec::new(), [JointTorque::default(); 4]);
            while !outside.is_over() {
                control.observe(outside.step(), outside.simulation());
                if outside.step().is_multiple_of(steps_per_action) {
                    // A policy of senses, whose actions no formula of the time gives.
                    let swing = if servo.is_some() { 0.8 } else { 600.0 };
                    let senses: Vec<f32> = control.perception().values().take(8).collect();
                    let phase = outside.step() as f32 / 9.0;
                    values.extend(senses.iter().map(|of| swing * libm::sinf(phase + 3.0 * of)));
                }
                let now = &values[values.len() - 8..];
                let commands = now.as_chunks::<2>().0.iter();
                if servo.is_some() {
                    control.pull_towards(commands.copied(), &mut torques);
                } else {
                    for (torque, [bend_nm, twist_nm]) in torques.iter_mut().zip(commands) {
                        *torque = JointTorque { bend_nm: *bend_nm, twist_nm: *twist_nm };
                    }
                }
                outside.advance_with(&torques);
            }
            let recorded = RecordedActions {
                values: &values,
                joints: 4,
                steps_per_action,
                steps_per_s: trial.physics.steps_per_s,
                duration_s: trial.duration_s,
                servo,
            };
            let played = Genome { controller: recorded.genes(), ..genome.clone() };
            trial.check_genome(&played).expect("allowed");
            let (found, expected) = (evaluate(&played, &trial), outside.evaluation());
            assert!(expected.steps > 100);
            assert_eq!(found.trace_hash, expected.trace_hash, "{servo:?}, {steps_per_action}");
            assert_eq!((found.fitness, found.effort), (expected.fitness, expected.effort));
        }
    }
}
