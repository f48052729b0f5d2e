//! Contact patches: how fast a limb slips on a surface, how much of the friction it uses, how deep it dents the surface, and how much
//! power friction and surface damping take from the limb.
//!
//! All readings are computed from the state after a step, and do not change it.

use super::Simulation;
use crate::world::engine::{PartContact, PartContactPoint, PartState, Touching};
use crate::world::{TouchedSurface, Vector};

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

/// Returns the share of `part` in `whole`, at most 1; 0 if `whole` is not positive.
fn share(part: f32, whole: f32) -> f32 {
    if whole > 0.0 { (part / whole).min(1.0) } else { 0.0 }
}

impl Simulation {
    /// Returns the contact patches after the last step, the head's first. Patches between limbs are listed once.
    ///
    /// Forces are those of the last substep: see [`Self::contact_forces`]. Speeds are those with which the solver ended this substep,
    /// before damping.
    pub fn contact_patches(&self) -> Vec<ContactPatch> {
        let contacts = self.engine.contacts();
        let patches = contacts.iter().filter_map(|contact| self.patch(contact, &contacts));
        let mut patches: Vec<_> = patches.collect();
        patches.sort_by_key(|patch| patch.limb);
        patches
    }

    /// Returns the power that damping surfaces took from the limbs in the last step, in W.
    ///
    /// The power is computed for the second half of the step, in which damping has multiplied a limb's velocities by a factor f. With the
    /// kinetic energy E after the step, the loss is `E (1/f² - 1)`.
    pub fn surface_damping(&self) -> impl Iterator<Item = SurfaceDamping> + '_ {
        let half_step_s = self.plan.physics.step_s() / 2.0;
        let parts = self.parts().iter().zip(&self.body().parts).zip(&self.inertias_kg_m2);
        parts.filter_map(move |((part, plan), inertia)| {
            let (touched, factor) = self.damping.of_surfaces(&part.touch)?;
            let kept_j = part.kinetic_energy_j(plan.mass_kg(), *inertia);
            let power_w = kept_j * (1.0 / (factor * factor) - 1.0) / half_step_s;
            Some(SurfaceDamping { touched, power_w })
        })
    }

    /// Returns a part as the solver left it in the last substep. The solver's friction belongs to its velocities.
    ///
    /// At the end of a step air and surfaces slow the limbs. With the slowed velocities a contact that holds would seem to slip, and
    /// friction to drive it. Bounces, which are corrected after the solver, remain in the result.
    fn as_solved(&self, part: usize) -> PartState {
        let state = self.parts()[part];
        let factor = self.damping.of_surfaces(&state.touch).map_or(1.0, |(_, factor)| factor);
        let angular = state.angular / (factor * self.damping.air);
        PartState { linear: state.linear / factor, angular, ..state }
    }

    /// Returns the patch of a contact; `None` if nothing presses there.
    fn patch(&self, contact: &PartContact, all: &[PartContact]) -> Option<ContactPatch> {
        let PartContact { part, normal, friction, friction_ns, twist_nms, points, .. } = contact;
        let front = match contact.other {
            Touching::Part(front) => Some(front),
            Touching::Ground | Touching::Solid(_) => None,
        };
        let pressed_ns: f32 = points.iter().map(|point| point.impulse_ns).sum();
        if pressed_ns <= 0.0 {
            return None;
        }
        let [place, of_other] = self.frames(contact);
        let at_m = |point: &PartContactPoint| of_other * point.on_other;
        let middle_m = points.iter().map(at_m).sum::<Vector>() / points.len() as f32;
        let own = self.as_solved(*part);
        let other = front.map(|front| self.as_solved(front)).unwrap_or_default();
        let sliding = |at: Vector| {
            let relative = own.velocity_at(at) - other.velocity_at(at);
            relative - *normal * relative.dot(*normal)
        };
        let (mut slip_m_s, mut depth_m, mut lever_nms) = (0.0_f32, f32::NEG_INFINITY, 0.0);
        for point in points.iter().filter(|point| point.impulse_ns > 0.0) {
            let at = at_m(point);
            slip_m_s = slip_m_s.max(sliding(at).length());
            depth_m = depth_m.max((at - place * point.on_part).dot(*normal));
            lever_nms += point.impulse_ns * at.distance(middle_m);
        }
        let limb_of = |part: usize| self.body().parts[part].limb;
        let substep_s = self.plan.physics.substep_s();
        let spin_rad_s = (own.angular - other.angular).dot(*normal);
        let friction_j = -(friction_ns.dot(sliding(middle_m)) + twist_nms * spin_rad_s);
        let has_bounced = |part: usize| {
            let of_part = |of: &&PartContact| of.part == part || of.other == Touching::Part(part);
            all.iter().filter(of_part).any(|contact| contact.has_bounced)
        };
        let bounced = has_bounced(*part) || front.is_some_and(has_bounced);
        Some(ContactPatch {
            limb: limb_of(front.unwrap_or(*part)),
            touched: match contact.other {
                Touching::Ground => TouchedSurface::Ground,
                Touching::Solid(_) => TouchedSurface::Stairs,
                Touching::Part(_) => TouchedSurface::Limb(limb_of(*part)),
            },
            normal_n: pressed_ns / substep_s,
            friction_limit_n: friction * pressed_ns / substep_s,
            grip_share: share(friction_ns.length(), friction * pressed_ns)
                .max(share(twist_nms.abs(), friction * lever_nms)),
            slip_m_s,
            depth_m,
            friction_w: if bounced { 0.0 } else { friction_j / substep_s },
        })
    }
}
