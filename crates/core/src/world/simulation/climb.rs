//! How far the snake has climbed. Rewards during an episode depend on it.

use super::Simulation;
use crate::world::stair_profile::ClimbProgress;

impl Simulation {
    /// Returns the present progress of the middle part up the stairs.
    pub fn climb(&self) -> ClimbProgress {
        let middle = self.physics.bodies[self.parts[self.body.middle_part]].translation();
        self.profile.climb(middle.to_array())
    }
}
