//! The kinds of controllers, by name only. The module `controllers` registers the genes of each kind.

use std::fmt;

use crate::schema::{Choices, choices};

choices! {
    /// A kind of controller.
    #[derive(Default)]
    pub enum ControllerKind {
        #[default]
        Signal = "signal", "Signal", "Free torque signals, point by point, as in the report.";
        Wave = "wave", "Wave", "Periodic torques: a wave per joint axis, one frequency.";
        Gait = "gait", "Gait", "Periodic joint angles, followed by a servo that senses the joint.";
        Targets = "targets", "Targets",
            "Free joint angles, point by point, followed by a servo: what a policy in Python did.";
        Reflex = "reflex", "Reflex", "A gait whose target angles and phases yield to what the snake senses.";
        Modular = "modular", "Modular", "The same small network at each joint; neighbours exchange messages.";
        Central = "central", "Central", "One network for the whole snake, from all senses to all joints.";
        Ctrnn = "ctrnn", "CTRNN", "Continuous-time recurrent network: three leaky neurons at each joint.";
        Decisions = "decisions", "Decisions",
            "Takes one of eleven postures four times a second, as it has learned to.";
        JointDecisions = "joint_decisions", "Joint decisions",
            "Each joint chooses its bend four times a second, by rules of its own.";
        Rules = "rules", "Rules", "Rules choose among a few waves by what the snake senses.";
        Grown = "grown", "Grown", "A network for the whole snake, to which evolution adds nodes and links.";
        LimbNeurons = "limb_neurons", "Limb neurons",
            "Four neurons in each block, wired to one another, to the neighbouring blocks and to senses.";
        PartNeurons = "part_neurons", "Part neurons",
            "Neurons in each part of a branching body, which grow with the part.";
    }
}

impl ControllerKind {
    /// All kinds of controllers; the one of the report comes first.
    pub const ALL: &'static [Self] = Self::OPTIONS;

    /// Returns the name of the kind in files. Command-line flags may contain - instead of _.
    pub fn name(self) -> &'static str {
        self.choice().name
    }

    /// Returns the name of the kind for the head of a list or a chart.
    pub fn title(self) -> &'static str {
        self.choice().title
    }

    /// Returns a sentence that describes the kind.
    pub fn words(self) -> String {
        self.choice().sentence
    }

    /// Returns whether the controller senses contacts, attitude and the stairs ahead, besides its joints.
    pub fn senses_surroundings(self) -> bool {
        !matches!(self, Self::Signal | Self::Wave | Self::Gait | Self::Targets)
    }
}

impl fmt::Display for ControllerKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}
