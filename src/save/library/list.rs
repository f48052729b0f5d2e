//! What is in a folder of saves, by names alone.

use std::fs::{self, DirEntry};
use std::path::{Path, PathBuf};
use std::time::{Duration, UNIX_EPOCH};

use super::shipped::SHIPPED;
use crate::save::plan::RUN_FILE;
use crate::save::record::LOG_FILE;
use crate::save::{SaveError, SavesFolder};

/// Where an entry of the library is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// A champion that is part of the program, by its name: it can be read, not changed.
    Shipped(&'static str),
    /// A champion's file.
    Champion(PathBuf),
    /// A run's folder.
    Run(PathBuf),
}

impl Place {
    /// What it is called: the file's name without its ending, or the folder's.
    pub fn name(&self) -> String {
        let part = match self {
            Self::Shipped(name) => return (*name).to_owned(),
            Self::Champion(path) => path.file_stem(),
            Self::Run(path) => path.file_name(),
        };
        part.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Its file or folder, if it has one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Shipped(_) => None,
            Self::Champion(path) | Self::Run(path) => Some(path),
        }
    }

    /// The folder, if it is a run's.
    pub fn run(&self) -> Option<&Path> {
        match self {
            Self::Run(path) => Some(path),
            Self::Shipped(_) | Self::Champion(_) => None,
        }
    }
}

/// An entry of the library, as far as its name tells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Where it is.
    pub place: Place,
    /// Size of its file, in bytes; of a run's folder that of its log, which grows with every generation.
    pub bytes: u64,
    /// When it was last changed, since the beginning of 1970 (UTC); nothing for what is part of the program.
    pub modified: Duration,
}

/// Lists a folder of saves by name: champions' files, runs' folders, and those champions that are part of the
/// program and have no file of their name there. A folder that is not there yet is empty.
///
/// # Errors
/// The folder cannot be read.
pub fn list(saves: &SavesFolder) -> Result<Vec<Entry>, SaveError> {
    let folder = saves.path();
    let unreadable = |source| SaveError::Unreadable { path: folder.to_owned(), source };
    let mut entries = match fs::read_dir(folder) {
        // What goes while it is listed is not there.
        Ok(found) => found.flatten().filter_map(|found| entry_of(&found)).collect(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
        Err(error) => return Err(unreadable(error)),
    };
    let shipped = SHIPPED.iter().map(|(name, text)| Entry {
        place: Place::Shipped(name),
        bytes: text.len() as u64,
        modified: Duration::ZERO,
    });
    entries.extend(shipped.filter(|entry| {
        folder.join(format!("{}.ron", entry.place.name())).symlink_metadata().is_err()
    }));
    entries.sort_by(|a: &Entry, b| a.place.cmp(&b.place));
    Ok(entries)
}

/// What a name in the folder stands for, if it is for the library. What begins with a dot is hidden.
fn entry_of(found: &DirEntry) -> Option<Entry> {
    let (name, path) = (found.file_name(), found.path());
    if name.as_encoded_bytes().starts_with(b".") {
        return None;
    }
    let kind = found.file_type().ok()?;
    if kind.is_dir() {
        path.join(RUN_FILE).symlink_metadata().ok()?;
        let own = found.metadata().ok()?;
        // A folder changes with its files' names, its log with every generation.
        let log = path.join(LOG_FILE).symlink_metadata();
        let bytes = log.as_ref().map_or(0, fs::Metadata::len);
        let modified = log.map_or(Duration::ZERO, |log| changed(&log)).max(changed(&own));
        return Some(Entry { place: Place::Run(path), bytes, modified });
    }
    if path.extension().is_none_or(|extension| extension != "ron") {
        return None;
    }
    // Of a link itself: it is listed, and says when it is read that it is one.
    let own = found.metadata().ok()?;
    Some(Entry { place: Place::Champion(path), bytes: own.len(), modified: changed(&own) })
}

/// Since the beginning of 1970.
fn changed(about: &fs::Metadata) -> Duration {
    let modified = about.modified().ok();
    modified.and_then(|at| at.duration_since(UNIX_EPOCH).ok()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::fixtures::{names, run_in, saves};

    #[test]
    fn champions_and_runs_are_listed_and_nothing_else() {
        let (folder, saves) = saves();
        for name in ["b.ron", "a.ron", ".hidden.ron", "notes.txt"] {
            fs::write(folder.path().join(name), "whatever").expect("written");
        }
        for name in ["pictures", "exports", ".deleted"] {
            fs::create_dir(folder.path().join(name)).expect("created");
        }
        let run = run_in(&saves, 1);
        let own = |entries: &[Entry]| names(entries, |place| place.path().is_some());
        let entries = list(&saves).expect("readable");
        assert_eq!(own(&entries), ["a", "b", &run.name()]);
        assert_eq!(entries.iter().filter(|entry| entry.place == run).count(), 1);
        let a = entries.iter().find(|entry| entry.place.name() == "a").expect("listed");
        assert_eq!(a.bytes, 8);
        // The year 2020 is past.
        assert!(a.modified > Duration::from_secs(1_577_836_800));
    }

    #[test]
    fn what_comes_with_the_program_is_listed_unless_the_folder_has_one_of_its_name() {
        let (folder, saves) = saves();
        let shipped =
            || names(&list(&saves).expect("readable"), |place| matches!(place, Place::Shipped(_)));
        assert_eq!(shipped().len(), SHIPPED.len());
        fs::write(folder.path().join("climber.ron"), "mine").expect("written");
        assert_eq!(shipped().len(), SHIPPED.len() - 1);
        assert!(!shipped().contains(&"climber".to_owned()));
    }

    #[test]
    fn a_folder_that_is_not_there_yet_is_empty_and_a_file_in_its_place_is_an_error() {
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
    fn a_link_to_a_folder_is_no_run() {
        let (folder, saves) = saves();
        let (elsewhere, others) = super::super::fixtures::saves();
        let run = run_in(&others, 1);
        let linked = folder.path().join("linked");
        std::os::unix::fs::symlink(run.path().expect("a folder"), linked).expect("linked");
        assert!(names(&list(&saves).expect("readable"), |place| place.run().is_some()).is_empty());
        drop(elsewhere);
    }
}
