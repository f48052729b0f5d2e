//! The order of the systems within a frame, and the rate at which results of evolution are processed.

use bevy::prelude::*;

/// Sets of systems in a frame, in this order.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum FrameSet {
    /// Read keys and dropped files, and process what was read from the saves folder.
    TakeIn,
    /// Apply the commands of keys and of the last frame's panels.
    Apply,
    /// Advance the stage to the clock's time.
    Advance,
    /// Draw the stage in its current state.
    Draw,
}

/// Puts the sets of systems in their order.
pub(super) fn plugin(app: &mut App) {
    use FrameSet::{Advance, Apply, Draw, TakeIn};
    app.configure_sets(Update, (TakeIn, Apply, Advance, Draw).chain());
}

/// Rate of `FixedUpdate`, in hertz. Results of evolution are processed at this rate, independently of the frame rate.
pub(crate) const RESULTS_HZ: f64 = 20.0;
