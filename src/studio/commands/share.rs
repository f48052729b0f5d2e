//! Commands to share the champions on the stage as a file of another format.

use snakes_lab::export::ExportFormat;

/// A command to share what is on the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ShareCommand {
    /// Ask for a file of this format, and write it.
    Ask(ExportFormat),
    /// Cancel what is being written.
    Cancel,
}
