//! Changes of the stairs.

use snakes_core::world::Stairs;

/// A change of the stairs that the drawing or the table returns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StairsEdit {
    /// Stairs after the change.
    pub stairs: Stairs,
    /// Whether the change is complete, rather than part of a drag in progress.
    pub is_complete: bool,
}

impl StairsEdit {
    /// Creates a change that is complete.
    pub fn complete(stairs: Stairs) -> Self {
        Self { stairs, is_complete: true }
    }
}

/// Response of the drawing and the table to the pointer.
#[derive(Debug, Default)]
pub(super) struct StairsResponse {
    /// Step whose edge or row is under the pointer; the lowest is 0.
    pub pointed: Option<u32>,
    /// Change of the stairs, if any.
    pub edit: Option<StairsEdit>,
}
