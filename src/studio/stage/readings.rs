//! Contacts, torques and joints of a lane, for panels and overlays.

use super::replay::Replay;
use crate::world::{ContactForce, JointState, JointTorque};

/// Contacts, torques and joints after the last step.
#[derive(Debug, Clone, Default)]
pub(crate) struct Readings {
    /// Contact forces on the limbs.
    pub contacts: Vec<ContactForce>,
    /// Joint torques, from the head.
    pub torques: Vec<JointTorque>,
    /// Joint states, from the head.
    pub joints: Vec<JointState>,
    /// Speeds of the limbs' centres, from head to tail, in m/s.
    pub speeds_m_s: Vec<f32>,
}

impl Readings {
    /// Reads them off the world of a replay; a recording has none.
    pub fn of(replay: &Replay) -> Self {
        replay.simulation().map_or_else(Self::default, |simulation| Self {
            contacts: simulation.contact_forces(),
            torques: simulation.applied_torques().collect(),
            joints: simulation.joint_states().collect(),
            speeds_m_s: simulation.speeds_m_s().collect(),
        })
    }
}
