//! Commands to the system: its dialogs for files, its file manager and its clipboard.

use std::path::PathBuf;

use snakes_core::save::library::SavePlace;
use snakes_lab::export::ExportFormat;

/// A command to the system.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FileCommand {
    /// Ask for files or a folder with the system's dialog.
    Ask(FileQuestion),
    /// Ask where to export what is selected in the library.
    AskExport,
    /// Carry out what the answer to a question asks for.
    Answer(FileQuestion, Vec<PathBuf>),
    /// Show this folder in the system's file manager.
    OpenFolder(PathBuf),
    /// Show the folder of saves in the system's file manager.
    ShowSaves,
    /// Copy the picture in this file to the clipboard.
    CopyPicture(PathBuf),
    /// Copy this path to the clipboard, as text.
    CopyPath(PathBuf),
}

/// A question that the system's dialog for files answers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FileQuestion {
    /// Which champion or run to show on the stage.
    Open,
    /// Which champions or run to copy into the library.
    Import,
    /// Into which folder to copy these entries.
    Export(Vec<SavePlace>),
    /// Into which file of this format to write the champions on the stage; the name is a suggestion, without its ending.
    Share(ExportFormat, String),
}
