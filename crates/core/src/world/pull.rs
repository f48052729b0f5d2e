//! Pulling a part with the mouse: a damped spring between a point of the part and a point in space.

use super::Vector;
use super::engine::PartState;

/// A user's pull on a part of the snake. No trial contains pulls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pull {
    /// Index of the pulled part.
    pub part: usize,
    /// Point of the part at which the spring holds it, in the part's own frame, in metres from the part's centre.
    pub held_at_m: Vector,
    /// Target of the pull in the world, in metres.
    pub to_m: Vector,
}

/// Natural frequency of the part's mass on the spring, in rad/s. The part's weight stretches the spring by 0.1 m.
const FREQUENCY_RAD_S: f32 = 10.0;
/// Damping ratio of the spring.
const DAMPING_RATIO: f32 = 0.6;
/// Maximum damping per step, dimensionless. At a limb's end the effective mass is only a quarter of the limb's mass, so an explicit step
/// would overshoot from 0.5 on.
const MAX_DAMPING_PER_STEP: f32 = 0.4;
/// Maximum stretch of the spring, in metres, so that a jerk of the mouse does not tear the snake apart. The damping then limits the speed
/// to 12.5 m/s, and the force to fifteen times the part's weight, which lifts a whole snake.
const MAX_STRETCH_M: f32 = 1.5;

impl Pull {
    /// Sets the force of the spring on a part of this mass, and adds its torque.
    pub(super) fn act_on(&self, part: &mut PartState, mass_kg: f32, step_s: f32) {
        let point = part.pose() * self.held_at_m;
        let stretch = (self.to_m - point).clamp_length_max(MAX_STRETCH_M);
        let velocity = part.velocity_at(point);
        let damping_per_s =
            (2.0 * DAMPING_RATIO * FREQUENCY_RAD_S).min(MAX_DAMPING_PER_STEP / step_s);
        let acceleration = stretch * (FREQUENCY_RAD_S * FREQUENCY_RAD_S) - velocity * damping_per_s;
        part.force_n = acceleration * mass_kg;
        part.torque_nm += (point - part.at).cross(part.force_n);
    }
}
