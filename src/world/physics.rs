//! How time passes: the constant step, the solver's substeps, gravity.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};

/// Settings of the physics engine. They belong to the trial, because they change the bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhysicsSettings {
    /// Physics steps per simulated second, in Hz. Every step has the same length.
    pub steps_per_s: u32,
    /// Solver substeps within one step.
    pub substeps: u32,
    /// Downward acceleration, in m/s².
    pub gravity_m_s2: f32,
}

impl Default for PhysicsSettings {
    fn default() -> Self {
        Self { steps_per_s: 60, substeps: 4, gravity_m_s2: 9.81 }
    }
}

impl PhysicsSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        // Slower than 20 a second bodies pass through each other; faster than 1000 nothing changes.
        within("steps_per_s", self.steps_per_s, 20..=1000)?;
        within("substeps", self.substeps, 1..=32)?;
        // From weightlessness to four times Jupiter.
        within("gravity_m_s2", self.gravity_m_s2, 0.0..=100.0)
    }

    /// Length of one physics step, in seconds.
    pub fn step_s(&self) -> f32 {
        1.0 / self.steps_per_s as f32
    }
}
