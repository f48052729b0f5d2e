//! The torques of a step: the controller's commands, the damping of the joints, and the energy that both cost.

use super::Simulation;
use crate::world::engine::PartState;
use crate::world::torque::{AppliedTorque, JointTorque};
use crate::world::turning::turned;
use crate::world::{JointPlan, Rotation, Vector};

impl Simulation {
    /// Prepares a step: air and surfaces slow the limbs for its first half, and each limb gets as its torque the sum of the couples of its
    /// joints.
    pub(super) fn apply(&mut self, torques: &[JointTorque]) {
        self.dampen_half_step();
        self.torques_in_world.fill(Vector::ZERO);
        self.damping_in_world.fill(Vector::ZERO);
        let parts = self.engine.parts();
        for (index, (joint, torque)) in self.plan.body.joints.iter().zip(torques).enumerate() {
            let bend_nm = torque.bend_nm.clamp(-joint.max_bend_torque_nm, joint.max_bend_torque_nm);
            let twist_nm =
                torque.twist_nm.clamp(-joint.max_twist_torque_nm, joint.max_twist_torque_nm);
            let axes = joint.axes(parts[joint.parent].turn);
            let couple = turned(axes, Vector::new(bend_nm, twist_nm, 0.0));
            let rates_rad_s = joint_rates(parts, joint, axes);
            let [bend, twist] = rates_rad_s;
            let damping_nms = joint.damping_nms_per_rad * self.damping_as_torque;
            let damping = turned(axes, Vector::new(bend, twist, 0.0) * -damping_nms);
            let torque = JointTorque { bend_nm, twist_nm };
            self.applied[index] = AppliedTorque { axes, torque, rates_rad_s };
            self.torques_in_world[joint.parent] -= couple;
            self.torques_in_world[joint.child] += couple;
            self.damping_in_world[joint.parent] -= damping;
            self.damping_in_world[joint.child] += damping;
        }
        let torques = self.torques_in_world.iter().zip(&self.damping_in_world);
        for (part, (&drives, &damping)) in self.engine.parts_mut().iter_mut().zip(torques) {
            part.torque_nm = drives + damping;
        }
        if self.pull.is_some() || self.was_pulled {
            self.apply_pull();
        }
    }

    /// Returns the energy that the joints spent on motion in the last step, in J, by the trapezoidal rule. A torque acts through the whole
    /// step about its axes at the beginning of the step.
    pub(super) fn motion_energy_j(&self) -> f32 {
        let joints = self.plan.body.joints.iter().zip(&self.applied);
        let power_w = joints.map(|(joint, AppliedTorque { axes, torque, rates_rad_s })| {
            let after = joint_rates(self.parts(), joint, *axes);
            let [bend, twist] = [0, 1].map(|axis| (rates_rad_s[axis] + after[axis]) / 2.0);
            (torque.bend_nm * bend).abs() + (torque.twist_nm * twist).abs()
        });
        power_w.sum::<f32>() * self.plan.physics.step_s()
    }

    /// Returns the energy that the torques of the last step took by themselves, whether the joints moved or not, in J. It models the heat
    /// of a motor, which grows with the square of its current.
    pub(super) fn holding_energy_j(&self) -> f32 {
        let holding_w_per_n2m2 = self.plan.body.holding_w_per_n2m2;
        if holding_w_per_n2m2 == 0.0 {
            return 0.0;
        }
        let squares = self.applied.iter().map(|AppliedTorque { torque, .. }| {
            torque.bend_nm * torque.bend_nm + torque.twist_nm * torque.twist_nm
        });
        squares.sum::<f32>() * holding_w_per_n2m2 * self.plan.physics.step_s()
    }
}

/// Returns the rates of a joint about the x and y axes of a rotation, in rad/s.
fn joint_rates(parts: &[PartState], joint: &JointPlan, axes: Rotation) -> [f32; 2] {
    let between = parts[joint.child].angular - parts[joint.parent].angular;
    let rate = turned(axes.inverse(), between);
    [rate.x, rate.y]
}
