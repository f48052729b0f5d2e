//! The kinds of controllers, by name only; `controllers` registers the genes of each kind.

use serde::{Deserialize, Serialize};

/// A kind of controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ControllerKind {
    /// Free torque signals, the report's.
    #[default]
    Signal,
    /// Periodic torques.
    Wave,
    /// Periodic joint angles, followed by a servo.
    Gait,
    /// A gait with reflexes.
    Reflex,
    /// The same small network at each joint.
    Modular,
    /// One network for the whole snake.
    Central,
    /// A continuous-time recurrent neural network.
    Ctrnn,
    /// Learned decisions among a few postures.
    Decisions,
    /// Learned decisions of each joint about its bend.
    JointDecisions,
    /// Rules that choose among waves.
    Rules,
    /// A network that grew.
    Grown,
    /// Neurons in the limbs.
    LimbNeurons,
    /// Neurons in the parts of a branching body.
    PartNeurons,
}

impl ControllerKind {
    /// All kinds, the report's first.
    pub const ALL: [Self; 13] = [
        Self::Signal,
        Self::Wave,
        Self::Gait,
        Self::Reflex,
        Self::Modular,
        Self::Central,
        Self::Ctrnn,
        Self::Decisions,
        Self::JointDecisions,
        Self::Rules,
        Self::Grown,
        Self::LimbNeurons,
        Self::PartNeurons,
    ];
}
