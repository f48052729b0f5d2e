//! Energy balance of the snake: the work of its joints, its mechanical energy, and what was lost.

use super::Simulation;

/// Terms of the energy balance that only stepping knows, since the start. They never act back on the simulation.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct EnergyBalance {
    /// Mechanical energy at the start, in J.
    start_j: f64,
    /// Work of the joint torques, in J: positive where they drive, negative where they brake.
    pub joint_work_j: f64,
    joint_damping_j: f64,
    rotation_damping_j: f64,
    /// Powers after the last step.
    damping: DampingPower,
}

/// Power that damping takes away, in W.
#[derive(Debug, Clone, Copy, Default)]
struct DampingPower {
    joints_w: f32,
    rotation_w: f32,
}

/// Mechanical energy that the snake has lost since the start.
///
/// The parts are computed with the trapezoidal rule over each step, which is accurate to a few hundredths of the joints'
/// work. The work of a user's pull is not counted: after a pull the numbers say nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyLost {
    /// Everything that turned into heat, in J: `E(0) + W - E(t)`, with the kinetic and potential energy E of all limbs and
    /// the work W of the joint torques. A dent or a soft joint under load holds a little of it, which may come back.
    pub total_j: f32,
    /// The part of the joints' damping, in J: the integral of `c ω²` over all joint axes, for the damping c and the
    /// rate ω.
    pub joint_damping_j: f32,
    /// The part of the damping of the limbs' rotation, in J: the integral of `2 d E_rot`, for the rate d at which
    /// rotation is damped and the energy of rotation.
    pub rotation_damping_j: f32,
}

impl EnergyLost {
    /// What neither damping took, in J: the loss in contacts (friction, impacts, dents, damping of surfaces) and at the
    /// stops of the joints. The balance cannot separate these; [`Simulation::contact_patches`] has the power of friction.
    pub fn elsewhere_j(&self) -> f32 {
        self.total_j - self.joint_damping_j - self.rotation_damping_j
    }
}

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
