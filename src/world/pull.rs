//! A hand in the world: a damped spring between a point of a limb and a point in space.

use rapier3d::prelude::RigidBody;

use super::Vector;

/// What pulls a limb beside its joints. It is no part of any trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pull {
    /// The limb; the head is 0.
    pub limb: usize,
    /// Where the spring holds it, in the limb's own frame, in metres from its centre.
    pub held_at_m: Vector,
    /// To where it is pulled, in metres.
    pub to_m: Vector,
}

/// Natural frequency of the limb's mass on the spring, in rad/s. Its weight stretches the spring by 0.1 m.
const FREQUENCY_RAD_S: f32 = 10.0;
/// Damping ratio.
const DAMPING_RATIO: f32 = 0.6;
/// The most damping for each step. At a limb's end a quarter of its mass resists, so that from 0.5 on an explicit
/// step would overshoot.
const STABLE: f32 = 0.4;
/// The spring is stretched no further than this, in metres: a jerk of the mouse must not tear the snake apart.
const LONGEST_M: f32 = 4.0;

impl Pull {
    /// The force, in N, and the point on which it acts, in metres.
    pub(super) fn force_on(&self, body: &RigidBody, step_s: f32) -> (Vector, Vector) {
        let point = *body.position() * self.held_at_m;
        let stretch = (self.to_m - point).clamp_length_max(LONGEST_M);
        let velocity = body.velocity_at_point(point);
        let damping_per_s = (2.0 * DAMPING_RATIO * FREQUENCY_RAD_S).min(STABLE / step_s);
        let acceleration = stretch * (FREQUENCY_RAD_S * FREQUENCY_RAD_S) - velocity * damping_per_s;
        (acceleration * body.mass(), point)
    }
}
