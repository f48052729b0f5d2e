//! Continues a running world under another plan.

use rapier3d::prelude::*;

use super::Simulation;
use crate::world::{Discontinuity, PhysicsWorld, WorldPlan};

impl Simulation {
    /// Checks whether this world, which was built from `plan`, can continue under `next` in its present state.
    ///
    /// # Errors
    /// Returns the reason if the world cannot continue.
    pub fn can_continue(&self, plan: &WorldPlan, next: &WorldPlan) -> Result<(), Discontinuity> {
        plan.can_continue(next)?;
        let first_riser_y_m = plan.stairs.first_riser_y_m.min(next.stairs.first_riser_y_m);
        if plan.stairs != next.stairs && self.front_y_m() >= first_riser_y_m {
            return Err(Discontinuity::Stairs);
        }
        Ok(())
    }

    /// Returns the largest y of any part, in metres.
    fn front_y_m(&self) -> f32 {
        let parts = self.body.parts.iter().zip(self.poses());
        let fronts = parts.map(|(part, pose)| pose.translation.y + part.reach_m(pose.rotation).y);
        fronts.fold(f32::MIN, f32::max)
    }

    /// Returns a world with the present state of this one under another plan, for which [`Self::can_continue`] holds. If only materials,
    /// masses, limits or the solver differ, the engine's contacts continue, too, so that under an unchanged plan the world continues with
    /// the bits of this one. A user's pull ends.
    pub fn continued_in(&self, plan: &WorldPlan) -> Self {
        let fresh = Self::new(plan);
        let both_rapier = self.lanes.is_none() && fresh.lanes.is_none();
        let mut continued = if both_rapier && self.is_built_like(&fresh) {
            let mut continued = self.clone();
            take_parameters(&mut continued.physics, &fresh.physics);
            continued
        } else {
            let mut continued = fresh.clone();
            for (&old, &new) in self.parts.iter().zip(&fresh.parts) {
                let old = &self.physics.bodies[old];
                let new = &mut continued.physics.bodies[new];
                new.set_position(*old.position(), true);
                new.set_linvel(old.linvel(), true);
                new.set_angvel(old.angvel(), true);
            }
            continued.take_contacts_of(self);
            continued
        };
        continued.is_changed = true;
        continued.contacts = fresh.contacts;
        continued.profile = fresh.profile;
        continued.damping = fresh.damping;
        continued.damping_as_torque = fresh.damping_as_torque;
        continued.body = fresh.body;
        continued.health = fresh.health;
        continued.arena_front_y_m = fresh.arena_front_y_m;
        continued.effort = self.effort;
        continued.pull = None;
        continued.take_balance_of(self);
        continued
    }

    /// Returns whether both worlds have the same bodies and colliders, except for their parameters.
    fn is_built_like(&self, other: &Self) -> bool {
        let are_bodies_equal =
            self.contacts.laws.ground_is_apart() == other.contacts.laws.ground_is_apart();
        // Steps have no body. The sizes of the limbs are already known to be equal.
        let steps = |simulation: &Self| {
            let colliders = simulation.physics.colliders.iter();
            let fixed = colliders.filter(|(_, collider)| collider.parent().is_none());
            fixed
                .map(|(_, collider)| {
                    let half_m = collider.shape().as_cuboid().map(|cuboid| cuboid.half_extents);
                    (*collider.position(), half_m)
                })
                .collect::<Vec<_>>()
        };
        are_bodies_equal && steps(self) == steps(other)
    }
}

/// Copies the parameters of another world that is built like this one. Equal parameters are not written, because the engine recomputes
/// everything that was written.
fn take_parameters(physics: &mut PhysicsWorld, from: &PhysicsWorld) {
    physics.gravity = from.gravity;
    physics.integration_parameters = from.integration_parameters;
    for (handle, wanted) in from.colliders.iter() {
        let present = &physics.colliders[handle];
        if present.density() != wanted.density() {
            physics.colliders[handle].set_density(wanted.density());
            // The balance reads the energy with the new mass before the next step, which would otherwise compute the mass.
            if let Some(limb) = wanted.parent() {
                physics.bodies[limb].recompute_mass_properties_from_colliders(&physics.colliders);
            }
        }
        let material = |of: &Collider| (of.friction(), of.restitution(), of.active_hooks());
        if material(&physics.colliders[handle]) != material(wanted) {
            let collider = &mut physics.colliders[handle];
            collider.set_friction(wanted.friction());
            collider.set_restitution(wanted.restitution());
            collider.set_active_hooks(wanted.active_hooks());
            // A recycled contact would keep the old material. A change of groups makes the engine recompute the contact.
            let groups = collider.collision_groups();
            collider.set_collision_groups(InteractionGroups::none());
            collider.set_collision_groups(groups);
        }
    }
    for (handle, wanted) in from.impulse_joints.iter() {
        let Some(present) = physics.impulse_joints.get(handle) else { continue };
        // The impulses of the last step belong to the state and are kept.
        let mut data = wanted.data;
        for axis in 0..data.limits.len() {
            data.limits[axis].impulse = present.data.limits[axis].impulse;
            data.motors[axis].impulse = present.data.motors[axis].impulse;
        }
        if data != present.data
            && let Some(joint) = physics.impulse_joints.get_mut(handle, true)
        {
            joint.data = data;
        }
    }
}
