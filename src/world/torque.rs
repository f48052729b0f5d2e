//! Torques at joints.

use rapier3d::prelude::Rotation;

/// The torques a controller commands at one joint, in N·m, positive by the right-hand rule about the
/// joint's own axes. They act on the joint's child, and their opposites on its parent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointTorque {
    /// About the parent's x axis.
    pub bend_nm: f32,
    /// About the parent's y axis.
    pub twist_nm: f32,
}

/// Torque at a joint in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AppliedTorque {
    /// Rotation of the parent, about whose axes the torque acts.
    pub parent: Rotation,
    /// The torque after clamping.
    pub torque: JointTorque,
    /// Joint rates at the start of the step: bend and twist, in rad/s.
    pub rates_rad_s: [f32; 2],
}
