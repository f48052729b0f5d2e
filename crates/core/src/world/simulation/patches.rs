//! Contact patches: how fast a limb slips on a surface, how much of the friction it uses, how deep it dents the surface, and how much
//! power friction and surface damping take from the limb.
//!
//! All readings are computed from the state after a step, and do not change it.

use rapier3d::geometry::NEW_CONTACT_BIT;
use rapier3d::prelude::*;

use super::Simulation;
use crate::world::contact::other_collider;

/// A surface that a limb touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TouchedSurface {
    /// A step of the stairs.
    Stairs,
    /// The ground.
    Ground,
    /// Another limb, with this index.
    Limb(usize),
}

/// Contact of a limb with one surface, on which the limb presses: up to four points, which share one friction force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPatch {
    /// Index of the limb; the head is 0. Where two limbs touch, it is the limb nearer to the head.
    pub limb: usize,
    /// The surface that the limb touches.
    pub touched: TouchedSurface,
    /// Normal force N in the last substep, in newtons: the sum over the points.
    pub normal_n: f32,
    /// Greatest tangential force that friction could give, in N: friction coefficient μ times N.
    pub friction_limit_n: f32,
    /// Share of the friction that is used, from 0 to 1; at 1 the patch slides. By Coulomb's law it is `|F| / (μ N)` for the tangential
    /// force F. The engine also limits the torque T with which a patch resists being turned on the spot, to `μ Σ N_i d_i`, where `d_i` is
    /// the distance of a point from the patch's centre. The larger of both shares counts. 0 where there is no friction.
    pub grip_share: f32,
    /// Largest speed of a loaded point along the surface, relative to the surface, in m/s.
    pub slip_m_s: f32,
    /// Depth to which the deepest loaded point has sunk in, in metres. It is negative while the engine stops a hard contact just before
    /// the surfaces touch.
    pub depth_m: f32,
    /// Power that friction turns into heat in the last substep, in W: `-(F · v + T ω)` for the force F and the torque T of the last
    /// substep, the velocity v of the patch along the surface, and the rate ω at which the patch turns on the surface. 0 where a limb has
    /// bounced in this step, because a bounce changes the velocities after friction has acted.
    pub friction_w: f32,
}

/// Power that the damping of a surface takes from a limb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceDamping {
    /// The surface that damps the limb.
    pub touched: TouchedSurface,
    /// Kinetic energy that the limb lost by damping in the second half of the last step, divided by half the step, in W.
    pub power_w: f32,
}

/// Velocity of a limb as the solver left it; 0 for the fixed world.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SolvedVelocity {
    centre_m: Vector,
    /// Linear velocity of the limb's centre, in m/s.
    linear: Vector,
    /// Angular velocity of the limb, in rad/s.
    angular: Vector,
}

impl SolvedVelocity {
    /// Returns the angular velocity, in rad/s.
    pub(super) fn angular_rad_s(&self) -> Vector {
        self.angular
    }

    /// Returns the velocity of the limb's material point at a place in the world, in m/s.
    pub(super) fn at(&self, at_m: Vector) -> Vector {
        self.linear + self.angular.cross(at_m - self.centre_m)
    }
}

/// Returns the points of a manifold that the solver has just solved. A manifold also holds points that are near but do not touch, with the
/// impulses of their last touch.
pub(super) fn solved_points(
    manifold: &ContactManifold,
) -> impl Iterator<Item = &TrackedContact<ContactData>> {
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

/// Returns the share of `part` in `whole`, at most 1; 0 if `whole` is not positive.
pub(super) fn share(part: f32, whole: f32) -> f32 {
    if whole > 0.0 { (part / whole).min(1.0) } else { 0.0 }
}

impl Simulation {
    /// Returns the contact patches after the last step, the head's first. Patches between limbs are listed once.
    ///
    /// Forces are those of the last substep: see [`Self::contact_forces`]. Speeds are those with which the solver ended this substep,
    /// before damping.
    pub fn contact_patches(&self) -> Vec<ContactPatch> {
        if self.lanes.is_some() {
            let contacts = self.lanes_contacts().iter();
            let mut patches: Vec<_> = contacts.filter_map(|of| self.patch_in_lanes(of)).collect();
            patches.sort_by_key(|patch| patch.limb);
            return patches;
        }
        let mut patches = Vec::new();
        for (part, &body) in self.body.parts.iter().zip(&self.parts) {
            let limb = part.limb;
            let collider = self.physics.bodies[body].colliders()[0];
            for pair in self.physics.narrow_phase.contact_pairs_with(collider) {
                let touched = self.touched(other_collider(pair, collider));
                if matches!(touched, TouchedSurface::Limb(other) if other < limb) {
                    continue;
                }
                let manifolds = pair.solver_manifolds().iter();
                patches.extend(manifolds.filter_map(|of| self.patch(pair, of, limb, touched)));
            }
        }
        patches
    }

    /// Returns the power that damping surfaces took from the limbs in the last step, in W.
    ///
    /// The power is computed for the second half of the step, in which damping has multiplied a limb's velocities by a factor f. With the
    /// kinetic energy E after the step, the loss is `E (1/f² - 1)`.
    pub fn surface_damping(&self) -> impl Iterator<Item = SurfaceDamping> + '_ {
        let half_step_s = self.physics.integration_parameters.dt / 2.0;
        self.parts.iter().filter_map(move |&limb| {
            let (touched, _) = self.strongest_damping(limb)?;
            let factor = self.surface_factor(limb);
            let kept_j = self.physics.bodies[limb].kinetic_energy();
            let power_w = kept_j * (1.0 / (factor * factor) - 1.0) / half_step_s;
            Some(SurfaceDamping { touched, power_w })
        })
    }

    /// Returns the surface with the strongest damping of those that a limb touches, and its damping, in 1/s; `None` if none of them damps.
    pub(super) fn strongest_damping(&self, limb: RigidBodyHandle) -> Option<(TouchedSurface, f32)> {
        let laws = &self.contacts.laws;
        self.world_touched_by(limb)
            .map(|touched| match touched {
                TouchedSurface::Ground => (TouchedSurface::Ground, laws.ground.dampen_per_s),
                _ => (TouchedSurface::Stairs, laws.stairs.dampen_per_s),
            })
            .filter(|(_, dampen_per_s)| *dampen_per_s > 0.0)
            .max_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// Returns the ground and the stairs, once for each of a part's contacts with them.
    pub(super) fn world_touched_by(
        &self,
        limb: RigidBodyHandle,
    ) -> impl Iterator<Item = TouchedSurface> + '_ {
        let collider = self.physics.bodies[limb].colliders()[0];
        let pairs = self.physics.narrow_phase.contact_pairs_with(collider);
        let in_rapier = pairs
            .filter(|pair| pair.has_any_active_contact())
            .map(move |pair| self.touched(other_collider(pair, collider)));
        let contacts = self.lanes_contacts().iter();
        let in_lanes = contacts
            .filter(move |contact| self.parts.get(contact.part) == Some(&limb))
            .map(|contact| self.touched_in_lanes(contact));
        in_rapier.chain(in_lanes).filter(|touched| !matches!(touched, TouchedSurface::Limb(_)))
    }

    /// Returns the velocity of a limb as the solver left it in the last substep. The solver's friction belongs to this velocity.
    ///
    /// At the end of a step air and surfaces slow the limbs. With the slowed velocities a contact that holds would seem to slip, and
    /// friction to drive it. Bounces, which are corrected after the solver, remain in the result.
    pub(super) fn solved_velocity(&self, limb: RigidBodyHandle) -> SolvedVelocity {
        let body = &self.physics.bodies[limb];
        let [linear, angular] = self.last_damping(limb);
        SolvedVelocity {
            centre_m: body.center_of_mass(),
            linear: body.linvel() / linear,
            angular: body.angvel() / angular,
        }
    }

    /// Returns whether a limb has bounced in the last step; false for `None`.
    fn has_bounced(&self, limb: Option<RigidBodyHandle>) -> bool {
        let Some(limb) = limb.filter(|_| self.contacts.bounces) else { return false };
        let collider = self.physics.bodies[limb].colliders()[0];
        let touching = self.physics.narrow_phase.contact_pairs_with(collider);
        let mut manifolds = touching.flat_map(|pair| pair.solver_manifolds());
        manifolds.any(|manifold| manifold.data.restitution > 0.0 && has_new_impulse(manifold))
    }

    /// Returns the surface to which a collider belongs.
    fn touched(&self, collider: ColliderHandle) -> TouchedSurface {
        if collider == self.contacts.ground {
            return TouchedSurface::Ground;
        }
        let parent = self.physics.colliders[collider].parent();
        let part = self.parts.iter().position(|&part| Some(part) == parent);
        part.map_or(TouchedSurface::Stairs, |part| TouchedSurface::Limb(self.body.parts[part].limb))
    }

    /// Returns the patch of a manifold; `None` if nothing presses there.
    fn patch(
        &self,
        pair: &ContactPair,
        manifold: &ContactManifold,
        limb: usize,
        touched: TouchedSurface,
    ) -> Option<ContactPatch> {
        let colliders =
            [pair.collider1, pair.collider2].map(|handle| &self.physics.colliders[handle]);
        let [first, second] = colliders.map(|collider| {
            let solved = collider.parent().map(|limb| self.solved_velocity(limb));
            (collider.position(), solved.unwrap_or_default())
        });
        let has_bounced = colliders.iter().any(|collider| self.has_bounced(collider.parent()));

        let at_m = |point: &TrackedContact<ContactData>| *first.0 * point.local_p1;
        let (mut count, mut centre_m, mut pressed_ns) = (0.0, Vector::ZERO, 0.0);
        let (mut friction_ns, mut twist_nms) = (Vector::ZERO, 0.0);
        for point in solved_points(manifold) {
            count += 1.0;
            centre_m += at_m(point);
            pressed_ns += point.data.warmstart_impulse;
            // Each point holds the friction of the whole patch, which acts on the first body.
            friction_ns = point.data.warmstart_tangent_world;
            twist_nms = point.data.warmstart_twist_impulse;
        }
        if pressed_ns <= 0.0 {
            return None;
        }
        centre_m /= count;
        // The manifold's normal points from the first body to the second.
        let normal = manifold.data.normal;
        let sliding = |at: Vector| {
            let relative = first.1.at(at) - second.1.at(at);
            relative - normal * relative.dot(normal)
        };
        let (mut slip_m_s, mut depth_m, mut lever_nms) = (0.0_f32, f32::NEG_INFINITY, 0.0);
        for point in solved_points(manifold).filter(|point| point.data.warmstart_impulse > 0.0) {
            let at = at_m(point);
            slip_m_s = slip_m_s.max(sliding(at).length());
            depth_m = depth_m.max((at - *second.0 * point.local_p2).dot(normal));
            lever_nms += point.data.warmstart_impulse * at.distance(centre_m);
        }
        // The engine's own factor may be lower in this step where a surface creeps, but the share is relative to the materials' friction.
        let friction = colliders[0].friction() * colliders[1].friction();
        let substep_s = self.substep_s();
        let spin_rad_s = (first.1.angular - second.1.angular).dot(normal);
        // The twist acts on the first body about the opposite of the normal.
        let friction_j = twist_nms * spin_rad_s - friction_ns.dot(sliding(centre_m));
        Some(ContactPatch {
            limb,
            touched,
            normal_n: pressed_ns / substep_s,
            friction_limit_n: friction * pressed_ns / substep_s,
            grip_share: share(friction_ns.length(), friction * pressed_ns)
                .max(share(twist_nms.abs(), friction * lever_nms)),
            slip_m_s,
            depth_m,
            friction_w: if has_bounced { 0.0 } else { friction_j / substep_s },
        })
    }
}
