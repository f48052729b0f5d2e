//! Continues a world of rapier under other parameters.

use std::any::Any;

use rapier3d::prelude::*;

use super::RapierWorld;
use crate::world::PhysicsWorld;
use crate::world::engine::WorldEngine;

impl RapierWorld {
    /// Continues with the bodies and the contacts of an earlier world of rapier, if only materials, masses, limits or the solver differ.
    pub(super) fn continue_as(&mut self, earlier: &dyn WorldEngine) {
        let earlier: &dyn Any = earlier;
        let earlier = earlier.downcast_ref::<Self>();
        let Some(earlier) = earlier.filter(|of| self.is_built_like(of)) else { return };
        let mut continued = earlier.clone();
        take_parameters(&mut continued.physics, &self.physics);
        self.physics = continued.physics;
        self.parts = continued.parts;
    }

    /// Returns whether both worlds have the same bodies and colliders, except for their parameters.
    fn is_built_like(&self, other: &Self) -> bool {
        let are_bodies_equal =
            self.contacts.laws.ground_is_apart() == other.contacts.laws.ground_is_apart();
        // Steps have no body. The sizes of the limbs are already known to be equal.
        let steps = |world: &Self| {
            let colliders = world.physics.colliders.iter();
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
