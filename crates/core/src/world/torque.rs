//! Torques at joints, as commanded and as applied.

use rapier3d::prelude::Rotation;

/// The torques that a controller commands at one joint, in N·m, positive by the right-hand rule about the joint's own axes. They act on
/// the joint's child; opposite torques act on its parent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointTorque {
    /// Torque about the joint's x axis, in N·m. In a chain, this axis is the parent's x axis.
    pub bend_nm: f32,
    /// Torque about the joint's y axis, in N·m. In a chain, this axis is the parent's y axis.
    pub twist_nm: f32,
}

/// The torque that acts at a joint in one step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AppliedTorque {
    /// The joint's axes in the world, about which the torque acts.
    pub axes: Rotation,
    /// The torque, clamped to the joint's limits.
    pub torque: JointTorque,
    /// Joint rates at the start of the step: bend and twist, in rad/s.
    pub rates_rad_s: [f32; 2],
}
