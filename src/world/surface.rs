//! What the snake crawls on.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};

/// The material of the ground and the stairs.
///
/// The snake's own material is neutral (friction 1, no bounce) and the surface's combine rules win,
/// so the numbers here are the contact's numbers: friction multiplies by one, bounce takes the larger.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Coulomb coefficient: the largest tangential force over the normal force.
    pub friction: f32,
    /// Restitution, from 0 (no bounce) to 1 (all of the speed comes back).
    pub bounce: f32,
}

impl Default for Surface {
    fn default() -> Self {
        Self { friction: 1.0, bounce: 0.0 }
    }
}

impl Surface {
    /// Checks every field against its range. The friction's upper end lets in the 150 of the
    /// report's engine manual.
    pub fn check(&self) -> Result<(), Invalid> {
        within("friction", self.friction, 0.0..=1000.0)?;
        within("bounce", self.bounce, 0.0..=1.0)
    }
}
