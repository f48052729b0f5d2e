//! Torques at joints.

use rapier3d::prelude::Rotation;

/// The torques a controller commands at one joint, in N·m, positive by the right-hand rule about the
/// joint's own axes. They act on the joint's child, and their opposites on its parent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointTorque {
    /// About the joint's x axis, in a chain that of the parent.
    pub bend_nm: f32,
    /// About the joint's y axis, in a chain that of the parent.
    pub twist_nm: f32,
}

/// Torque at a joint in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AppliedTorque {
    /// The joint's axes in the world, about which the torque acts.
    pub axes: Rotation,
    /// The torque after clamping.
    pub torque: JointTorque,
    /// Joint rates at the start of the step: bend and twist, in rad/s.
    pub rates_rad_s: [f32; 2],
}
