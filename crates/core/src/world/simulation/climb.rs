//! How far the snake has climbed, for rewards during an episode.

use super::Simulation;
use crate::world::stair_profile::ClimbProgress;

impl Simulation {
    /// The progress at this moment.
    pub fn climb(&self) -> ClimbProgress {
        let middle = self.physics.bodies[self.parts[self.body.middle_part]].translation();
        self.profile.climb(middle.to_array())
    }
}
