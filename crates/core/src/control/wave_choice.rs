//! The state of waves that rules choose at a moment, for display.

use crate::genome::controllers::{JointGroup, JointWaves, WaveRule};

/// Waves, and the rules that have chosen among them.
#[derive(Debug, Clone, PartialEq)]
pub struct WaveChoiceActivity {
    /// The joint whose part of the waves is shown; the first is 0.
    pub joint: usize,
    /// The waves of the library.
    pub waves: Vec<ActiveWave>,
    /// The wave that each joint follows, by its place in the list.
    pub of_joints: Vec<usize>,
    /// Number of joints in the front half.
    pub front_joints: usize,
    /// The rules, in their order.
    pub rules: Vec<ActiveWaveRule>,
}

/// A wave of the library.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveWave {
    /// Its frequency, in Hz.
    pub frequency_hz: f32,
    /// The part of its period that has passed, from 0 to 1.
    pub phase: f32,
    /// The target angles of the joint that is shown, in radians.
    pub targets: JointWaves,
    /// Share of the decisions so far that were for it, from 0 to 1.
    pub share: f32,
}

/// A rule, and whether it has decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveWaveRule {
    /// The rule.
    pub rule: WaveRule,
    /// Whether its condition held at the last decision.
    pub holds: bool,
    /// The joints for which it decided then; none if a stronger one did, or it did not hold.
    pub decides: Option<JointGroup>,
}
