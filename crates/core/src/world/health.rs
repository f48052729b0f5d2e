//! Limits beyond which a rollout no longer counts, because the physics broke or was exploited.
//!
//! Learning methods exploit every weakness of an engine. A snake that tears its joints apart, is shot across the arena by a bad contact,
//! or leaves the arena has not climbed. It is disqualified in the step in which this is detected, and every report states the reason.

use serde::{Deserialize, Serialize};

use crate::schema::{number, setting_group};

/// Reason for which an agent was disqualified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Disqualification {
    /// A pose or a velocity was not finite.
    NotFinite,
    /// The two anchors of a joint drifted further apart than allowed.
    JointBroke,
    /// A limb was faster than allowed.
    TooFast,
    /// The agent left the arena sideways, backwards or forwards, or fell through the ground.
    LeftArena,
    /// The agent gained mechanical energy that its joints had not supplied.
    EnergyFromNothing,
    /// The agent, with a body from its genome, fell over or did not come to rest before its trial.
    FellOver,
    /// The program failed while it simulated the agent.
    Crashed,
}

impl Disqualification {
    /// Returns the reason in words, to follow "disqualified: ".
    pub fn words(self) -> &'static str {
        match self {
            Self::NotFinite => "invalid numbers in its simulation",
            Self::JointBroke => "joint pulled apart",
            Self::TooFast => "speed limit exceeded",
            Self::LeftArena => "sideways or backward limit crossed",
            Self::EnergyFromNothing => "energy from nothing",
            Self::FellOver => "not at rest at the start",
            Self::Crashed => "simulation failed",
        }
    }
}

setting_group! {
    /// Tolerances beyond which an agent is disqualified. The range of each goes from the error that the solver itself leaves to a value
    /// that limits nothing.
    pub struct HealthLimits in "Disqualification": "A snake that breaks the physics instead of climbing is disqualified." {
        /// Largest distance between the two anchors of a joint, in metres. The default is a tenth of a block's width, a gap that can be
        /// seen. For a body from the genome the limit applies to blocks of 1 m, and scales with the smallest side of the two joined limbs.
        joint_drift_m: f32 = 0.1,
            number("Joint gap", 0.001..=10.0)
                .unit("m")
                .hint("A snake is disqualified if a joint comes apart by more than this")
                .slider(0.01, 1.0)
                .logarithmic_from(0.01);

        /// Largest speed of a limb's centre, in m/s. A fall from the landing ends at 10 m/s, so only a failure of the simulation reaches
        /// 25 m/s.
        speed_m_s: f32 = 25.0,
            number("Speed limit", 1.0..=1000.0)
                .unit("m/s")
                .hint("A snake is disqualified if a block is faster than this, which only an unstable simulation reaches")
                .slider(1.0, 100.0);

        /// Largest |x| of a limb's centre within the arena, in metres.
        arena_half_width_m: f32 = 12.0,
            number("Sideways limit", 1.0..=1000.0).advanced()
                .unit("m")
                .hint(
                    "A snake is disqualified if a block is further from the middle of the stairs than this",
                )
                .slider(2.0, 50.0);

        /// Extent of the arena behind the origin of the y axis, in metres: no limb may have a y below the negative of this value.
        arena_back_m: f32 = 30.0,
            number("Backward limit", 1.0..=1000.0).advanced()
                .unit("m")
                .hint("A snake is disqualified if a block is further than this behind the place where the distance (y) is 0")
                .slider(5.0, 100.0);
    }
}
