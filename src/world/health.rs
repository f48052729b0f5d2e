//! When a run no longer counts: the physics broke, or was broken.
//!
//! A learning method finds every crack of an engine. A snake that tears its joints apart, gets shot
//! across the hall by a bad contact, or leaves the arena has not climbed; it is disqualified at the
//! step in which that shows, and everybody is told why.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};

/// Why an agent was taken out of the competition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Disqualification {
    /// A pose or a velocity was not finite.
    NotFinite,
    /// The two anchors of a joint drifted further apart than allowed.
    JointBroke,
    /// A limb was faster than allowed.
    TooFast,
    /// The agent left the arena.
    LeftArena,
    /// The program failed while it simulated the agent.
    Crashed,
}

impl Disqualification {
    /// The reason in words, to follow "disqualified: ".
    pub fn words(self) -> &'static str {
        match self {
            Self::NotFinite => "its state was not finite",
            Self::JointBroke => "a joint came apart",
            Self::TooFast => "it outran the speed limit",
            Self::LeftArena => "it left the arena",
            Self::Crashed => "the program failed on it",
        }
    }
}

/// The tolerances beyond which an agent is disqualified.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HealthLimits {
    /// Largest distance between the two anchors of a joint, in metres. A tenth of a block's
    /// width by default: a gap that can be seen.
    pub joint_drift_m: f32,
    /// Largest speed of a limb's centre, in m/s. A fall from the landing ends at 10 m/s, so 25
    /// is out of reach for anything but an explosion.
    pub speed_m_s: f32,
    /// Largest |x| of a limb's centre, in metres.
    pub arena_half_width_m: f32,
    /// How far behind the start of the axis the arena goes, in metres: a limb's least y is minus this.
    pub arena_back_m: f32,
}

impl Default for HealthLimits {
    fn default() -> Self {
        Self { joint_drift_m: 0.1, speed_m_s: 25.0, arena_half_width_m: 12.0, arena_back_m: 30.0 }
    }
}

impl HealthLimits {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        // From what the solver itself leaves open to what is no limit at all; so with the others.
        within("joint_drift_m", self.joint_drift_m, 0.001..=10.0)?;
        within("speed_m_s", self.speed_m_s, 1.0..=1000.0)?;
        within("arena_half_width_m", self.arena_half_width_m, 1.0..=1000.0)?;
        within("arena_back_m", self.arena_back_m, 1.0..=1000.0)
    }
}
