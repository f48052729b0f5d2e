//! Damping of the limbs by the air and by surfaces.

use rapier3d::prelude::*;

use super::Simulation;
use crate::world::TouchedSurface;

impl Simulation {
    /// Slows the limbs by the damping of air and surfaces for half a step.
    pub fn dampen_half_step(&mut self) {
        let damping = self.damping;
        let surfaces_damp = damping.stairs < 1.0 || damping.ground < 1.0;
        if !surfaces_damp && damping.air == 1.0 {
            return;
        }
        for index in 0..self.parts.len() {
            let limb = self.parts[index];
            let surface = if surfaces_damp { self.surface_factor(limb) } else { 1.0 };
            let turning_j = self.rotation_energy_j(index);
            let body = &mut self.physics.bodies[limb];
            self.balance.rotation_damping_j +=
                f64::from(turning_j * (1.0 - damping.air * damping.air));
            body.set_angvel(body.angvel() * (damping.air * surface), false);
            if surface < 1.0 {
                body.set_linvel(body.linvel() * surface, false);
            }
        }
    }

    /// Returns the factors by which damping changed a limb's linear and angular velocity in the second half of the last step.
    pub(super) fn last_damping(&self, limb: RigidBodyHandle) -> [f32; 2] {
        let surface = self.surface_factor(limb);
        [surface, surface * self.damping.air]
    }

    /// Returns the factor for half a step of the surface that damps a limb most; 1 if the limb touches no surface that damps.
    pub(super) fn surface_factor(&self, limb: RigidBodyHandle) -> f32 {
        match self.strongest_damping(limb) {
            Some((TouchedSurface::Ground, _)) => self.damping.ground,
            Some((TouchedSurface::Stairs, _)) => self.damping.stairs,
            Some((TouchedSurface::Limb(_), _)) | None => 1.0,
        }
    }

    /// Returns the energy of a part's rotation, in J.
    fn rotation_energy_j(&self, part: usize) -> f32 {
        let body = &self.physics.bodies[self.parts[part]];
        let rate = self.turned(body.rotation().inverse(), body.angvel());
        // The axes of a box are its principal axes of inertia.
        let inertia = match self.inertia_in_lanes_kg_m2(part) {
            Some(inertia) => inertia,
            None => body.mass_properties().local_mprops.principal_inertia(),
        };
        (inertia * rate).dot(rate) / 2.0
    }
}
