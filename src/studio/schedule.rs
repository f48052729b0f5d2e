//! The order of the systems within a frame.

use bevy::prelude::*;

/// Sets of systems in a frame, in this order.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum FrameSet {
    /// Take over results of the background run.
    TakeIn,
    /// Apply the commands of keys and of the last frame's panels.
    Apply,
    /// Advance the stage to the clock's time.
    Advance,
    /// Draw the stage in its current state.
    Draw,
}
