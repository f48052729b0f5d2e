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
