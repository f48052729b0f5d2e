//! The worlds of the lanes in the form of bevy_rapier3d, for its debug lines and its ray casts.
//!
//! A lane's rollout owns the bodies that are scored. A context holds copies of the bodies at the lane's place on the stage, which are
//! made when lines are drawn or a ray is cast. No plugin steps a context, so it cannot affect a result.

use bevy::ecs::query::QueryData;
use bevy::prelude::*;
use bevy_rapier3d::prelude::{
    QueryFilter, RapierContextColliders, RapierContextJoints, RapierContextSimulation,
    RapierQueryPipeline, RapierRigidBodySet,
};
use bevy_rapier3d::rapier::dynamics::{ImpulseJointSet, RigidBodyHandle, RigidBodySet};
use bevy_rapier3d::rapier::geometry::{ColliderSet, DefaultBroadPhase, NarrowPhase, Ray};

use super::lane::Lane;
use snakes_core::world::{Pose, Simulation};

/// A lane, with the bevy_rapier3d context that can hold a copy of its world.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct StagedWorld {
    entity: Entity,
    /// Lane whose world the context holds.
    pub lane: &'static Lane,
    context: &'static mut RapierContextSimulation,
    bodies: &'static mut RapierRigidBodySet,
    colliders: &'static mut RapierContextColliders,
    joints: &'static mut RapierContextJoints,
}

/// The first surface that a ray hits, on a lane.
pub(crate) struct RayHit<'w> {
    /// Entity of the lane that was hit.
    pub entity: Entity,
    /// Lane that was hit.
    pub lane: &'w Lane,
    /// Part of the snake that was hit; `None` for the stairs and the ground.
    pub part: Option<usize>,
    /// Distance of the hit along the ray, in metres.
    pub distance_m: f32,
}

impl<'w> StagedWorldItem<'w, '_> {
    /// Copies the lane's world after the last step into the context. A recording has no world; its drawn state is copied instead.
    pub fn hold_last_step(&mut self) {
        match self.lane.replay.simulation() {
            Some(simulation) => self.hold(simulation, simulation.poses()),
            None => self.hold_drawn(),
        };
    }

    /// Prepares the context for the lines of the collision shapes: the lane's world after the last step, or nothing for a
    /// ghost. The shapes of all snakes of a generation would hide the only one that is not a ghost.
    pub fn hold_for_lines(&mut self) {
        if !self.lane.is_ghost {
            return self.hold_last_step();
        }
        // A ray that was cast before has left a copy of the ghost's world.
        self.context.narrow_phase = NarrowPhase::default();
        self.joints.impulse_joints = ImpulseJointSet::default();
        self.bodies.bodies = RigidBodySet::default();
        self.colliders.colliders = ColliderSet::default();
    }

    /// Returns the first surface that a ray hits in the world as it is drawn.
    pub fn cast_ray(&mut self, ray: Ray3d) -> Option<RayHit<'w>> {
        let drawn = self.hold_drawn();
        let RapierContextSimulation { broad_phase, integration_parameters, .. } =
            &mut *self.context;
        *broad_phase = DefaultBroadPhase::default();
        for (handle, collider) in self.colliders.colliders.iter() {
            broad_phase.set_aabb(integration_parameters, handle, collider.compute_aabb());
        }
        let ray = Ray::new(ray.origin, *ray.direction);
        let (hit, distance_m) = RapierQueryPipeline::new_scoped(
            &self.context.broad_phase,
            &self.colliders,
            &self.bodies,
            &QueryFilter::default(),
            self.context.narrow_phase.query_dispatcher(),
            |queries| queries.query_pipeline.cast_ray(&ray, f32::MAX, true),
        )?;
        let body = self.colliders.colliders[hit].parent();
        let part = drawn.iter().position(|&part| Some(part) == body);
        Some(RayHit { entity: self.entity, lane: self.lane, part, distance_m })
    }

    /// Copies the world as it is drawn into the context, with the snake between two steps. Returns the bodies of the parts, head first.
    fn hold_drawn(&mut self) -> Vec<RigidBodyHandle> {
        let lane = self.lane;
        let plan = lane.trial().world_plan(&lane.staged.champion().genome);
        self.hold(&Simulation::new(&plan), lane.drawn_poses())
    }

    /// Copies a world into the context, with its parts in these poses, from head to tail, and returns the bodies of the parts.
    fn hold(
        &mut self,
        simulation: &Simulation,
        poses: impl Iterator<Item = Pose>,
    ) -> Vec<RigidBodyHandle> {
        let world = simulation.in_rapier();
        let physics = world.physics();
        self.context.narrow_phase = physics.narrow_phase.clone();
        self.joints.impulse_joints = physics.impulse_joints.clone();
        self.bodies.bodies = physics.bodies.clone();
        self.colliders.colliders = physics.colliders.clone();
        let (bodies, colliders) = (&mut self.bodies.bodies, &mut self.colliders.colliders);
        for (&part, pose) in world.bodies().iter().zip(poses) {
            bodies[part].set_position(pose, false);
        }
        let offset_m = self.lane.offset();
        let on_stage = |at: &Pose| Pose { translation: at.translation + offset_m, ..*at };
        for (_, body) in bodies.iter_mut() {
            body.set_position(on_stage(body.position()), false);
        }
        for (_, collider) in colliders.iter_mut() {
            collider.set_position(on_stage(collider.position()));
            // bevy_rapier3d reads the entity of each collider, and panics if there is none.
            collider.user_data = self.entity.to_bits().into();
        }
        // The colliders must be moved to their bodies, because only the bodies have these poses yet.
        bodies.propagate_modified_body_positions_to_colliders(colliders);
        world.bodies().to_vec()
    }
}
