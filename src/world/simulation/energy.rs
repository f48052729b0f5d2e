//! Energy balance of the snake: the work of its joints, its mechanical energy, and what was lost.

use super::Simulation;

/// Terms of the energy balance that only stepping knows. They never act back on the simulation.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct EnergyBalance {
    /// Mechanical energy at the start, in J.
    pub start_j: f64,
    /// Work of the joints since the start, in J: positive where they drive, negative where they brake.
    pub joint_work_j: f64,
}

impl Simulation {
    /// Mechanical energy that the snake has lost since the start, in J:
    /// `E(0) + W - E(t)`, with the kinetic and potential energy E of all limbs and the work W of the joint torques.
    ///
    /// This is everything that turned into heat: in contacts (friction, impacts, dents, surface damping), in the joints
    /// (damping, end stops) and by the damping of rotation. A dent or a soft joint under load holds a little
    /// energy that it may give back. The sum does not separate these; [`Self::contact_patches`] has the part of the
    /// friction. W is the trapezoidal rule over each step, so a joint that turns jerkily within a step adds an error.
    /// The work of a user's pull is not counted: after a pull the sum says nothing.
    pub fn energy_lost_j(&self) -> f32 {
        (self.balance.start_j + self.balance.joint_work_j - self.mechanical_energy_j()) as f32
    }

    /// Kinetic and potential energy of all limbs, in J. The potential energy is 0 at z = 0.
    pub(super) fn mechanical_energy_j(&self) -> f64 {
        let substep_s =
            self.physics.integration_parameters.dt / self.contacts.substeps.max(1) as f32;
        let bodies = self.limbs.iter().map(|&limb| &self.physics.bodies[limb]);
        let energies_j = bodies.map(|body| {
            // The engine's positions are half a substep ahead of its velocities.
            let height_j = body.gravitational_potential_energy(substep_s, self.physics.gravity);
            f64::from(body.kinetic_energy()) + f64::from(height_j)
        });
        energies_j.sum()
    }

    /// Power of the joint torques that are applied now, in W.
    pub(super) fn joint_power_w(&self) -> f64 {
        let limbs = self.limbs.iter().zip(&self.torques_in_world);
        let powers_w =
            limbs.map(|(&limb, torque)| torque.dot(self.physics.bodies[limb].angvel()));
        f64::from(powers_w.sum::<f32>())
    }
}
