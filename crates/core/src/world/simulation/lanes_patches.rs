//! Contact patches of the engine *lanes*.

use rapier3d::prelude::*;

use super::Simulation;
use super::patches::{ContactPatch, TouchedSurface, share};
use crate::world::lanes::{Chain, Contact, ContactPoint, Touching};

impl Simulation {
    /// Returns the surface that a contact of the engine *lanes* touches. For a contact of two parts, it is the limb of the rear part.
    pub(super) fn touched_in_lanes(&self, contact: &Contact) -> TouchedSurface {
        match contact.other {
            Touching::Ground => TouchedSurface::Ground,
            Touching::Solid(_) => TouchedSurface::Stairs,
            Touching::Part(_) => TouchedSurface::Limb(self.body.parts[contact.part].limb),
        }
    }

    /// Returns the patch of a contact of the engine *lanes*; `None` if nothing presses there.
    pub(super) fn patch_in_lanes(&self, contact: &Contact) -> Option<ContactPatch> {
        let place = |part: usize| *self.physics.bodies[self.parts[part]].position();
        let (own_place, own) =
            (place(contact.part), self.solved_velocity(self.parts[contact.part]));
        let (front, front_place, of_front) = match contact.other {
            Touching::Part(front) => {
                (Some(front), place(front), self.solved_velocity(self.parts[front]))
            }
            Touching::Ground | Touching::Solid(_) => (None, Pose::IDENTITY, Default::default()),
        };
        let points = contact.points();
        let pressed_ns: f32 = points.iter().map(|point| point.impulse_ns).sum();
        if pressed_ns <= 0.0 {
            return None;
        }
        let at_m = |point: &ContactPoint| front_place * point.on_other;
        let middle_m = points.iter().map(at_m).sum::<Vector>() / points.len() as f32;
        let sliding = |at: Vector| {
            let relative = own.at(at) - of_front.at(at);
            relative - contact.normal * relative.dot(contact.normal)
        };
        let (mut slip_m_s, mut depth_m, mut lever_nms) = (0.0_f32, f32::NEG_INFINITY, 0.0);
        for point in points.iter().filter(|point| point.impulse_ns > 0.0) {
            let at = at_m(point);
            slip_m_s = slip_m_s.max(sliding(at).length());
            depth_m = depth_m.max((at - own_place * point.on_part).dot(contact.normal));
            lever_nms += point.impulse_ns * at.distance(middle_m);
        }
        let touched = self.touched_in_lanes(contact);
        let friction = contact.material_friction;
        let substep_s = self.substep_s();
        let spin_rad_s = (own.angular_rad_s() - of_front.angular_rad_s()).dot(contact.normal);
        let friction_j =
            -(contact.friction_ns.dot(sliding(middle_m)) + contact.twist_nms * spin_rad_s);
        let has_bounced = self.has_bounced_in_lanes(contact.part)
            || front.is_some_and(|front| self.has_bounced_in_lanes(front));
        Some(ContactPatch {
            limb: self.body.parts[front.unwrap_or(contact.part)].limb,
            touched,
            normal_n: pressed_ns / substep_s,
            friction_limit_n: friction * pressed_ns / substep_s,
            grip_share: share(contact.friction_ns.length(), friction * pressed_ns)
                .max(share(contact.twist_nms.abs(), friction * lever_nms)),
            slip_m_s,
            depth_m,
            friction_w: if has_bounced { 0.0 } else { friction_j / substep_s },
        })
    }

    /// Returns whether a part has bounced in the last step.
    fn has_bounced_in_lanes(&self, part: usize) -> bool {
        let of_part =
            |contact: &&Contact| contact.part == part || contact.other == Touching::Part(part);
        self.lanes_contacts().iter().filter(of_part).any(Chain::bounces)
    }
}
