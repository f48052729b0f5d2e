//! A world that displays what another engine computes.

use rapier3d::prelude::*;

use super::Simulation;

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
        for (&limb, state) in self.parts.iter().zip(limbs) {
            let body = &mut self.physics.bodies[limb];
            body.set_position(state.pose, false);
            body.set_linvel(state.velocity_m_s, false);
            body.set_angvel(state.angular_velocity_rad_s, false);
        }
        self.mirrored = limbs.iter().map(|state| state.contact_n).collect();
    }

    /// Returns whether a part touches the ground or the stairs, and their force on the part, in N.
    pub(super) fn sensed_contact(&self, part: usize) -> (bool, Vector) {
        match self.mirrored.get(part) {
            Some(force_n) => (force_n.is_some(), force_n.unwrap_or(Vector::ZERO)),
            None => self.contact_force(part),
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
                            let (touches, force_n) = world.sensed_contact(limb);
                            let contact_n = touches.then_some(force_n);
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
