//! Factors by which air and surfaces slow the limbs. They have the same effect at every step rate.
//!
//! A velocity that decays at a rate d loses the factor `exp(-d h)` in a step of length h. Half of the decay acts before the engine's step
//! and half after it (Strang's splitting, SIAM J. Numer. Anal. 5, 1968), so that the final velocity under a constant force agrees with
//! `force / (d · mass)` up to `(d h)² / 24`. The engine's own damping instead divides by `1 + d h` at the end of a step. Its rate of decay
//! and its final velocity both depend on the length of the step.

use super::engine::{Touch, TouchedSurface};

/// Factors by which velocities shrink in half a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HalfStepDamping {
    /// Factor of the air on a limb's angular velocity.
    pub air: f32,
    /// Factor of the stairs on the linear and angular velocity of a limb that touches them.
    pub stairs: f32,
    /// Factor of the ground on the linear and angular velocity of a limb that touches it.
    pub ground: f32,
}

impl HalfStepDamping {
    /// Returns whether nothing slows the limbs.
    pub fn is_none(&self) -> bool {
        self.air == 1.0 && self.stairs >= 1.0 && self.ground >= 1.0
    }

    /// Returns the surface that slows a part most of those that it touches, and its factor; `None` if none of them damps.
    pub fn of_surfaces(&self, touch: &Touch) -> Option<(TouchedSurface, f32)> {
        let ground = (touch.ground && self.ground < 1.0).then_some(self.ground);
        let stairs = (touch.stairs && self.stairs < 1.0).then_some(self.stairs);
        match (ground, stairs) {
            (Some(ground), stairs) if stairs.is_none_or(|stairs| ground < stairs) => {
                Some((TouchedSurface::Ground, ground))
            }
            (_, stairs) => Some((TouchedSurface::Stairs, stairs?)),
        }
    }

    /// Computes the factors for these rates, in 1/s, and steps of `step_s` seconds.
    pub fn of_rates(air_per_s: f32, stairs_per_s: f32, ground_per_s: f32, step_s: f32) -> Self {
        let factor = |rate_per_s: f32| libm::expf(-rate_per_s * step_s / 2.0);
        Self { air: factor(air_per_s), stairs: factor(stairs_per_s), ground: factor(ground_per_s) }
    }
}
