//! Periodic joint angles, followed by a servo.

use super::servo::JointServos;
use super::{Controller, Observation, Perception, Senses};
use crate::genome::controllers::{Gait, Steering, Waves};
use crate::world::JointTorque;

/// Turns every joint towards the target angle of a gait.
#[derive(Debug, Clone)]
pub struct GaitFollower {
    waves: Waves,
    steering: Steering,
    servo: JointServos,
}

impl GaitFollower {
    /// Creates the follower of a gait before the first step.
    pub fn new(gait: Gait) -> Self {
        let Gait { stiffness_nm_per_rad, servo_damping_nms_per_rad, waves, steering } = gait;
        let servo = JointServos::new(stiffness_nm_per_rad, servo_damping_nms_per_rad);
        Self { waves, steering, servo }
    }
}

impl Controller for GaitFollower {
    fn needs(&self) -> Senses {
        if self.steering.is_used() { Senses::ALL } else { Senses::JOINTS }
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let periods = observation.periods(self.waves.frequency_hz);
        let waves = self.waves.joints.iter();
        let targets = waves.map(|joint| [joint.bend.at(periods), joint.twist.at(periods)]);
        if !self.steering.is_used() {
            return self.servo.pull(observation, targets, torques);
        }
        let Steering { yaw_rad, aside_rad, roll_rad } = self.steering;
        let Perception { snake, limbs, .. } = &observation.perception;
        let by_heading = yaw_rad * snake.yaw + aside_rad * snake.aside;
        let targets = targets
            .zip(limbs.iter().skip(1))
            .map(|([bend, twist], rear)| [bend, twist + by_heading + roll_rad * rear.roll]);
        self.servo.pull(observation, targets, torques);
    }
}

#[cfg(test)]
mod tests {
    use crate::control::{ActiveSenses, ControlLoop};
    use crate::evolve::Champion;
    use crate::genome::ControllerGenes;
    use crate::genome::controllers::{Gait, JointWaves, Steering, Wave, Waves};
    use crate::save::shipped_champion;
    use crate::score::{Perturbation, Rollout, Trial};
    use crate::world::{
        JointTorque, PhysicsEngine, PhysicsSettings, Simulation, TESTED_RATES, Vector,
    };

    /// Returns the angles after each step of two floating limbs whose joint is twisted at 2 rad/s and turned back by a servo.
    fn swing_rad(
        physics: &PhysicsSettings,
        stiffness: f32,
        joint_damping: f32,
        servo_damping: f32,
    ) -> Vec<f32> {
        let mut trial = Trial { physics: physics.clone(), ..Trial::default() };
        trial.physics.gravity_m_s2 = 0.0;
        trial.agent.limbs = 2;
        trial.agent.density_kg_m3 = Some(2.5.into());
        trial.agent.twist_limit_rad = Some(3.0.into());
        trial.agent.joint_damping_nms_per_rad = joint_damping.into();
        trial.agent.angular_damping_per_s = 0.0;
        let mut genome = trial.random_genome(0);
        let straight = Wave { offset: 0.0, harmonics: Vec::new() };
        let joints = vec![JointWaves { bend: straight.clone(), twist: straight }];
        genome.controller = ControllerGenes::Gait(Gait {
            stiffness_nm_per_rad: stiffness,
            servo_damping_nms_per_rad: servo_damping,
            waves: Waves { frequency_hz: 1.0, joints },
            steering: Steering::default(),
        });
        let mut world = Simulation::new(&trial.world_plan(&genome));
        world.change_parts(|(index, part)| {
            part.at.z += 30.0;
            part.angular = Vector::new(0.0, if index == 0 { 1.0 } else { -1.0 }, 0.0);
        });
        let mut control =
            ControlLoop::new(&genome, &trial.world_plan(&genome), ActiveSenses::default());
        let mut torques = [JointTorque::default()];
        let step = |step| {
            control.act(step, &world, &mut torques);
            world.step(&torques).expect("healthy");
            world.joint_states().next().expect("a joint").twist_rad
        };
        (0..2 * physics.steps_per_s).map(step).collect()
    }

    /// Returns where the shipped climber's middle limb is, in metres, after two seconds with this steering in a trial that begins turned by
    /// `turn_rad`.
    fn with_steering(steering: Steering, turn_rad: f32) -> Vector {
        let Champion { mut genome, mut trial, .. } = shipped_champion().expect("shipped").champion;
        // Before the stairs, whose edges make a motion sensitive.
        trial.duration_s = 2.0;
        trial.physics.engine = PhysicsEngine::Lanes;
        let ControllerGenes::Gait(gait) = &mut genome.controller else { panic!("a gait") };
        gait.steering = steering;
        let turned = Perturbation { turn_rad, ..Perturbation::default() };
        let mut rollout = Rollout::perturbed(&genome, &trial, &turned);
        while rollout.advance() {}
        rollout.middle_m()
    }

    #[test]
    fn steering_leaves_a_symmetric_trial_as_it_is_and_moves_mirrored_starts_to_mirrored_sides() {
        let none = Steering::default();
        for steering in [
            Steering { yaw_rad: 0.5, ..none },
            Steering { aside_rad: 2.0, ..none },
            Steering { yaw_rad: -0.2, aside_rad: 0.1, roll_rad: 0.4 },
        ] {
            let moved_m = with_steering(steering, 0.0).distance(with_steering(none, 0.0));
            assert!(moved_m < 0.01, "{steering:?}: {moved_m} m");
            let [left, right] = [-0.1, 0.1].map(|turn_rad| with_steering(steering, turn_rad));
            let unsteered = with_steering(none, -0.1);
            assert!(left.distance(unsteered) > 0.15, "{steering:?}: {left}, {unsteered}");
            // The engine solves contacts one after the other, so a mirrored motion is not exactly the mirror image.
            let mirrored = Vector::new(-right.x, right.y, right.z);
            assert!(left.distance(mirrored) < 0.15, "{steering:?}: {left}, {right}");
        }
    }

    #[test]
    fn a_servo_swings_a_joint_with_the_period_and_the_decay_of_its_spring_and_damper() {
        for (steps_per_s, substeps) in TESTED_RATES {
            let physics = PhysicsSettings { steps_per_s, substeps, ..Default::default() };
            for (stiffness, joint_damping, servo_damping) in [
                (60.0, 0.0, 0.0),
                (60.0, 1.0, 0.0),
                (60.0, 0.0, 1.0),
                (60.0, 0.0, 2.5),
                (120.0, 0.5, 0.5),
            ] {
                let case = format!(
                    "{stiffness}, {joint_damping}, {servo_damping} at {steps_per_s} and {substeps}"
                );
                let angles = swing_rad(&physics, stiffness, joint_damping, servo_damping);
                // A limb has m (width² + height²) / 12 = 5/6 kg m²; for the joint between two limbs, half of it counts.
                let inertia = 5.0 / 12.0;
                let decay_per_s = (joint_damping + servo_damping) / inertia / 2.0;
                let angular = (stiffness / inertia - decay_per_s * decay_per_s).sqrt();
                // The turning points are the vertices of parabolas through three points.
                let mut turns = Vec::new();
                for (index, three) in angles.windows(3).enumerate() {
                    let [a, b, c] = [three[0], three[1], three[2]];
                    if (b - a) * (c - b) < 0.0 {
                        let shift = (a - c) / (2.0 * (a - 2.0 * b + c));
                        let at_s = (index as f32 + 1.0 + shift) * physics.step_s();
                        turns.push((at_s, b - (a - c) * shift / 4.0));
                    }
                }
                let (first, last) = (turns[0], turns[4]);
                let half_s = (last.0 - first.0) / 4.0;
                let expected_s = std::f32::consts::PI / angular;
                assert!(
                    (half_s / expected_s - 1.0).abs() < 0.02,
                    "{half_s} s for {expected_s}: {case}"
                );
                let kept = (last.1 / first.1).abs();
                if decay_per_s == 0.0 {
                    assert!((kept - 1.0).abs() < 0.03, "{kept}: {case}");
                    continue;
                }
                let found_per_s = -libm::logf(kept) / (4.0 * half_s);
                assert!(
                    (found_per_s / decay_per_s - 1.0).abs() < 0.03,
                    "{found_per_s} 1/s for {decay_per_s} 1/s: {case}"
                );
            }
        }
    }
}
