//! The selected lane and limb, and the limb that the mouse holds.

use bevy::prelude::*;

use snakes_core::world::Pull;

/// The lane and limb that panels show in detail, and the limb that the mouse holds.
#[derive(Resource, Debug, Default)]
pub(crate) struct Selection {
    /// The selected lane; the first is 0.
    pub lane: usize,
    /// The selected limb of that lane; the head is 0.
    pub limb: Option<usize>,
    held: Option<HeldLimb>,
}

/// A limb that the mouse holds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HeldLimb {
    /// The lane that the limb belongs to.
    pub lane: Entity,
    /// Where the pull begins and ends, in the lane's own coordinates.
    pub pull: Pull,
    /// Where the button went down, in pixels.
    pub pressed_at: Vec2,
    /// Whether the pointer has moved far enough for a pull; until then the press may be a click.
    pub is_pulling: bool,
}

impl Selection {
    /// The pull on a lane, in its own coordinates.
    pub fn pull_on(&self, lane: Entity) -> Option<Pull> {
        self.held.filter(|held| held.is_pulling && held.lane == lane).map(|held| held.pull)
    }

    /// Whether a limb is held. A drag of the mouse then moves the limb instead of the camera.
    pub fn is_holding(&self) -> bool {
        self.held.is_some()
    }

    /// The limb that is held.
    pub fn held(&self) -> Option<&HeldLimb> {
        self.held.as_ref()
    }

    /// The limb that is held, to be dragged.
    pub fn held_mut(&mut self) -> Option<&mut HeldLimb> {
        self.held.as_mut()
    }

    /// Selects a limb of a lane and holds one of its parts.
    pub fn grab(&mut self, lane: usize, limb: usize, held: HeldLimb) {
        (self.lane, self.limb) = (lane, Some(limb));
        self.held = Some(held);
    }

    /// Lets go of the limb that is held.
    pub fn release(&mut self) {
        self.held = None;
    }

    /// Returns to the first lane, without a limb.
    pub fn reset(&mut self) {
        (self.lane, self.limb) = (0, None);
    }
}
