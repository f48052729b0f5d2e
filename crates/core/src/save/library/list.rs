//! Listing of a folder of saves by names only.

use std::collections::BTreeSet;
use std::fs::{self, DirEntry};
use std::path::PathBuf;
use std::time::Duration;

use super::name::{NOTES_ENDING, notes_beside};
use super::notes::read_notes;
use super::place::SavePlace;
use super::shipped::SHIPPED;
use crate::save::files::modified;
use crate::save::plan::is_run;
use crate::save::record::LOG_FILE;
use crate::save::{EntryNotes, SaveError, SavesFolder};

/// A library entry, without its contents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LibraryEntry {
    /// Place of the entry.
    pub place: SavePlace,
    /// Size of the champion's file or of the run's log, in bytes.
    pub bytes: u64,
    /// Time of the last change since the beginning of 1970 (UTC); zero for a part of the program.
    pub modified: Duration,
    /// The user's name and notes, or the reason why they cannot be read.
    pub notes: Result<EntryNotes, String>,
}

/// Lists the champions and runs in a folder of saves by name, and the champions that are part of the program unless a file has the same
/// name. If the folder does not exist, it counts as empty.
///
/// # Errors
/// Fails if the folder cannot be read.
pub fn list(saves: &SavesFolder) -> Result<Vec<LibraryEntry>, SaveError> {
    let folder = saves.path();
    let unreadable = SaveError::unreadable(folder);
    let mut entries = match fs::read_dir(folder) {
        // Entries that vanish during the listing are omitted.
        Ok(found) => {
            let found: Vec<DirEntry> = found.flatten().collect();
            // The names of all files of notes are collected first, so that no file is searched for a champion without notes.
            let is_notes = |path: &PathBuf| path.extension().is_some_and(|of| of == NOTES_ENDING);
            let notes = found.iter().map(DirEntry::path).filter(is_notes).collect();
            found.iter().filter_map(|found| entry_of(found, &notes)).collect()
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
        Err(error) => return Err(unreadable(error)),
    };
    let shipped = SHIPPED.iter().map(|(name, text)| LibraryEntry {
        place: SavePlace::Shipped(name),
        bytes: text.len() as u64,
        modified: Duration::ZERO,
        notes: Ok(EntryNotes::default()),
    });
    entries.extend(shipped.filter(|entry| {
        folder.join(format!("{}.ron", entry.place.name())).symlink_metadata().is_err()
    }));
    entries.sort_by(|a: &LibraryEntry, b| a.place.cmp(&b.place));
    Ok(entries)
}

/// Returns the library entry of a file or folder. None if it is neither a champion's file nor a run's folder, or if its name begins with a
/// dot. `notes` are the paths of champions' notes in the folder.
fn entry_of(found: &DirEntry, notes: &BTreeSet<PathBuf>) -> Option<LibraryEntry> {
    let (name, path) = (found.file_name(), found.path());
    if name.as_encoded_bytes().starts_with(b".") {
        return None;
    }
    let kind = found.file_type().ok()?;
    if kind.is_dir() {
        is_run(&path).then_some(())?;
        let own = found.metadata().ok()?;
        // The time of the folder changes only with the names in it, the time of the log with every generation.
        let log = path.join(LOG_FILE).symlink_metadata();
        let bytes = log.as_ref().map_or(0, fs::Metadata::len);
        let modified = log.map_or(Duration::ZERO, |log| modified(&log)).max(modified(&own));
        let place = SavePlace::Run(path);
        let notes = notes_of(&place);
        return Some(LibraryEntry { place, bytes, modified, notes });
    }
    if path.extension().is_none_or(|extension| extension != "ron") {
        return None;
    }
    // A link is listed, but reading its contents gives an error.
    let own = found.metadata().ok()?;
    let is_noted = notes.contains(&notes_beside(&path));
    let place = SavePlace::Champion(path);
    let notes = if is_noted { notes_of(&place) } else { Ok(EntryNotes::default()) };
    Some(LibraryEntry { place, bytes: own.len(), modified: modified(&own), notes })
}

fn notes_of(place: &SavePlace) -> Result<EntryNotes, String> {
    read_notes(place).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::fixtures::{names, run_in, saves};

    #[test]
    fn only_champions_and_runs_are_listed() {
        let (folder, saves) = saves();
        for name in ["b.ron", "a.ron", ".hidden.ron", "notes.txt"] {
            fs::write(folder.path().join(name), "whatever").expect("written");
        }
        for name in ["pictures", "exports", ".deleted"] {
            fs::create_dir(folder.path().join(name)).expect("created");
        }
        let run = run_in(&saves, 1);
        let own = |entries: &[LibraryEntry]| names(entries, |place| place.path().is_some());
        let entries = list(&saves).expect("readable");
        assert_eq!(own(&entries), ["a", "b", &run.name()]);
        assert_eq!(entries.iter().filter(|entry| entry.place == run).count(), 1);
        let a = entries.iter().find(|entry| entry.place.name() == "a").expect("listed");
        assert_eq!(a.bytes, 8);
        // The modification time is after the year 2019.
        assert!(a.modified > Duration::from_secs(1_577_836_800));
    }

    #[test]
    fn a_shipped_champion_is_listed_unless_a_file_has_its_name() {
        let (folder, saves) = saves();
        let shipped = || {
            names(&list(&saves).expect("readable"), |place| matches!(place, SavePlace::Shipped(_)))
        };
        assert_eq!(shipped().len(), SHIPPED.len());
        fs::write(folder.path().join("climber.ron"), "mine").expect("written");
        assert_eq!(shipped().len(), SHIPPED.len() - 1);
        assert!(!shipped().contains(&"climber".to_owned()));
    }

    #[test]
    fn a_missing_folder_is_empty_and_a_file_in_its_place_is_an_error() {
        let (folder, _) = saves();
        let missing = SavesFolder::find(Some(&folder.path().join("not yet")));
        assert_eq!(list(&missing).expect("empty").len(), SHIPPED.len());
        let file = folder.path().join("file");
        fs::write(&file, "").expect("written");
        let error = list(&SavesFolder::find(Some(&file))).expect_err("no folder").to_string();
        assert!(error.contains("file: cannot be read"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_run_is_not_listed() {
        let (folder, saves) = saves();
        let (elsewhere, others) = super::super::fixtures::saves();
        let run = run_in(&others, 1);
        let linked = folder.path().join("linked");
        std::os::unix::fs::symlink(run.path().expect("a folder"), linked).expect("linked");
        assert!(names(&list(&saves).expect("readable"), |place| place.run().is_some()).is_empty());
        drop(elsewhere);
    }
}
