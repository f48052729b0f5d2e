//! What a run demanded of the snake, and how near it came to being disqualified.

/// What the healthy steps so far demanded.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Energy that the joints spent, in J: the integral of |torque × joint rate| over both axes of all
    /// joints. What flows back from a joint that is driven against its torque is spent, too.
    pub energy_j: f32,
    /// Greatest speed of a limb's centre, in m/s.
    pub top_speed_m_s: f32,
    /// Greatest distance between the two anchors of a joint, in m.
    pub joint_drift_m: f32,
    /// Greatest |x| of a limb's centre, in m.
    pub sideways_m: f32,
}

impl Effort {
    /// Both one after the other.
    pub fn and(self, later: Self) -> Self {
        Self {
            energy_j: self.energy_j + later.energy_j,
            top_speed_m_s: self.top_speed_m_s.max(later.top_speed_m_s),
            joint_drift_m: self.joint_drift_m.max(later.joint_drift_m),
            sideways_m: self.sideways_m.max(later.sideways_m),
        }
    }
}
