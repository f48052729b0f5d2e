//! Updates the energy balance of a world after each step, and reports its result.

use super::Simulation;
use crate::world::energy::{EnergyBalance, EnergyLost};
use crate::world::turning::{product, turned};
use crate::world::{Rotation, Vector};

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

    /// Adds a step to the balance, given the parts before it. It must be called right after the engine's
    /// step, because bounces, air and damping surfaces change the angular velocities afterwards.
    ///
    /// Angular velocities change a lot within one step where a joint reaches its stop. The integrals therefore use the angular velocities
    /// at both ends of the step and the angle through which each limb has turned.
    pub(super) fn add_to_balance(&mut self) {
        let step_s = self.plan.physics.step_s();
        let substep_s = self.plan.physics.substep_s();
        let mut work_j = 0.0;
        self.rates.clear();
        for ((part, torque), before) in
            self.engine.parts().iter().zip(&self.torques_in_world).zip(&self.earlier)
        {
            let after = part.angular;
            let turned_rad = rotation_vector(product(part.turn, before.turn.inverse()));
            // The engine turns a limb by its angular velocity at the end of each substep, but the work of a torque depends on the mean of
            // the angular velocities at both ends.
            let mean =
                turned_rad / step_s - (after - before.angular) * (substep_s / (2.0 * step_s));
            work_j += torque.dot(mean) * step_s;
            self.rates.push([before.angular, mean, after]);
        }
        let mut joints_j = 0.0;
        for joint in &self.plan.body.joints {
            let to_joint = joint.axes(self.earlier[joint.parent].turn).inverse();
            let [of_parent, of_child] = [joint.parent, joint.child].map(|part| self.rates[part]);
            let [first, mean, last] =
                [0, 1, 2].map(|moment| turned(to_joint, of_child[moment] - of_parent[moment]));
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
        let half_substep_s = self.plan.physics.substep_s() / 2.0;
        let parts = self.parts().iter().zip(&self.plan.body.parts).zip(&self.inertias_kg_m2);
        let energies_j = parts.map(|((part, plan), inertia)| {
            let kinetic_j = part.kinetic_energy_j(plan.mass_kg(), *inertia);
            // The engine's positions are half a substep ahead of its velocities.
            let at = part.at - part.linear * half_substep_s;
            let weight_n = self.plan.physics.gravity() * plan.mass_kg();
            f64::from(kinetic_j) - f64::from(weight_n.dot(at))
        });
        energies_j.sum::<f64>() + self.springs_j()
    }

    /// Returns the energy in the springs of soft limbs, in J: the sum of `k θ² / 2` about each axis.
    fn springs_j(&self) -> f64 {
        let turn = |part: usize| self.parts()[part].turn;
        let energies_j = self.plan.body.springs.iter().map(|spring| {
            let between = product(turn(spring.parent).inverse(), turn(spring.child));
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
