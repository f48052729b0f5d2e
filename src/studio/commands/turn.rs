//! The steps through the champions in the presenting mode.

/// A step through the champions that the presenting mode shows one after another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turn {
    /// Show the next champion; after the last, show the first.
    Next,
    /// Show the previous champion; before the first, show the last.
    Previous,
    /// Show the first champion.
    First,
}
