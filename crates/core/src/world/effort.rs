//! Energy, speeds and distances of a rollout, which show how near it came to disqualification.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};

/// Totals and maxima over the healthy steps so far.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Effort {
    /// Energy that the joints spent, in J: the integral of |torque × joint rate| over both axes of all
    /// joints. Energy that flows back from a joint driven against its torque counts as spent, too. With a holding power, the
    /// integral of its product with the square of the torque is added.
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
    /// The first that is not allowed.
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

    /// The effort of two consecutive parts of a rollout.
    pub fn and(self, later: Self) -> Self {
        Self {
            energy_j: self.energy_j + later.energy_j,
            top_speed_m_s: self.top_speed_m_s.max(later.top_speed_m_s),
            joint_drift_m: self.joint_drift_m.max(later.joint_drift_m),
            sideways_m: self.sideways_m.max(later.sideways_m),
        }
    }
}
