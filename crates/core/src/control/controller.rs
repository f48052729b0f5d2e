//! The trait that every controller implements.

use super::{Activity, Observation, Senses, WaveUses};
use crate::learn::Episode;
use crate::world::JointTorque;

/// Turns observations into torques, step after step.
///
/// A controller may keep state between steps. The state is part of a clone, so that keyframes and replays continue with the same bits as
/// the original.
pub trait Controller: CloneController + Send + Sync {
    /// Returns the senses that the controller needs, the same in every step; by default none.
    fn needs(&self) -> Senses {
        Senses::default()
    }

    /// Writes the torques of the step that begins, one per joint from the head. They are clamped to the joints' limits afterwards.
    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]);

    /// Returns how often the controller chose each wave of its library; `None` without a library.
    fn wave_uses(&self) -> Option<WaveUses> {
        None
    }

    /// Returns the state of the controller for display, as in its last step; where each joint has a network of its own, for this joint.
    /// `None` before the first step, and for a controller that has nothing to show.
    fn activity(&self, _observation: &Observation, _joint: usize) -> Option<Activity> {
        None
    }

    /// Ends the episode after the last step and returns the experience of a controller that learns from it; otherwise `None`.
    fn finish(&mut self, _observation: &Observation, _is_disqualified: bool) -> Option<Episode> {
        None
    }
}

/// A controller that can be copied, whatever its type is. Every controller that implements `Clone` implements this trait, too.
pub trait CloneController {
    /// Returns a copy with the same state.
    fn boxed_clone(&self) -> Box<dyn Controller>;
}

impl<T: Controller + Clone + 'static> CloneController for T {
    fn boxed_clone(&self) -> Box<dyn Controller> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn Controller> {
    fn clone(&self) -> Self {
        self.as_ref().boxed_clone()
    }
}
