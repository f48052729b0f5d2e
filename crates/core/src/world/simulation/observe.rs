//! Readings of a world: poses of the limbs, angles and rates of the joints, contacts.

use rapier3d::prelude::*;

use super::Simulation;
use super::patches::solved_points;
use crate::world::contact::other_collider;
use crate::world::lanes::Touching;
use crate::world::{JointTorque, TouchedSurface};

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
        self.parts.iter().map(|&limb| *self.physics.bodies[limb].position())
    }

    /// Returns the speed of each part's centre, head first, in m/s.
    pub fn speeds_m_s(&self) -> impl ExactSizeIterator<Item = f32> + '_ {
        self.parts.iter().map(|&limb| self.physics.bodies[limb].linvel().length())
    }

    /// Returns the velocity of each part's centre in m/s, and the part's angular velocity in rad/s, both in the world, head first.
    pub fn velocities(&self) -> impl ExactSizeIterator<Item = [Vector; 2]> + '_ {
        self.parts.iter().map(|&limb| {
            let body = &self.physics.bodies[limb];
            [body.linvel(), body.angvel()]
        })
    }

    /// Returns the velocity of each limb's centre in m/s, and the limb's angular velocity in rad/s, both in the world, head first. For a
    /// soft limb, both are means over its parts.
    pub fn limb_velocities(&self) -> impl ExactSizeIterator<Item = [Vector; 2]> + '_ {
        let parts: Vec<_> = self.velocities().collect();
        (0..self.body.limbs()).map(move |limb| {
            let parts = &parts[self.body.parts_of(limb)];
            let sum = parts.iter().copied().reduce(|[a, b], [c, d]| [a + c, b + d]);
            sum.unwrap_or_default().map(|sum| sum / parts.len().max(1) as f32)
        })
    }

    /// Returns the angles and rates of the joints, in the order of the plan's joints. [`universal_joint`] defines the angles.
    pub fn joint_states(&self) -> impl ExactSizeIterator<Item = JointState> + '_ {
        self.body.joints.iter().map(|joint| {
            let [parent, child] =
                [joint.parent, joint.child].map(|limb| &self.physics.bodies[self.parts[limb]]);
            let into_joint = self.joint_axes(joint, *parent.rotation()).inverse();
            let turn = self.product(into_joint, *child.rotation());
            let rate = self.turned(into_joint, child.angvel() - parent.angvel());
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
        let touches = |&&part: &&RigidBodyHandle| self.world_touched_by(part).next().is_some();
        if self.body.springs.is_empty() {
            return self.parts.iter().filter(touches).count();
        }
        let limbs = self.body.parts.chunk_by(|front, rear| front.limb == rear.limb);
        let mut parts = self.parts.iter();
        limbs.filter(|limb| parts.by_ref().take(limb.len()).filter(touches).count() > 0).count()
    }

    /// Returns the indices of the parts that touch the stairs.
    pub fn parts_on_stairs(&self) -> impl Iterator<Item = usize> + '_ {
        let touches = |part: &RigidBodyHandle| {
            self.world_touched_by(*part).any(|touched| touched == TouchedSurface::Stairs)
        };
        let all = self.parts.iter().enumerate();
        all.filter(move |(_, part)| touches(part)).map(|(index, _)| index)
    }

    /// Returns the torques that acted in the last step, one per joint, clamped to the joints' limits.
    pub fn applied_torques(&self) -> impl ExactSizeIterator<Item = JointTorque> + '_ {
        self.applied.iter().map(|applied| applied.torque)
    }

    /// Returns the forces of the ground and the stairs on the limbs in the last substep of the last step. The head's contacts come first.
    ///
    /// The engine's warm-start impulses are those of the last substep. The engine also keeps sums, but these begin with the step before.
    /// All points of a manifold share one friction impulse.
    pub fn contact_forces(&self) -> Vec<ContactForce> {
        let substep_s = self.substep_s();
        if self.lanes.is_some() {
            return self.contact_forces_in_lanes(substep_s);
        }
        let mut forces = Vec::new();
        for (part, &body) in self.body.parts.iter().zip(&self.parts) {
            let collider = self.physics.bodies[body].colliders()[0];
            for pair in self.physics.narrow_phase.contact_pairs_with(collider) {
                if !self.is_world(other_collider(pair, collider)) {
                    continue;
                }
                let first = self.physics.colliders[pair.collider1].position();
                // The normal points from the first collider to the second; the tangent impulse acts on the first.
                let side = if pair.collider1 == collider { -1.0 } else { 1.0 };
                for manifold in pair.solver_manifolds() {
                    let loaded = || {
                        solved_points(manifold).filter(|point| point.data.warmstart_impulse > 0.0)
                    };
                    let shared_by = loaded().count() as f32;
                    for point in loaded() {
                        let friction = point.data.warmstart_tangent_world / shared_by;
                        let impulse =
                            manifold.data.normal * point.data.warmstart_impulse - friction;
                        forces.push(ContactForce {
                            limb: part.limb,
                            at_m: *first * point.local_p1,
                            force_n: impulse * (side / substep_s),
                        });
                    }
                }
            }
        }
        forces
    }

    fn contact_forces_in_lanes(&self, substep_s: f32) -> Vec<ContactForce> {
        let mut forces = Vec::new();
        let contacts = self.lanes_contacts().iter();
        for contact in contacts.filter(|contact| !matches!(contact.other, Touching::Part(_))) {
            let loaded = || contact.points().iter().filter(|point| point.impulse_ns > 0.0);
            let friction_ns = contact.friction_ns / loaded().count().max(1) as f32;
            forces.extend(loaded().map(|point| ContactForce {
                limb: self.body.parts[contact.part].limb,
                at_m: point.on_other,
                force_n: (contact.normal * point.impulse_ns + friction_ns) / substep_s,
            }));
        }
        forces
    }

    /// Returns the length of a solver's substep, in s.
    pub(super) fn substep_s(&self) -> f32 {
        self.physics.integration_parameters.dt / self.contacts.substeps.max(1) as f32
    }

    /// Returns whether a collider is the ground or the stairs.
    pub(super) fn is_world(&self, collider: ColliderHandle) -> bool {
        collider == self.contacts.ground || self.physics.colliders[collider].parent().is_none()
    }
}
