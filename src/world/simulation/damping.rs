//! Damping of the limbs by the air and by surfaces, with the same effect at every step rate.
//!
//! A velocity that decays at a rate d loses the factor `exp(-d h)` in a step of length h. Half of it acts before the
//! engine's step and half after it (Strang's splitting, SIAM J. Numer. Anal. 5, 1968), so that the final velocity under a
//! constant force agrees with `force / (d · mass)` up to `(d h)² / 24`. The engine's own damping divides by `1 + d h` at
//! the end of a step instead, whose rate and final velocity both depend on the step.

use rapier3d::prelude::*;

use super::{Simulation, WorldPlan};
use crate::world::TouchedSurface;

/// Factors on velocities in half a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HalfStepDamping {
    /// Of the air, on the angular velocity.
    air: f32,
    /// Of the stairs, on both velocities of a limb that touches them.
    stairs: f32,
    /// Of the ground, likewise.
    ground: f32,
}

impl HalfStepDamping {
    /// The factors of a world.
    pub fn of(plan: &WorldPlan) -> Self {
        let half_step_s = plan.physics.step_s() / 2.0;
        let factor = |rate_per_s: f32| libm::expf(-rate_per_s * half_step_s);
        Self {
            air: factor(plan.body.angular_damping_per_s),
            stairs: factor(plan.surface.dampen_per_s),
            ground: factor(plan.ground.dampen_per_s),
        }
    }

    /// The factor of a surface; 1 for a limb.
    fn of_surface(&self, touched: TouchedSurface) -> f32 {
        match touched {
            TouchedSurface::Ground => self.ground,
            TouchedSurface::Stairs => self.stairs,
            TouchedSurface::Limb(_) => 1.0,
        }
    }
}

impl Simulation {
    /// Lets air and surfaces slow the limbs for half a step.
    pub(crate) fn dampen_half_step(&mut self) {
        let damping = self.damping;
        let surfaces_damp = damping.stairs < 1.0 || damping.ground < 1.0;
        if !surfaces_damp && damping.air == 1.0 {
            return;
        }
        for index in 0..self.limbs.len() {
            let limb = self.limbs[index];
            let surface = if surfaces_damp { self.surface_factor(limb) } else { 1.0 };
            let body = &mut self.physics.bodies[limb];
            let turning_j = rotation_energy_j(body);
            self.balance.rotation_damping_j +=
                f64::from(turning_j * (1.0 - damping.air * damping.air));
            body.set_angvel(body.angvel() * (damping.air * surface), false);
            if surface < 1.0 {
                body.set_linvel(body.linvel() * surface, false);
            }
        }
    }

    /// Factors on the linear and the angular velocity of a limb in the second half of the last step.
    pub(super) fn last_damping(&self, limb: RigidBodyHandle) -> [f32; 2] {
        let surface = self.surface_factor(limb);
        [surface, surface * self.damping.air]
    }

    /// Factor of the surface that damps a limb most in half a step; 1 if it touches none that damps.
    pub(super) fn surface_factor(&self, limb: RigidBodyHandle) -> f32 {
        self.strongest_damping(limb).map_or(1.0, |(touched, _)| self.damping.of_surface(touched))
    }
}

/// Energy of a body's rotation, in J.
pub(super) fn rotation_energy_j(body: &RigidBody) -> f32 {
    let rate = body.rotation().inverse() * body.angvel();
    // The axes of a box are its principal axes.
    let inertia = body.mass_properties().local_mprops.principal_inertia();
    (inertia * rate).dot(rate) / 2.0
}
