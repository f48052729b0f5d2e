//! The state of the world as a controller perceives it.

use crate::world::{JointState, Simulation};

/// The senses that a controller needs. Others are not computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Senses {
    /// Angle and rate of every joint.
    pub joints: bool,
}

/// The moment at which a controller acts.
#[derive(Debug, Clone, Default)]
pub struct Observation {
    /// Number of the step that begins; the first is 0.
    pub step: u32,
    /// Steps per simulated second.
    pub steps_per_s: u32,
    /// State of each joint from the head; empty unless the controller needs it.
    pub joints: Vec<JointState>,
}

impl Observation {
    /// Periods of an oscillation that have passed when the step begins, computed from the number of the step
    /// instead of summed up, so that no error accumulates.
    pub fn periods(&self, frequency_hz: f32) -> f64 {
        f64::from(frequency_hz) * f64::from(self.step) / f64::from(self.steps_per_s)
    }

    /// Observes the world before a step. Buffers are reused: nothing is allocated after the first step.
    pub(super) fn update(&mut self, step: u32, world: &Simulation, senses: Senses) {
        self.step = step;
        if senses.joints {
            self.joints.clear();
            self.joints.extend(world.joint_states());
        }
    }
}
