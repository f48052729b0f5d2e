//! The engine rapier with one snake on its stairs.
//!
//! Rapier computes with bodies of its own. They get the parts' state before a step and give it back after the step.

mod bounce;
mod build;
mod continued;

use rapier3d::geometry::NEW_CONTACT_BIT;
use rapier3d::prelude::*;

use super::contact::{ContactHooks, ContactLaws, other_collider, soft_contacts};
use super::engine::{PartContact, PartContactPoint, PartState, Touch, Touching, WorldEngine};
use super::{PhysicsWorld, WorldPlan};
use bounce::finish_bounce;
use build::{insert_ground, insert_joints, insert_parts, insert_stairs};

/// A world that rapier steps. Any world has this form, too, for debug lines, ray casts and benchmarks.
pub struct RapierWorld {
    physics: PhysicsWorld,
    /// The bodies of the parts, in the order of the plan's parts.
    bodies: Vec<RigidBodyHandle>,
    parts: Vec<PartState>,
    contacts: ContactSettings,
    /// Whether something besides velocities, forces and torques changed since the last step.
    is_changed: bool,
}

/// Settings of the contacts that each step needs.
#[derive(Debug, Clone)]
struct ContactSettings {
    laws: ContactLaws,
    /// Whether any material has restitution.
    bounces: bool,
    ground: ColliderHandle,
    substeps: u32,
    snake_kg: f32,
}

impl RapierWorld {
    /// Builds the world: the ground, the stairs from the lowest up, the parts from the head, and the joints and springs from the head.
    ///
    /// The order of insertion influences the bits of every run.
    pub(super) fn new(plan: &WorldPlan) -> Self {
        let softness = soft_contacts(plan);
        let laws = softness.laws;
        let mut physics = PhysicsWorld {
            gravity: plan.physics.gravity(),
            integration_parameters: IntegrationParameters {
                dt: plan.physics.step_s(),
                num_solver_iterations: plan.physics.substeps as usize,
                num_internal_pgs_iterations: plan.physics.iterations as usize,
                ..Default::default()
            },
            ..Default::default()
        };
        softness.set_up(&mut physics.integration_parameters, &plan.physics);
        let bounces = [plan.surface.bounce, plan.ground.bounce, plan.skin.bounce]
            .iter()
            .any(|&bounce| bounce > 0.0);
        if bounces {
            // Without recycling, contacts keep the mark that they are new. The bounce correction needs this mark.
            physics.integration_parameters.contact_recycling = false;
        }
        let ground = insert_ground(&mut physics, plan, &laws);
        insert_stairs(&mut physics, plan, &laws.stairs);
        let bodies = insert_parts(&mut physics, plan, &laws.limbs);
        insert_joints(&mut physics, &bodies, plan);
        let (substeps, snake_kg) = (plan.physics.substeps, plan.body.mass_kg());
        Self {
            physics,
            parts: plan.start_poses().into_iter().map(PartState::at_rest).collect(),
            bodies,
            contacts: ContactSettings { laws, bounces, ground, substeps, snake_kg },
            is_changed: true,
        }
    }

    /// Gives read access to rapier's bodies, colliders, joints and contacts.
    pub fn physics(&self) -> &PhysicsWorld {
        &self.physics
    }

    /// Returns the bodies of the parts, in the order of the plan's parts. The ground can be another body, which is not among them.
    pub fn bodies(&self) -> &[RigidBodyHandle] {
        &self.bodies
    }

    /// Advances rapier by one step, without the laws of contacts that rapier does not know, and without reading the contacts.
    pub(super) fn step_bare(&mut self) {
        self.give_states();
        self.physics.step();
        self.take_states();
    }

    /// Gives the state of the parts to the bodies. Rapier computes again what depends on a place only where the place has changed.
    fn give_states(&mut self) {
        for (&handle, state) in self.bodies.iter().zip(&self.parts) {
            let body = &mut self.physics.bodies[handle];
            let (pose, is_held) = (state.pose(), body.is_fixed());
            if is_held != state.is_held || *body.position() != pose {
                self.is_changed = true;
                let kind =
                    if state.is_held { RigidBodyType::Fixed } else { RigidBodyType::Dynamic };
                body.set_body_type(kind, true);
                body.set_position(pose, true);
            }
            body.set_linvel(state.linear, false);
            body.set_angvel(state.angular, false);
            body.reset_forces(false);
            body.add_force(state.force_n, false);
            body.reset_torques(false);
            body.add_torque(state.torque_nm, false);
        }
    }

    fn take_states(&mut self) {
        for (&handle, state) in self.bodies.iter().zip(&mut self.parts) {
            let body = &self.physics.bodies[handle];
            (state.at, state.turn) = (body.translation(), *body.rotation());
            (state.linear, state.angular) = (body.linvel(), body.angvel());
        }
    }

    /// Returns what a part touches, and the force of these contacts in the last substep. The engine's warm-start impulses are those of the
    /// last substep; its sums begin with the step before.
    fn touch(&self, part: RigidBodyHandle) -> Touch {
        let (mut touch, mut impulse) = (Touch::default(), Vector::ZERO);
        let collider = self.physics.bodies[part].colliders()[0];
        for pair in self.physics.narrow_phase.contact_pairs_with(collider) {
            if !pair.has_any_active_contact() {
                continue;
            }
            match self.touching(other_collider(pair, collider)) {
                Touching::Ground => touch.ground = true,
                Touching::Solid(_) => touch.stairs = true,
                Touching::Part(_) => continue,
            }
            let side = if pair.collider1 == collider { -1.0 } else { 1.0 };
            for manifold in pair.solver_manifolds() {
                // All points of a manifold share one friction impulse.
                let mut friction = None;
                for point in solved_points(manifold) {
                    if point.data.warmstart_impulse > 0.0 {
                        friction = Some(point.data.warmstart_tangent_world);
                        let normal = manifold.data.normal * point.data.warmstart_impulse;
                        impulse += normal * side;
                    }
                }
                impulse -= friction.unwrap_or(Vector::ZERO) * side;
            }
        }
        let substep_s =
            self.physics.integration_parameters.dt / self.contacts.substeps.max(1) as f32;
        touch.force_n = impulse / substep_s;
        touch
    }

    /// Returns what a part touches that touches this collider.
    fn touching(&self, collider: ColliderHandle) -> Touching {
        if collider == self.contacts.ground {
            return Touching::Ground;
        }
        match self.physics.colliders[collider].parent() {
            Some(body) => {
                Touching::Part(self.bodies.iter().position(|of| *of == body).unwrap_or(0))
            }
            // The solids were inserted one after another, right after the ground.
            None => Touching::Solid(collider.into_raw_parts().0.saturating_sub(1) as usize),
        }
    }

    /// Returns a manifold as a contact of a part.
    fn contact(
        &self,
        pair: &ContactPair,
        manifold: &ContactManifold,
        part: usize,
        other: Touching,
    ) -> PartContact {
        let colliders = [pair.collider1, pair.collider2].map(|of| &self.physics.colliders[of]);
        let is_first = colliders[0].parent() == Some(self.bodies[part]);
        let outer = if is_first { colliders[1] } else { colliders[0] };
        let points = solved_points(manifold).map(|point| {
            let [on_part, on_other] = if is_first {
                [point.local_p1, point.local_p2]
            } else {
                [point.local_p2, point.local_p1]
            };
            PartContactPoint {
                on_part,
                on_other: if matches!(other, Touching::Part(_)) {
                    on_other
                } else {
                    *outer.position() * on_other
                },
                impulse_ns: point.data.warmstart_impulse,
            }
        });
        // Each point holds the friction of the whole patch. It acts on the first body, and the normal points to the second.
        let of_patch = solved_points(manifold).last().map(|point| point.data);
        let friction_ns = of_patch.map_or(Vector::ZERO, |of| of.warmstart_tangent_world);
        let side = if is_first { 1.0 } else { -1.0 };
        PartContact {
            part,
            other,
            normal: manifold.data.normal * -side,
            friction: colliders[0].friction() * colliders[1].friction(),
            friction_ns: friction_ns * side,
            twist_nms: of_patch.map_or(0.0, |of| of.warmstart_twist_impulse),
            has_bounced: self.contacts.bounces
                && manifold.data.restitution > 0.0
                && has_new_impulse(manifold),
            points: points.collect(),
        }
    }
}

impl WorldEngine for RapierWorld {
    fn parts(&self) -> &[PartState] {
        &self.parts
    }

    fn parts_mut(&mut self) -> &mut [PartState] {
        &mut self.parts
    }

    fn step(&mut self) {
        self.give_states();
        let ContactSettings { laws, ground, substeps, snake_kg, .. } = &self.contacts;
        let hooks = ContactHooks {
            laws,
            ground: *ground,
            step_s: self.physics.integration_parameters.dt,
            substeps: *substeps,
            snake_kg: *snake_kg,
        };
        if self.is_changed {
            mark_all_bodies(&mut self.physics.bodies);
        } else {
            unmark_all_bodies(&mut self.physics.bodies);
        }
        self.is_changed = false;
        self.physics.step_with_events(&hooks, &());
        self.take_states();
        for index in 0..self.parts.len() {
            self.parts[index].touch = self.touch(self.bodies[index]);
        }
    }

    fn bounce(&mut self, earlier: &[PartState]) {
        if self.contacts.bounces {
            for (&body, before) in self.bodies.iter().zip(earlier) {
                finish_bounce(&mut self.physics, body, before);
            }
            self.take_states();
        }
    }

    fn has_failed(&self) -> bool {
        // Rapier rolls back a body with a non-finite state, and reports the body in its quarantine.
        !self.physics.quarantine().is_empty()
    }

    fn contacts(&self) -> Vec<PartContact> {
        let mut contacts = Vec::new();
        for (index, &body) in self.bodies.iter().enumerate() {
            let collider = self.physics.bodies[body].colliders()[0];
            for pair in self.physics.narrow_phase.contact_pairs_with(collider) {
                let (part, other) = match self.touching(other_collider(pair, collider)) {
                    Touching::Part(rear) if rear < index => continue,
                    Touching::Part(rear) => (rear, Touching::Part(index)),
                    world => (index, world),
                };
                let manifolds = pair.solver_manifolds().iter();
                contacts.extend(manifolds.map(|of| self.contact(pair, of, part, other)));
            }
        }
        contacts
    }

    fn continue_from(&mut self, earlier: &dyn WorldEngine) {
        self.continue_as(earlier);
    }

    fn cloned(&self) -> Box<dyn WorldEngine> {
        Box::new(self.clone())
    }
}

/// Returns the points of a manifold that the solver has just solved. A manifold also holds points that are near but do not touch, with the
/// impulses of their last touch.
fn solved_points(manifold: &ContactManifold) -> impl Iterator<Item = &TrackedContact<ContactData>> {
    manifold.data.solver_contacts.iter().filter_map(|contact| {
        manifold.points.get((contact.contact_id[0] & !NEW_CONTACT_BIT) as usize)
    })
}

/// Returns whether a point of a manifold touches for the first time and presses. The engine lets only such points bounce.
fn has_new_impulse(manifold: &ContactManifold) -> bool {
    manifold.data.solver_contacts.iter().any(|contact| {
        let id = contact.contact_id[0];
        let point = manifold.points.get((id & !NEW_CONTACT_BIT) as usize);
        id & NEW_CONTACT_BIT != 0 && point.is_some_and(|point| point.data.impulse > 0.0)
    })
}

/// Marks all bodies as changed, so that the engine's next step takes account of every change in them.
fn mark_all_bodies(bodies: &mut RigidBodySet) {
    bodies.iter_mut().for_each(drop);
}

/// Clears the engine's list of changed bodies. Torques and velocities take effect without a mark. With it, the engine would assemble the
/// joints anew in each step, with the same bits as a result.
fn unmark_all_bodies(bodies: &mut RigidBodySet) {
    // The iterator clears the list of changed bodies, and lists each body that it yields.
    drop(bodies.iter_mut());
}

impl Clone for RapierWorld {
    fn clone(&self) -> Self {
        let physics = &self.physics;
        Self {
            physics: PhysicsWorld {
                gravity: physics.gravity,
                integration_parameters: physics.integration_parameters,
                // The pipeline holds working memory only; a new pipeline gives the same bits.
                physics_pipeline: PhysicsPipeline::new(),
                islands: physics.islands.clone(),
                broad_phase: physics.broad_phase.clone(),
                narrow_phase: physics.narrow_phase.clone(),
                bodies: physics.bodies.clone(),
                colliders: physics.colliders.clone(),
                impulse_joints: physics.impulse_joints.clone(),
                multibody_joints: physics.multibody_joints.clone(),
                ccd_solver: physics.ccd_solver.clone(),
            },
            bodies: self.bodies.clone(),
            parts: self.parts.clone(),
            contacts: self.contacts.clone(),
            is_changed: self.is_changed,
        }
    }
}

#[cfg(test)]
mod tests;
