//! Commands to the operating system's file dialogs, file manager and clipboard.

use std::path::PathBuf;

use snakes_core::save::library::SavePlace;
use snakes_lab::export::ExportFormat;

/// A command to the operating system's file dialogs, file manager or clipboard.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FileCommand {
    /// Ask for files or a folder with a file dialog.
    Ask(FileQuestion),
    /// Ask where to export the entries that are selected in the library.
    AskExport,
    /// Process the paths that the user chose in the file dialog.
    Answer(FileQuestion, Vec<PathBuf>),
    /// Show this folder in the file manager.
    OpenFolder(PathBuf),
    /// Write the worksheet of this lesson as a page, and open the page in the browser; the first lesson is 0.
    PrintWorksheet(usize),
    /// Show the folder of saves in the file manager.
    ShowSaves,
    /// Copy the picture in this file to the clipboard.
    CopyPicture(PathBuf),
    /// Copy this path to the clipboard, as text.
    CopyPath(PathBuf),
}

/// A question that the user answers in a file dialog.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FileQuestion {
    /// Choose the champion or run to show on the stage.
    Open,
    /// Choose the champions or the run to copy into the library.
    Import,
    /// Choose the folder into which to copy these entries.
    Export(Vec<SavePlace>),
    /// Choose the file of this format for the champions on the stage. The text is a suggested name without an
    /// extension, the number that of the question.
    Share(ExportFormat, String, u32),
}
