//! The observation: the state of the world as a controller perceives it.

use super::{ActiveSenses, Perception};
use crate::genome::controllers::point_at;
use crate::world::{ClimbProgress, JointState, PhysicsSettings, Simulation};

/// The senses that a controller needs. Other senses are not computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Senses {
    /// Whether it needs the angle and rate of every joint.
    pub joints: bool,
    /// Whether it needs contacts, attitude, and the stairs ahead: see [`Perception`].
    pub surroundings: bool,
    /// Whether it needs the progress up the stairs, from which rewards are computed. No posture or torque may depend on it.
    pub climb: bool,
}

impl Senses {
    /// The senses of the joints alone.
    pub const JOINTS: Self = Self { joints: true, surroundings: false, climb: false };
    /// All senses of a snake, without the progress for rewards.
    pub const ALL: Self = Self { joints: true, surroundings: true, climb: false };
}

/// The state of the world at the moment at which a controller acts.
#[derive(Debug, Clone, Default)]
pub struct Observation {
    /// Number of the step that begins; the first step is 0.
    pub step: u32,
    /// Number of steps per simulated second.
    pub steps_per_s: u32,
    /// Time from the start of a step to the moment for which its torques are computed, in seconds: see [`Observation::at_start`].
    pub lead_s: f32,
    /// State of each joint from the head; empty unless the controller needs the joints.
    pub joints: Vec<JointState>,
    /// All senses, scaled for controllers; empty unless the controller needs the surroundings.
    pub perception: Perception,
    /// Progress up the stairs; zero unless the controller needs it.
    pub climb: ClimbProgress,
}

impl Observation {
    /// Returns the observation before the first step of a world with these settings of the engine.
    ///
    /// A torque holds for a whole step. A torque for the state at the start of the step is therefore late by half a step on average, and a
    /// servo of stiffness k loses the damping `k h / 2` in steps of length h. The engine compensates a part of it, half a substep, because
    /// it moves limbs by their velocities at the end of each substep. With n substeps the lead is therefore `h (1 - 1/n) / 2`.
    pub(super) fn at_start(physics: &PhysicsSettings) -> Self {
        let mut observation = Self { steps_per_s: physics.steps_per_s, ..Self::default() };
        observation.take_lead(physics);
        observation
    }

    /// Computes the lead for a world with these settings of the engine.
    pub(super) fn take_lead(&mut self, physics: &PhysicsSettings) {
        self.lead_s = (physics.step_s() - physics.substep_s()) / 2.0;
        self.perception.take_step(physics);
    }

    /// Returns the periods of an oscillation that have passed at the moment for which the controller acts. They are computed from the
    /// number of the step instead of summed up, so that no error accumulates.
    pub fn periods(&self, frequency_hz: f32) -> f64 {
        let at_start_s = f64::from(self.step) / f64::from(self.steps_per_s);
        f64::from(frequency_hz) * (at_start_s + f64::from(self.lead_s))
    }

    /// Returns the number of the point of a signal that holds in the step that begins; the first is 0.
    pub fn point(&self, points_per_s: f32) -> usize {
        point_at(self.step, points_per_s, self.steps_per_s)
    }

    /// Returns the state of each joint from the head at the moment for which the controller acts, extrapolated with its present rates;
    /// empty unless the controller needs the joints.
    pub fn joints_ahead(&self) -> impl Iterator<Item = JointState> + '_ {
        self.joints.iter().map(|joint| JointState {
            bend_rad: joint.bend_rad + joint.bend_rad_s * self.lead_s,
            twist_rad: joint.twist_rad + joint.twist_rad_s * self.lead_s,
            ..*joint
        })
    }

    /// Observes the world before a step. Buffers are reused, so that nothing is allocated after the first step.
    pub(super) fn update(
        &mut self,
        step: u32,
        world: &Simulation,
        senses: Senses,
        active: &ActiveSenses,
    ) {
        self.step = step;
        if senses.joints {
            self.joints.clear();
            self.joints.extend(world.joint_states());
        }
        if senses.surroundings {
            self.perception.update(world, &self.joints, active);
        }
        if senses.climb {
            self.climb = world.climb();
        }
    }
}
