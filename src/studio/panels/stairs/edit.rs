//! Changes of the stairs.

use snakes_core::world::Stairs;

/// A change of the stairs by one of the panel's parts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StairsEdit {
    /// The stairs after it.
    pub stairs: Stairs,
    /// Whether it is complete, or a drag is still going on.
    pub is_complete: bool,
}

impl StairsEdit {
    /// A change that is complete.
    pub fn complete(stairs: Stairs) -> Self {
        Self { stairs, is_complete: true }
    }
}
