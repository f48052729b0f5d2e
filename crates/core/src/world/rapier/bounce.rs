//! Corrects the bounce of a limb that lands on a whole face.
//!
//! Rapier applies restitution once, corner after corner, at the end of a step. Each corner disturbs the
//! result of the corner before, so a block that lands flat leaves a tenth too slow, and spinning.
//! Repeating the restitution over the same corners makes them agree.

use rapier3d::geometry::{ContactPair, NEW_CONTACT_BIT};
use rapier3d::prelude::*;

use crate::world::contact::other_collider;
use crate::world::engine::PartState;

/// A corner of a limb that bounces in this step.
struct BouncingCorner {
    /// Vector from the limb's centre to the corner, in m.
    lever: Vector,
    /// Unit vector along which the surface pushes the limb.
    direction: Vector,
    /// Required speed of the corner after the bounce, in m/s.
    leaving_m_s: f32,
    /// Total impulse on the corner in this step so far, in N·s. It never becomes negative, because a surface does not pull.
    impulse_ns: f32,
}

/// Number of passes over the corners. After ten passes, the speeds of a block's four corners agree to a thousandth.
const ROUNDS: u32 = 16;

/// Repeats the engine's restitution of a limb's contacts with the world until all corners agree.
pub(super) fn finish_bounce(physics: &mut PhysicsWorld, limb: RigidBodyHandle, before: &PartState) {
    let body = &physics.bodies[limb];
    let collider = body.colliders()[0];
    let pose = *body.position();
    let corners = physics.narrow_phase.contact_pairs_with(collider).flat_map(|pair| {
        let is_first = pair.collider1 == collider;
        let owner = physics.colliders[other_collider(pair, collider)].parent();
        let is_world = owner.is_none_or(|owner| physics.bodies[owner].mass() == 0.0);
        let pair = is_world.then_some(pair);
        pair.into_iter().flat_map(move |pair| bouncing(pair, is_first, pose, *before))
    });
    let mut corners: Vec<BouncingCorner> = corners.collect();
    if corners.is_empty() {
        return;
    }
    let inverse_mass = 1.0 / body.mass();
    let inverse_inertia = body.mass_properties().effective_world_inv_inertia;
    let (mut linear, mut angular) = (body.linvel(), body.angvel());
    for _ in 0..ROUNDS {
        for corner in &mut corners {
            let turn = inverse_inertia * corner.lever.cross(corner.direction);
            let speed_m_s = (linear + angular.cross(corner.lever)).dot(corner.direction);
            let inverse_effective = inverse_mass + turn.cross(corner.lever).dot(corner.direction);
            let wanted = corner.impulse_ns + (corner.leaving_m_s - speed_m_s) / inverse_effective;
            let change = wanted.max(0.0) - corner.impulse_ns;
            corner.impulse_ns += change;
            linear += corner.direction * (change * inverse_mass);
            angular += turn * change;
        }
    }
    let body = &mut physics.bodies[limb];
    body.set_linvel(linear, false);
    body.set_angvel(angular, false);
}

/// Returns the corners of a contact pair to which the engine has just applied restitution.
fn bouncing(
    pair: &ContactPair,
    limb_is_first: bool,
    pose: Pose,
    before: PartState,
) -> impl Iterator<Item = BouncingCorner> + '_ {
    pair.solver_manifolds().iter().filter(|manifold| manifold.data.restitution > 0.0).flat_map(
        move |manifold| {
            // The engine's normal points from the first body to the second.
            let direction =
                if limb_is_first { -manifold.data.normal } else { manifold.data.normal };
            manifold.data.solver_contacts.iter().filter_map(move |contact| {
                let id = contact.contact_id[0];
                let point = manifold.points.get((id & !NEW_CONTACT_BIT) as usize)?;
                let at = if limb_is_first { point.local_p1 } else { point.local_p2 };
                let lever = pose.rotation * at;
                let coming_m_s = -(before.linear + before.angular.cross(lever)).dot(direction);
                let bounces =
                    id & NEW_CONTACT_BIT != 0 && point.data.impulse > 0.0 && coming_m_s > 0.0;
                bounces.then_some(BouncingCorner {
                    lever,
                    direction,
                    leaving_m_s: manifold.data.restitution * coming_m_s,
                    impulse_ns: point.data.impulse,
                })
            })
        },
    )
}
