//! Moving of files and folders without overwriting any; champions are moved together with their notes.

use std::fs::{self, OpenOptions};
use std::io::ErrorKind;
use std::path::Path;

use super::name::notes_beside;
use crate::check::Invalid;
use crate::save::SaveError;

/// Makes the error that a name is taken.
pub fn taken(path: &Path) -> SaveError {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let source = Invalid::new("name", format!("{name:?}"), "a name that is not taken yet");
    SaveError::Invalid { path: path.to_owned(), source }
}

/// Moves a file or folder to a path that must be free.
pub fn move_new(from: &Path, to: &Path) -> Result<(), SaveError> {
    let unwritable = SaveError::unwritable(to);
    let about = fs::symlink_metadata(from).map_err(SaveError::unreadable(from))?;
    if about.is_dir() {
        if to.symlink_metadata().is_ok() {
            return Err(taken(to));
        }
        // A folder that appears at the path between the check and the move is replaced only if it is empty.
        return fs::rename(from, to).map_err(unwritable);
    }
    // A rename would replace a file, so the name is reserved first.
    match OpenOptions::new().write(true).create_new(true).open(to) {
        Ok(reserved) => drop(reserved),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Err(taken(to)),
        Err(error) => return Err(unwritable(error)),
    }
    fs::rename(from, to).map_err(|source| {
        // The reservation, an empty file, is removed.
        let _ = fs::remove_file(to);
        unwritable(source)
    })
}

/// Moves an entry: a run's folder, or a champion's file with the notes beside it. If the notes cannot be moved, the file is moved back.
pub fn move_entry(from: &Path, to: &Path) -> Result<(), SaveError> {
    let is_folder = from.is_dir();
    move_new(from, to)?;
    let notes = notes_beside(from);
    if is_folder || notes.symlink_metadata().is_err() {
        return Ok(());
    }
    move_new(&notes, &notes_beside(to)).inspect_err(|_| {
        // The error of the notes is reported; an error of moving back is ignored.
        let _ = move_new(to, from);
    })
}
