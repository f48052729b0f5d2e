//! Updates the energy balance of a world after each step, and reports its result.

use rapier3d::prelude::*;

use super::Simulation;
use crate::world::energy::{EnergyBalance, EnergyLost, LimbTurn};

impl Simulation {
    /// Returns the energy lost since the start.
    pub fn energy_lost(&self) -> EnergyLost {
        let balance = &self.balance;
        let total_j = balance.start_j + balance.joint_work_j - self.mechanical_energy_j();
        EnergyLost {
            total_j: total_j as f32,
            joint_damping_j: balance.joint_damping_j as f32,
            rotation_damping_j: balance.rotation_damping_j as f32,
        }
    }

    /// Restarts the balance with the present state.
    pub(super) fn begin_balance(&mut self) {
        let start_j = self.mechanical_energy_j();
        self.balance = EnergyBalance { start_j, ..EnergyBalance::default() };
    }

    /// Continues the balance of an earlier world whose state this world has taken. A difference in energy that comes only from other
    /// parameters, such as another gravity, counts neither as lost nor as gained.
    pub(super) fn take_balance_of(&mut self, earlier: &Self) {
        self.balance = earlier.balance;
        self.balance.start_j += self.mechanical_energy_j() - earlier.mechanical_energy_j();
    }

    /// Stores the rotations and angular velocities of the limbs before a step.
    pub(super) fn read_turns(&mut self) {
        self.turns_before.clear();
        for &limb in &self.parts {
            let body = &self.physics.bodies[limb];
            self.turns_before.push(LimbTurn { rotation: *body.rotation(), rate: body.angvel() });
        }
    }

    /// Adds a step to the balance, given the limbs' rotations before it ([`Self::read_turns`]). It must be called right after the engine's
    /// step, because bounces, air and damping surfaces change the angular velocities afterwards.
    ///
    /// Angular velocities change a lot within one step where a joint reaches its stop. The integrals therefore use the angular velocities
    /// at both ends of the step and the angle through which each limb has turned.
    pub(super) fn add_to_balance(&mut self) {
        let step_s = self.physics.integration_parameters.dt;
        let substep_s = self.substep_s();
        let mut work_j = 0.0;
        let mut turns = Vec::with_capacity(self.parts.len());
        for ((&limb, torque), before) in
            self.parts.iter().zip(&self.torques_in_world).zip(&self.turns_before)
        {
            let body = &self.physics.bodies[limb];
            let after = body.angvel();
            let turned_rad =
                rotation_vector(self.product(*body.rotation(), before.rotation.inverse()));
            // The engine turns a limb by its angular velocity at the end of each substep, but the work of a torque depends on the mean of
            // the angular velocities at both ends.
            let mean = turned_rad / step_s - (after - before.rate) * (substep_s / (2.0 * step_s));
            work_j += torque.dot(mean) * step_s;
            turns.push([before.rate, mean, after]);
        }
        let mut joints_j = 0.0;
        for joint in &self.body.joints {
            let to_joint =
                self.joint_axes(joint, self.turns_before[joint.parent].rotation).inverse();
            let [first, mean, last] = std::array::from_fn(|moment| {
                self.turned(to_joint, turns[joint.child][moment] - turns[joint.parent][moment])
            });
            let squares = square_over_step(first.x, mean.x, last.x)
                + square_over_step(first.y, mean.y, last.y);
            joints_j += joint.damping_nms_per_rad * squares * step_s;
        }
        self.balance.joint_work_j += f64::from(work_j);
        self.balance.joint_damping_j += f64::from(joints_j);
    }

    /// Returns the kinetic and potential energy of all parts, including the springs of soft limbs, in J. The potential energy is 0 at z =
    /// 0.
    pub(super) fn mechanical_energy_j(&self) -> f64 {
        let substep_s = self.substep_s();
        if self.lanes.is_some() {
            let parts = 0..self.parts.len();
            let energies_j = parts.map(|part| self.energy_in_lanes_j(part, substep_s));
            return energies_j.sum::<f64>() + self.springs_j();
        }
        let bodies = self.parts.iter().map(|&limb| &self.physics.bodies[limb]);
        let energies_j = bodies.map(|body| {
            // The engine's positions are half a substep ahead of its velocities.
            let height_j = body.gravitational_potential_energy(substep_s, self.physics.gravity);
            f64::from(body.kinetic_energy()) + f64::from(height_j)
        });
        energies_j.sum::<f64>() + self.springs_j()
    }

    /// Returns the energy in the springs of soft limbs, in J: the sum of `k θ² / 2` about each axis.
    fn springs_j(&self) -> f64 {
        let turn = |part: usize| *self.physics.bodies[self.parts[part]].rotation();
        let energies_j = self.body.springs.iter().map(|spring| {
            let between = self.product(turn(spring.parent).inverse(), turn(spring.child));
            let sines = [between.x, between.y, between.z].into_iter();
            let of_axes = sines.zip(spring.stiffness_nm_per_rad).map(|(sine, stiffness)| {
                let angle_rad = 2.0 * f64::from(libm::asinf(sine.clamp(-1.0, 1.0)));
                f64::from(stiffness) * angle_rad * angle_rad / 2.0
            });
            of_axes.sum::<f64>()
        });
        energies_j.sum()
    }
}

/// Returns the axis of a rotation times its angle, in rad.
fn rotation_vector(rotation: Rotation) -> Vector {
    let sign = if rotation.w < 0.0 { -1.0 } else { 1.0 };
    let axis = Vector::new(rotation.x, rotation.y, rotation.z) * sign;
    let sine = axis.length();
    // For small angles, the factor approaches 2.
    let scale = if sine > 1.0e-3 { 2.0 * libm::asinf(sine.min(1.0)) / sine } else { 2.0 };
    axis * scale
}

/// Returns the mean square of a rate over a step: that of the parabola with these values at both ends and this mean.
fn square_over_step(first: f32, mean: f32, last: f32) -> f32 {
    let slope = (last - first) / 2.0;
    let curve = (first + last) / 2.0 - mean;
    mean * mean + slope * slope / 3.0 + curve * curve / 5.0
}
