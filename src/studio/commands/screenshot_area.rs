//! The part of the window that a screenshot shows.

use bevy::prelude::*;

/// The part of the window to save as a picture.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ScreenshotArea {
    /// Only the stage, without panels.
    Stage,
    /// The whole window.
    Window,
}
