//! How far the snake has climbed, for rewards during an episode.

use super::Simulation;

/// The progress of the middle limb up the stairs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Climb {
    /// Steps under it.
    pub steps: u32,
    /// Its y, in metres; without a step under it at most that of the first riser.
    pub way_m: f32,
    /// Depth of a step, in metres.
    pub tread_m: f32,
    /// Whether all steps are under it.
    pub is_on_landing: bool,
}

impl Simulation {
    /// The progress at this moment.
    pub fn climb(&self) -> Climb {
        let middle = self.physics.bodies[self.limbs[self.body.middle_limb()]].translation();
        self.profile.climb(middle.to_array())
    }
}
