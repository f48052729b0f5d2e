//! Views that cover the window until they are closed.

/// A view that covers the window until it is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Modal {
    /// The list of keyboard shortcuts.
    Keys,
    /// The command palette.
    CommandPalette,
    /// A step of the tour; the first is 0.
    Tour(usize),
    /// The question whether to quit although unfinished work would be lost.
    Quit,
}
