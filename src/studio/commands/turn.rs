//! The turns of the presenting mode.

/// A step through the champions that the presenting mode shows in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turn {
    /// The next champion; after the last, the first.
    Next,
    /// The champion before this one; before the first, the last.
    Previous,
    /// The first.
    First,
}
