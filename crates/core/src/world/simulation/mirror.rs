//! A world that displays what another engine computes.

use super::Simulation;
use crate::world::engine::{PartState, Touch};
use crate::world::{Pose, Vector};

/// The state of a part in another engine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimbState {
    /// Pose of the part's centre in the world, in metres.
    pub pose: Pose,
    /// Velocity of the part's centre in the world, in m/s.
    pub velocity_m_s: Vector,
    /// Angular velocity of the part in the world, in rad/s.
    pub angular_velocity_rad_s: Vector,
    /// Force of ground and stairs on the part, in N; `None` if the part touches neither.
    pub contact_n: Option<Vector>,
}

impl Simulation {
    /// Copies the state of the parts from another engine, head first. From then on poses, joints and senses are those of the other engine,
    /// and this world must not be stepped any more.
    pub fn mirror(&mut self, limbs: &[LimbState]) {
        for (part, state) in self.engine.parts_mut().iter_mut().zip(limbs) {
            let touch = Touch {
                ground: state.contact_n.is_some(),
                force_n: state.contact_n.unwrap_or(Vector::ZERO),
                ..Touch::default()
            };
            *part = PartState {
                linear: state.velocity_m_s,
                angular: state.angular_velocity_rad_s,
                touch,
                ..PartState::at_rest(state.pose)
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::shipped_champions;
    use crate::score::Rollout;
    use crate::world::PhysicsEngine;

    #[test]
    fn a_mirror_has_the_senses_and_the_joints_of_its_original() {
        for (name, loaded) in shipped_champions() {
            if !["climber", "crawler", "sponge"].contains(&name) {
                continue;
            }
            for engine in [PhysicsEngine::Rapier, PhysicsEngine::Lanes] {
                let mut trial = loaded.champion.trial.clone();
                trial.physics.engine = engine;
                let mut original = Rollout::new(&loaded.champion.genome, &trial);
                let mut mirror = Simulation::new(&trial.world_plan(&loaded.champion.genome));
                let (mut of_original, mut of_mirror, mut pressed) = (Vec::new(), Vec::new(), 0);
                for _ in 0..300 {
                    assert!(original.advance(), "{name} in {engine:?}");
                    let world = original.simulation();
                    world.read_limbs(&mut of_original);
                    let limbs = world.poses().zip(world.velocities()).enumerate();
                    let states =
                        limbs.map(|(limb, (pose, [velocity_m_s, angular_velocity_rad_s]))| {
                            let touch = world.parts()[limb].touch;
                            let contact_n = touch.any().then_some(touch.force_n);
                            LimbState { pose, velocity_m_s, angular_velocity_rad_s, contact_n }
                        });
                    mirror.mirror(&states.collect::<Vec<_>>());
                    mirror.read_limbs(&mut of_mirror);
                    assert_eq!(of_mirror, of_original, "{name} in {engine:?}");
                    assert!(mirror.joint_states().eq(world.joint_states()));
                    assert_eq!(mirror.read_snake(), world.read_snake());
                    assert_eq!(mirror.climb(), world.climb());
                    let under_load =
                        of_mirror.iter().filter(|limb| limb.is_touching && limb.load_n > 0.0);
                    pressed += under_load.count();
                }
                assert!(pressed > 100, "{name} in {engine:?}: {pressed} limbs under load");
            }
        }
    }
}
