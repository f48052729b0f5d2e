//! Contacts, torques and joints of a lane, for panels and overlays.

use super::contact_meter::ContactMeter;
use super::replay::Replay;
use snakes_core::world::{ContactForce, EnergyLost, JointState, JointTorque};

/// Contacts, torques and joints of a lane after the last step. Empty for a recording.
#[derive(Debug, Clone, Default)]
pub(crate) struct Readings {
    /// Contact forces on the limbs after the last step.
    pub contacts: Vec<ContactForce>,
    /// Torques of the joints, from the head.
    pub torques: Vec<JointTorque>,
    /// States of the joints, from the head.
    pub joints: Vec<JointState>,
    /// Speeds of the limbs' centres, from head to tail, in m/s.
    pub speeds_m_s: Vec<f32>,
    /// Energy that the snake has lost since the start; `None` for a recording and after a pull.
    pub energy_lost: Option<EnergyLost>,
    /// Recent contacts of the limbs with the surfaces; empty for a recording and for a ghost.
    pub meter: ContactMeter,
}

impl Readings {
    /// Creates the readings at the start of a replay with this number of physics steps per second.
    pub fn new(replay: &Replay, steps_per_s: u32) -> Self {
        let meter = ContactMeter::new(steps_per_s);
        let mut readings = Self { meter, ..Self::default() };
        readings.update(replay);
        readings
    }

    /// Reads the world of a replay after a step. Does nothing for a recording, which has no world. The meter is not
    /// updated, because it samples each step by itself.
    pub fn update(&mut self, replay: &Replay) {
        let Some(simulation) = replay.simulation() else { return };
        self.contacts = simulation.contact_forces();
        self.torques = simulation.applied_torques().collect();
        self.joints = simulation.joint_states().collect();
        self.speeds_m_s =
            simulation.limb_velocities().map(|[velocity, _]| velocity.length()).collect();
        self.energy_lost = (!replay.is_disturbed()).then(|| simulation.energy_lost());
    }
}
