//! The selected lane and limb, and the limb that the mouse holds.

use bevy::prelude::*;

use snakes_core::world::Pull;

/// The lane and limb that panels show in detail, and the limb that the mouse holds.
#[derive(Resource, Debug, Default)]
pub(crate) struct Selection {
    /// Selected lane; the first is 0.
    pub lane: usize,
    /// Selected limb of the selected lane; the head is 0. `None` if no limb is selected.
    pub limb: Option<usize>,
    /// Limb that the mouse holds. A drag then moves the limb instead of the camera.
    pub held: Option<HeldLimb>,
}

/// A limb that the mouse holds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HeldLimb {
    /// Lane of the held limb.
    pub lane: Entity,
    /// Start and end point of the pull, in lane coordinates.
    pub pull: Pull,
    /// Where the mouse button was pressed, in pixels.
    pub pressed_at: Vec2,
    /// Whether the pointer has moved far enough for a pull; until then, the press may become a click.
    pub is_pulling: bool,
}

impl Selection {
    /// Returns the pull on a lane, in lane coordinates; `None` without a pull.
    pub fn pull_on(&self, lane: Entity) -> Option<Pull> {
        self.held.filter(|held| held.is_pulling && held.lane == lane).map(|held| held.pull)
    }

    /// Selects a limb of a lane and holds one of its parts.
    pub fn grab(&mut self, lane: usize, limb: usize, held: HeldLimb) {
        (self.lane, self.limb) = (lane, Some(limb));
        self.held = Some(held);
    }
}
