//! Readings of a world: poses of the limbs, angles and rates of the joints, contacts.

use super::Simulation;
use crate::world::engine::{PartContact, PartState, Touching};
use crate::world::stair_profile::ClimbProgress;
use crate::world::turning::{product, turned};
use crate::world::{JointTorque, PartPlan, Pose, Vector};

/// Angles and angular velocities of a joint, as the snake senses them: of the child relative to the parent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointState {
    /// Bend about the parent's x axis, in radians.
    pub bend_rad: f32,
    /// Twist about the parent's y axis, in radians.
    pub twist_rad: f32,
    /// Angular velocity about the parent's x axis, in rad/s.
    pub bend_rad_s: f32,
    /// Angular velocity about the parent's y axis, in rad/s.
    pub twist_rad_s: f32,
}

/// A point of a contact, for drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenPoint {
    /// Points on the touched body and on the part, in the world, in metres.
    pub on_m: [Vector; 2],
    /// Unit vector along which the part is pushed.
    pub normal: Vector,
}

/// Force of the ground or the stairs on a limb at one point of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Index of the limb; the head is 0.
    pub limb: usize,
    /// Place of the point of contact in the world, in metres.
    pub at_m: Vector,
    /// Force on the limb, in N: the sum of normal force and friction.
    pub force_n: Vector,
}

impl Simulation {
    /// Returns the pose of each part's centre, head first, in metres.
    pub fn poses(&self) -> impl ExactSizeIterator<Item = Pose> + '_ {
        self.parts().iter().map(PartState::pose)
    }

    /// Returns the speed of each part's centre, head first, in m/s.
    pub fn speeds_m_s(&self) -> impl ExactSizeIterator<Item = f32> + '_ {
        self.parts().iter().map(|part| part.linear.length())
    }

    /// Returns the velocity of each part's centre in m/s, and the part's angular velocity in rad/s, both in the world, head first.
    pub fn velocities(&self) -> impl ExactSizeIterator<Item = [Vector; 2]> + '_ {
        self.parts().iter().map(|part| [part.linear, part.angular])
    }

    /// Returns the present progress of the middle part up the stairs.
    pub fn climb(&self) -> ClimbProgress {
        self.profile.climb(self.parts()[self.body().middle_part].at.to_array())
    }

    /// Returns the velocity of each limb's centre in m/s, and the limb's angular velocity in rad/s, both in the world, head first. For a
    /// soft limb, both are means over its parts.
    pub fn limb_velocities(&self) -> impl ExactSizeIterator<Item = [Vector; 2]> + '_ {
        let parts: Vec<_> = self.velocities().collect();
        (0..self.body().limbs()).map(move |limb| {
            let parts = &parts[self.body().parts_of(limb)];
            let sum = parts.iter().copied().reduce(|[a, b], [c, d]| [a + c, b + d]);
            sum.unwrap_or_default().map(|sum| sum / parts.len().max(1) as f32)
        })
    }

    /// Returns the angles and rates of the joints, in the order of the plan's joints. [`universal_joint`] defines the angles.
    pub fn joint_states(&self) -> impl ExactSizeIterator<Item = JointState> + '_ {
        self.body().joints.iter().map(|joint| {
            let [parent, child] = [joint.parent, joint.child].map(|part| &self.parts()[part]);
            let into_joint = joint.axes(parent.turn).inverse();
            let turn = product(into_joint, child.turn);
            let rate = turned(into_joint, child.angular - parent.angular);
            // A quaternion and its negative are the same rotation. The one with w ≥ 0 has the smaller angle.
            let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
            let angle_rad = |part: f32| 2.0 * libm::atan2f(sign * part, sign * turn.w);
            JointState {
                bend_rad: angle_rad(turn.x),
                twist_rad: angle_rad(turn.y),
                bend_rad_s: rate.x,
                twist_rad_s: rate.y,
            }
        })
    }

    /// Counts the limbs that touch the ground or the stairs.
    pub fn limbs_in_contact(&self) -> usize {
        let limbs = self.body().parts.chunk_by(|front, rear| front.limb == rear.limb);
        let mut parts = self.parts().iter();
        let touches = |limb: &&[PartPlan]| {
            // All parts of the limb are taken, also after one that touches.
            parts.by_ref().take(limb.len()).filter(|part| part.touch.any()).count() > 0
        };
        limbs.filter(touches).count()
    }

    /// Returns the indices of the parts that touch the stairs.
    pub fn parts_on_stairs(&self) -> impl Iterator<Item = usize> + '_ {
        let all = self.parts().iter().enumerate();
        all.filter(|(_, part)| part.touch.stairs).map(|(index, _)| index)
    }

    /// Returns the torques that acted in the last step, one per joint, clamped to the joints' limits.
    pub fn applied_torques(&self) -> impl ExactSizeIterator<Item = JointTorque> + '_ {
        self.applied.iter().map(|applied| applied.torque)
    }

    /// Returns the forces of the ground and the stairs on the limbs in the last substep of the last step. The head's contacts come first.
    /// All points of a contact share one friction impulse.
    pub fn contact_forces(&self) -> Vec<ContactForce> {
        let substep_s = self.plan.physics.substep_s();
        let mut forces = Vec::new();
        let contacts = self.engine.contacts().into_iter();
        for contact in contacts.filter(|contact| !matches!(contact.other, Touching::Part(_))) {
            let loaded = || contact.points.iter().filter(|point| point.impulse_ns > 0.0);
            let friction_ns = contact.friction_ns / loaded().count().max(1) as f32;
            forces.extend(loaded().map(|point| ContactForce {
                limb: self.body().parts[contact.part].limb,
                at_m: point.on_other,
                force_n: (contact.normal * point.impulse_ns + friction_ns) / substep_s,
            }));
        }
        forces
    }

    /// Returns the points of the contacts, if the narrow phase of [`Self::in_rapier`] does not hold them.
    pub fn contacts_beside_rapier(&self) -> Vec<SeenPoint> {
        if self.rapier().is_some() {
            return Vec::new();
        }
        let contacts = self.engine.contacts().into_iter();
        let points = contacts.flat_map(|contact| {
            let [place, of_other] = self.frames(&contact);
            contact.points.into_iter().map(move |point| SeenPoint {
                on_m: [of_other * point.on_other, place * point.on_part],
                normal: contact.normal,
            })
        });
        points.collect()
    }

    /// Returns the pose of a contact's part, and that of the frame in which its points on the other body are given.
    pub(super) fn frames(&self, contact: &PartContact) -> [Pose; 2] {
        let other = match contact.other {
            Touching::Part(front) => self.parts()[front].pose(),
            Touching::Ground | Touching::Solid(_) => Pose::IDENTITY,
        };
        [self.parts()[contact.part].pose(), other]
    }
}
