//! Energy, speed and distances of a rollout. They show how close it came to disqualification.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};

/// Totals and maxima over all healthy steps of a rollout.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Effort {
    /// Energy that the joints spent, in J: the integral of |torque × joint rate| over both axes of all joints. Energy that flows back from
    /// a joint driven against its torque counts as spent, too. With a holding power, the integral of holding power × torque² is added.
    pub energy_j: f32,
    /// Greatest speed of a limb's centre, in m/s.
    pub top_speed_m_s: f32,
    /// Greatest distance between the two anchors of a joint, in m.
    pub joint_drift_m: f32,
    /// Greatest |x| of a limb's centre, in m.
    pub sideways_m: f32,
}

impl Effort {
    /// Checks every value that was read from a file.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(self) -> Result<(), Invalid> {
        let Effort { energy_j, top_speed_m_s, joint_drift_m, sideways_m } = self;
        for (field, value) in [
            ("energy_j", energy_j),
            ("top_speed_m_s", top_speed_m_s),
            ("joint_drift_m", joint_drift_m),
            ("sideways_m", sideways_m),
        ] {
            within(field, value, 0.0..=1.0e12)?;
        }
        Ok(())
    }

    /// Combines the effort of two consecutive parts of a rollout: adds the energies and takes the greater of each maximum.
    pub fn and(self, later: Self) -> Self {
        Self {
            energy_j: self.energy_j + later.energy_j,
            top_speed_m_s: self.top_speed_m_s.max(later.top_speed_m_s),
            joint_drift_m: self.joint_drift_m.max(later.joint_drift_m),
            sideways_m: self.sideways_m.max(later.sideways_m),
        }
    }
}
