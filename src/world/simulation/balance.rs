//! Keeps the energy balance of a world, step by step, and reads it.

use super::Simulation;
use crate::world::energy::{DampingPower, EnergyLost};

impl Simulation {
    /// The energy lost since the start.
    pub fn energy_lost(&self) -> EnergyLost {
        let balance = &self.balance;
        let total_j = balance.start_j + balance.joint_work_j - self.mechanical_energy_j();
        EnergyLost {
            total_j: total_j as f32,
            joint_damping_j: balance.joint_damping_j as f32,
            rotation_damping_j: balance.rotation_damping_j as f32,
        }
    }

    /// Begins the balance of a new world.
    pub(super) fn begin_balance(&mut self) {
        self.balance.start_j = self.mechanical_energy_j();
    }

    /// Goes on with the balance of a world whose state this one has taken. Energy that only the other parameters bring,
    /// such as another gravity, counts neither as lost nor as gained.
    pub(super) fn take_balance_of(&mut self, earlier: &Self) {
        self.balance = earlier.balance;
        self.balance.start_j += self.mechanical_energy_j() - earlier.mechanical_energy_j();
        self.balance.damping = self.damping_power();
    }

    /// Adds a step to the balance, given the power of the joint torques at its start, in W.
    pub(super) fn add_to_balance(&mut self, joint_power_before_w: f32) {
        let step_s = self.physics.integration_parameters.dt;
        let over_step_j =
            |before_w: f32, after_w: f32| f64::from((before_w + after_w) / 2.0 * step_s);
        let (before, after) = (self.balance.damping, self.damping_power());
        let work_j = over_step_j(joint_power_before_w, self.joint_power_w());
        let balance = &mut self.balance;
        balance.joint_work_j += work_j;
        balance.joint_damping_j += over_step_j(before.joints_w, after.joints_w);
        balance.rotation_damping_j += over_step_j(before.rotation_w, after.rotation_w);
        balance.damping = after;
    }

    /// Power of the joint torques that are applied now, in W.
    pub(super) fn joint_power_w(&self) -> f32 {
        let limbs = self.limbs.iter().zip(&self.torques_in_world);
        limbs.map(|(&limb, torque)| torque.dot(self.physics.bodies[limb].angvel())).sum()
    }

    /// Power that the damping of joints and of rotation takes at the present speeds.
    fn damping_power(&self) -> DampingPower {
        let bodies = &self.physics.bodies;
        let joints_w = self.body.joints.iter().map(|joint| {
            let [parent, child] = [joint.parent, joint.child].map(|limb| &bodies[self.limbs[limb]]);
            let rate = parent.rotation().inverse() * (child.angvel() - parent.angvel());
            joint.damping_nms_per_rad * (rate.x * rate.x + rate.y * rate.y)
        });
        let rotation_j = self.limbs.iter().map(|&limb| {
            let body = &bodies[limb];
            // The axes of a box are its principal axes.
            let rate = body.rotation().inverse() * body.angvel();
            let inertia = body.mass_properties().local_mprops.principal_inertia();
            (inertia * rate).dot(rate) / 2.0
        });
        DampingPower {
            joints_w: joints_w.sum(),
            rotation_w: 2.0 * self.body.angular_damping_per_s * rotation_j.sum::<f32>(),
        }
    }

    /// Kinetic and potential energy of all limbs, in J. The potential energy is 0 at z = 0.
    fn mechanical_energy_j(&self) -> f64 {
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
}
