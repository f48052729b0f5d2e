//! What can be seen of a world: where the limbs are, how the joints stand, what touches.

use rapier3d::prelude::*;

use super::{JointTorque, Simulation};

/// How a joint stands, as the snake feels it: the rear limb as seen from the front limb.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointState {
    /// Bend about the front limb's x axis, in radians.
    pub bend_rad: f32,
    /// Twist about the front limb's y axis, in radians.
    pub twist_rad: f32,
    /// Rate of turn about the front limb's x axis, in rad/s.
    pub bend_rad_s: f32,
    /// Rate of turn about the front limb's y axis, in rad/s.
    pub twist_rad_s: f32,
}

/// What the ground or the stairs do to a limb in one point of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// The limb; the head is 0.
    pub limb: usize,
    /// Where, in metres.
    pub at_m: Vector,
    /// The force on the limb, in N: what carries it, and the friction.
    pub force_n: Vector,
}

impl Simulation {
    /// The pose of each limb's centre, head first.
    pub fn poses(&self) -> impl ExactSizeIterator<Item = Pose> + '_ {
        self.limbs.iter().map(|&limb| *self.physics.bodies[limb].position())
    }

    /// How fast each limb's centre is, head first, in m/s.
    pub fn speeds_m_s(&self) -> impl ExactSizeIterator<Item = f32> + '_ {
        self.limbs.iter().map(|&limb| self.physics.bodies[limb].linvel().length())
    }

    /// How each joint stands, from the head: see [`universal_joint`] for what its angles are.
    pub fn joint_states(&self) -> impl ExactSizeIterator<Item = JointState> + '_ {
        self.limbs.windows(2).map(|pair| {
            let [front, rear] = [pair[0], pair[1]].map(|limb| &self.physics.bodies[limb]);
            let into_front = front.rotation().inverse();
            let turn = into_front * *rear.rotation();
            let rate = into_front * (rear.angvel() - front.angvel());
            // A rotation and its negative are the same; the one with w ≥ 0 is the short way round.
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

    /// How many limbs touch the ground or the stairs.
    pub fn limbs_in_contact(&self) -> usize {
        let touches = |&&limb: &&RigidBodyHandle| {
            let collider = self.physics.bodies[limb].colliders()[0];
            self.physics.narrow_phase.contact_pairs_with(collider).any(|pair| {
                let other =
                    if pair.collider1 == collider { pair.collider2 } else { pair.collider1 };
                self.is_world(other) && pair.has_any_active_contact()
            })
        };
        self.limbs.iter().filter(touches).count()
    }

    /// The torques that acted in the last step, clamped to the joints' limits, one per joint from the head.
    pub fn applied_torques(&self) -> impl ExactSizeIterator<Item = JointTorque> + '_ {
        self.applied.iter().map(|(_, torque)| *torque)
    }

    /// Greatest torques of a joint, about its bend and its twist axis.
    pub fn torque_limits(&self, joint: usize) -> Option<JointTorque> {
        self.joints.get(joint).map(|plan| JointTorque {
            bend_nm: plan.max_bend_torque_nm,
            twist_nm: plan.max_twist_torque_nm,
        })
    }

    /// What the ground and the stairs did to the limbs in the last substep of the last step, the head's contacts
    /// first.
    ///
    /// The engine's impulses that remain for a warm start are those of the last substep; the sums that it keeps
    /// beside them begin with the step before. Its friction is one for all points of a manifold.
    pub fn contact_forces(&self) -> Vec<ContactForce> {
        let substep_s =
            self.physics.integration_parameters.dt / self.contacts.substeps.max(1) as f32;
        let mut forces = Vec::new();
        for (limb, &body) in self.limbs.iter().enumerate() {
            let collider = self.physics.bodies[body].colliders()[0];
            for pair in self.physics.narrow_phase.contact_pairs_with(collider) {
                let is_first = pair.collider1 == collider;
                if !self.is_world(if is_first { pair.collider2 } else { pair.collider1 }) {
                    continue;
                }
                let first = self.physics.colliders[pair.collider1].position();
                // The normal points from the first to the second; the tangent impulse is the first's.
                let side = if is_first { -1.0 } else { 1.0 };
                for manifold in &pair.manifolds {
                    let carries =
                        |point: &&TrackedContact<ContactData>| point.data.warmstart_impulse > 0.0;
                    let shared_by = manifold.points.iter().filter(carries).count() as f32;
                    for point in manifold.points.iter().filter(carries) {
                        let friction = point.data.warmstart_tangent_world / shared_by;
                        let impulse =
                            manifold.data.normal * point.data.warmstart_impulse - friction;
                        forces.push(ContactForce {
                            limb,
                            at_m: *first * point.local_p1,
                            force_n: impulse * (side / substep_s),
                        });
                    }
                }
            }
        }
        forces
    }

    /// Whether a collider is the ground or the stairs.
    fn is_world(&self, collider: ColliderHandle) -> bool {
        collider == self.contacts.ground || self.physics.colliders[collider].parent().is_none()
    }
}
