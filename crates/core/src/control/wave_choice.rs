//! The waves that rules choose, at a moment, for display.

use crate::genome::controllers::{JointGroup, JointWaves, WaveRule};

/// The waves of a library, and the rules that have chosen among them.
#[derive(Debug, Clone, PartialEq)]
pub struct WaveChoiceActivity {
    /// Joint for which the waves are shown; the first joint is 0.
    pub joint: usize,
    /// Waves of the library.
    pub waves: Vec<ActiveWave>,
    /// Index of the wave that each joint follows.
    pub of_joints: Vec<usize>,
    /// Number of joints in the front half.
    pub front_joints: usize,
    /// Rules of the genome, in their order.
    pub rules: Vec<ActiveWaveRule>,
}

/// A wave of the library.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveWave {
    /// Frequency of the wave, in Hz.
    pub frequency_hz: f32,
    /// Share of the wave's period that has passed, from 0 to 1.
    pub phase: f32,
    /// Waves of the target angles of the shown joint, in radians.
    pub targets: JointWaves,
    /// Share of the decisions so far that chose the wave, from 0 to 1.
    pub share: f32,
}

/// A rule, and whether it decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveWaveRule {
    /// The rule.
    pub rule: WaveRule,
    /// Whether the rule's condition held at the last decision.
    pub holds: bool,
    /// Joints for which the rule decided at the last decision; `None` if it did not hold or a stronger rule decided.
    pub decides: Option<JointGroup>,
}
