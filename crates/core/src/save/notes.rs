//! Names and notes that the user gives to saves: format 1, in a separate small file beside a champion, or in the folder of a run. Replays
//! do not read these files, so notes cannot change a replay.
//!
//! The name of a champion is that of its file. A run, whose folder's name identifies it, has a name in its notes instead.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_bytes, refuse_link, store_ron, text_of};
use crate::check::{Invalid, quoted};

const KIND: &str = "snakes-and-stairs notes";
const FORMAT: u32 = 1;
/// Maximum length of a run's name, in characters.
pub const MAX_NAME_CHARS: usize = 100;
/// Maximum length of notes, in characters: about a page of text.
const MAX_NOTES_CHARS: usize = 4000;
/// Maximum size of a file of notes, in MiB.
const LARGEST_MIB: u64 = 1;

/// The user's name and notes for a save; both may be empty.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct EntryNotes {
    /// Name of a run. If it is empty, the name of the folder is shown.
    pub name: String,
    /// Text of the notes, which may have several lines.
    pub text: String,
}

#[derive(Serialize, Deserialize)]
struct NotesFile {
    kind: String,
    format: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    notes: String,
}

/// Returns the path of the notes in a run's folder.
pub fn notes_in_run(folder: &Path) -> PathBuf {
    folder.join("about.ron")
}

impl EntryNotes {
    /// Reads a file of notes. Returns empty notes if the file does not exist.
    ///
    /// # Errors
    /// Fails if the file is unreadable, damaged, a link, or of another kind or format.
    pub fn load(path: &Path) -> Result<Self, SaveError> {
        match path.symlink_metadata() {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Self::default()),
            _ => refuse_link(path).map_err(SaveError::unreadable(path))?,
        }
        let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
        Header::check(path, &text, KIND, FORMAT)?;
        let NotesFile { name, notes, .. } = parse(path, &text)?;
        let notes = Self { name, text: notes };
        notes.check().map_err(SaveError::invalid(path))?;
        Ok(notes)
    }

    /// Writes a file of notes, or removes it if the notes are empty. Returns the notes that it had before.
    ///
    /// # Errors
    /// Fails if name or notes are not allowed, if the present notes are damaged and would be lost, or if the file cannot be written.
    pub fn store(&self, path: &Path) -> Result<Self, SaveError> {
        self.check().map_err(SaveError::invalid(path))?;
        let before = Self::load(path)?;
        if !self.is_empty() {
            let (name, notes) = (self.name.clone(), self.text.clone());
            let file = NotesFile { kind: KIND.to_owned(), format: FORMAT, name, notes };
            store_ron(path, &file)?;
        } else if !before.is_empty() {
            fs::remove_file(path).map_err(SaveError::unwritable(path))?;
        }
        Ok(before)
    }

    /// Returns whether there is neither a name nor a text.
    pub fn is_empty(&self) -> bool {
        self.name.is_empty() && self.text.is_empty()
    }

    /// Returns the name. None if it is empty.
    pub fn own_name(&self) -> Option<&str> {
        Some(self.name.as_str()).filter(|name| !name.is_empty())
    }

    fn check(&self) -> Result<(), Invalid> {
        if !self.name.is_empty() {
            check_run_name(&self.name)?;
        }
        check_notes(&self.text)
    }
}

/// Checks the name of a run. The name is not used for files, so it may have any visible characters.
///
/// # Errors
/// Fails if the name is empty or too long, has a control character, or has spaces at its ends.
pub fn check_run_name(name: &str) -> Result<(), Invalid> {
    let characters = name.chars().count();
    if !(1..=MAX_NAME_CHARS).contains(&characters) {
        let allowed = format!("1 to {MAX_NAME_CHARS} characters");
        return Err(Invalid::new("name", format!("{characters} characters long"), allowed));
    }
    if name.chars().any(char::is_control) {
        let allowed = "a name without line breaks and control characters";
        return Err(Invalid::new("name", quoted(name), allowed));
    }
    if name.trim() != name {
        return Err(Invalid::new("name", quoted(name), "a name without spaces at its ends"));
    }
    Ok(())
}

/// Checks the text of notes.
///
/// # Errors
/// Fails if the text is too long, or has control characters other than line breaks and tabs.
pub fn check_notes(text: &str) -> Result<(), Invalid> {
    let characters = text.chars().count();
    if characters > MAX_NOTES_CHARS {
        let allowed = format!("up to {MAX_NOTES_CHARS} characters");
        return Err(Invalid::new("notes", format!("{characters} characters long"), allowed));
    }
    if text.chars().any(|c| c.is_control() && !"\n\t".contains(c)) {
        return Err(Invalid::new("notes", quoted(text), "text without control characters"));
    }
    Ok(())
}
