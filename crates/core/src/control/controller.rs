//! The interface of a controller.

use super::{Activity, Observation, Senses, WaveUses};
use crate::learn::Episode;
use crate::world::JointTorque;

/// Turns observations into torques, step after step.
///
/// It may keep state between steps. The state is part of a clone: keyframes and replays go on with the bits of
/// the original.
pub trait Controller: CloneController + Send + Sync {
    /// The senses it needs, the same in every step; none unless it says so.
    fn needs(&self) -> Senses {
        Senses::default()
    }

    /// Writes the torques of the step that begins, one per joint from the head. They are clamped to the joints'
    /// limits later.
    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]);

    /// How often it chose each wave of its library; none if it has none.
    fn wave_uses(&self) -> Option<WaveUses> {
        None
    }

    /// Its state for display: as it acted last, in the joint of this number where each has a network of its
    /// own. None before the first step, and for a controller that has nothing to show.
    fn activity(&self, _observation: &Observation, _joint: usize) -> Option<Activity> {
        None
    }

    /// Ends the episode after the last step: the experience of a controller that learns from it.
    fn finish(&mut self, _observation: &Observation, _is_disqualified: bool) -> Option<Episode> {
        None
    }
}

/// A controller that can be copied, whatever its type is. Every controller with `Clone` is one.
pub trait CloneController {
    /// A copy with the same state.
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
