//! Commands to share the champions on the stage as a file of another format.

use snakes_lab::export::ExportFormat;

/// A command about sharing the champions on the stage as a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ShareCommand {
    /// Ask where to save a file of this format, and write it.
    Ask(ExportFormat),
    /// Cancel the file that is being written.
    Cancel,
}
