//! Operations on a library entry that can be undone: rename, duplicate, delete, restore.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::details::{path_in_errors, text_of_champion};
use super::moving::{move_entry, taken};
use super::name::{ENDING, check_entry_name, free_path, is_free, notes_beside, shortened};
use super::notes::{add_copy, name_run, set_notes};
use super::place::SavePlace;
use crate::check::Invalid;
use crate::save::lock::Lock;
use crate::save::whole_file::prepare_folder;
use crate::save::{EntryNotes, SaveError, SavesFolder, within_run};

/// Name of the folder for deleted entries within a folder of saves.
pub const DELETED: &str = ".deleted";

/// A completed operation on a library entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileStep {
    /// The entry was renamed.
    Renamed {
        /// Former path of the entry.
        from: PathBuf,
        /// New path of the entry.
        to: PathBuf,
    },
    /// The entry was deleted: moved into a hidden folder.
    Deleted {
        /// Former path of the entry.
        from: PathBuf,
        /// Path of the entry in the hidden folder.
        kept: PathBuf,
    },
    /// The entry was restored after it had been deleted.
    Restored {
        /// Path of the entry before it was deleted.
        wanted: PathBuf,
        /// Present path of the entry, which differs from the former path if that was taken meanwhile.
        to: PathBuf,
    },
    /// A new copy of an entry was added.
    Added {
        /// Path of the copy.
        path: PathBuf,
    },
    /// The entry got another name in its notes, or other notes.
    Noted {
        /// Place of the entry, which has not changed.
        place: SavePlace,
        /// Name and notes of the entry before the operation.
        before: EntryNotes,
    },
}

impl FileStep {
    /// Undoes this operation. Returns the operation that redoes it.
    ///
    /// # Errors
    /// Fails if the entry cannot be moved back or no longer exists; nothing has changed then.
    pub fn undo(&self, saves: &SavesFolder) -> Result<Self, SaveError> {
        match self {
            Self::Renamed { from, to } => {
                move_entry(to, from)?;
                Ok(Self::Renamed { from: to.clone(), to: from.clone() })
            }
            Self::Deleted { from, kept } => restore(kept, from),
            Self::Restored { to: path, .. } | Self::Added { path } => move_away(saves, path),
            Self::Noted { place, before } => set_notes(place, before),
        }
    }

    /// Returns the present place of the entry. None if the entry was deleted.
    pub fn place(&self) -> Option<SavePlace> {
        let path = match self {
            Self::Renamed { to, .. } | Self::Restored { to, .. } | Self::Added { path: to } => to,
            Self::Noted { place, .. } => return Some(place.clone()),
            Self::Deleted { .. } => return None,
        };
        Some(if path.is_dir() {
            SavePlace::Run(path.clone())
        } else {
            SavePlace::Champion(path.clone())
        })
    }
}

/// Renames a champion's file, or gives a run a name in its notes. The run's folder, whose name identifies the run, is not renamed.
///
/// # Errors
/// Fails if the name is not allowed or is taken, if the entry is part of the program, or if the file cannot be renamed or written.
pub fn rename(place: &SavePlace, name: &str) -> Result<FileStep, SaveError> {
    let from = match place {
        SavePlace::Champion(from) => from,
        SavePlace::Run(_) => return name_run(place, name),
        SavePlace::Shipped(_) => {
            return Err(refused(place, "a champion's file or a run can be renamed"));
        }
    };
    check_entry_name(name).map_err(SaveError::invalid(from))?;
    let to = from.with_file_name(format!("{name}.{ENDING}"));
    // Notes of a removed file may remain. They must not become notes of the renamed champion.
    if notes_beside(&to).symlink_metadata().is_ok() {
        return Err(taken(&to));
    }
    move_entry(from, &to)?;
    Ok(FileStep::Renamed { from: from.clone(), to })
}

/// Copies a champion within the folder of saves, as "NAME copy", "NAME copy 2" and so on.
///
/// # Errors
/// Fails if the entry is a run, if the file cannot be read, or if the copy cannot be written.
pub fn duplicate(saves: &SavesFolder, place: &SavePlace) -> Result<FileStep, SaveError> {
    let text = text_of_champion(place)?;
    // The folder is prepared only if it does not exist, because preparing writes a test file, which is slow for ten thousand copies.
    if !saves.path().is_dir() {
        saves.prepare()?;
    }
    let name = shortened(&place.name(), " copy");
    let path = free_path(saves.path(), &name, Some(ENDING));
    add_copy(&text, place.path(), path)
}

/// Deletes an entry: moves it into a hidden folder of the saves, or of its own folder if that is on another disk. Undoing moves it back.
///
/// # Errors
/// Fails if a program writes into the run's folder, if the entry is part of the program, or if it cannot be moved.
pub fn delete(saves: &SavesFolder, place: &SavePlace) -> Result<FileStep, SaveError> {
    let path = place.path().ok_or_else(|| refused(place, "a champion's file or a run's folder"))?;
    move_away(saves, path)
}

fn move_away(saves: &SavesFolder, path: &Path) -> Result<FileStep, SaveError> {
    match put_into_bin(saves.path(), path) {
        // Files cannot be moved between disks, so an exported copy on another disk is moved within its own folder.
        Err(SaveError::Unwritable { source, .. }) if source.kind() == ErrorKind::CrossesDevices => {
            put_into_bin(path.parent().unwrap_or(Path::new(".")), path)
        }
        other => other,
    }
}

/// Moves a file or folder into the hidden folder within `folder`.
fn put_into_bin(folder: &Path, path: &Path) -> Result<FileStep, SaveError> {
    let is_folder = fs::symlink_metadata(path).map_err(SaveError::unreadable(path))?.is_dir();
    let lock = if is_folder { Some(Lock::take(path, "the library")?) } else { None };
    let bin = within_run(folder, DELETED)?;
    // The folder is tested only when it is created. If it cannot be written later, the move itself fails.
    if !bin.is_dir() {
        prepare_folder(&bin)?;
    }
    let kept = free_path_like(path, is_folder, &bin);
    if cfg!(windows) {
        // Windows cannot move a folder in which a file is open, so the lock is released first.
        drop(lock);
        move_entry(path, &kept)?;
    } else {
        move_entry(path, &kept)?;
        drop(lock);
    }
    Ok(FileStep::Deleted { from: path.to_owned(), kept })
}

/// Returns a free path in `folder` for an entry with the name of `path`.
fn free_path_like(path: &Path, is_folder: bool, folder: &Path) -> PathBuf {
    let name = path.file_stem().filter(|_| !is_folder).or(path.file_name()).unwrap_or_default();
    let ending = path.extension().filter(|_| !is_folder).map(|ending| ending.to_string_lossy());
    free_path(folder, &name.to_string_lossy(), ending.as_deref())
}

/// Moves a deleted entry back to its path, or to the next free name if the path is taken by now.
fn restore(kept: &Path, wanted: &Path) -> Result<FileStep, SaveError> {
    let folder = wanted.parent().unwrap_or(Path::new("."));
    let is_folder = kept.is_dir();
    let to = if is_free(wanted, is_folder) {
        wanted.to_owned()
    } else {
        free_path_like(wanted, is_folder, folder)
    };
    move_entry(kept, &to)?;
    Ok(FileStep::Restored { wanted: wanted.to_owned(), to })
}

fn refused(place: &SavePlace, allowed: &str) -> SaveError {
    let found = match place {
        SavePlace::Shipped(_) => "built-in",
        SavePlace::Champion(_) => "a champion",
        SavePlace::Run(_) => "a run",
    };
    let source = Invalid::new("entry", found, allowed);
    SaveError::Invalid { path: path_in_errors(place), source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::fixtures::{champion_in, names, run_in, saves};
    use crate::save::library::{list, read_entry};

    /// Returns the names of the champions in the folder.
    fn champions(saves: &SavesFolder) -> Vec<String> {
        names(&list(saves).expect("readable"), |place| matches!(place, SavePlace::Champion(_)))
    }

    #[test]
    fn a_rename_is_undone_and_redone() {
        let (_folder, saves) = saves();
        let place = champion_in(&saves, "first");
        let step = rename(&place, "My best, no. 2").expect("renamed");
        assert_eq!(champions(&saves), ["My best, no. 2"]);
        let back = step.undo(&saves).expect("undone");
        assert_eq!(champions(&saves), ["first"]);
        back.undo(&saves).expect("done again");
        assert_eq!(champions(&saves), ["My best, no. 2"]);
    }

    #[test]
    fn a_taken_or_invalid_name_is_refused_and_nothing_changes() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "first");
        fs::write(folder.path().join("second.ron"), "mine").expect("written");
        let refusal = |name: &str| rename(&place, name).expect_err("refused").to_string();
        assert!(
            refusal("second")
                .ends_with("name is \"second\"; allowed: a name that is not taken yet")
        );
        assert!(
            refusal(&"x".repeat(300))
                .ends_with("name is 300 characters long; allowed: 1 to 100 characters")
        );
        assert!(refusal("a/b").contains("without the characters"));
        assert!(refusal("../out").contains("dot"));
        assert_eq!(champions(&saves), ["first", "second"]);
        let kept = fs::read_to_string(folder.path().join("second.ron")).expect("there");
        assert_eq!(kept, "mine");
    }

    #[test]
    fn runs_cannot_be_duplicated_and_shipped_champions_cannot_be_changed() {
        let (_folder, saves) = saves();
        let run = run_in(&saves, 1);
        let shipped = SavePlace::Shipped("fast");
        let says = |result: Result<FileStep, SaveError>, words: &str| {
            let message = result.expect_err("refused").to_string();
            assert!(message.contains(words), "{message}");
        };
        says(duplicate(&saves, &run), "entry is a run; allowed: a champion's file");
        says(rename(&shipped, "other"), "entry is built-in");
        says(delete(&saves, &shipped), "a champion's file or a run's folder");
    }

    #[test]
    fn copies_are_numbered_and_identical() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        for expected in ["a copy", "a copy 2", "a copy 3"] {
            let step = duplicate(&saves, &place).expect("copied");
            assert_eq!(step.place().expect("there").name(), expected);
        }
        let bytes = |name: &str| fs::read(folder.path().join(name)).expect("there");
        assert_eq!(bytes("a copy 3.ron"), bytes("a.ron"));
        let step = duplicate(&saves, &SavePlace::Shipped("fast")).expect("copied");
        assert!(read_entry(&step.place().expect("there")).is_ok());
        step.undo(&saves).expect("undone");
        assert_eq!(champions(&saves), ["a copy 2", "a copy 3", "a copy", "a"]);
    }

    #[test]
    fn a_deleted_entry_is_restored_under_another_name_if_its_own_is_taken() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        let deleted = delete(&saves, &place).expect("deleted");
        assert!(champions(&saves).is_empty());
        let restored = deleted.undo(&saves).expect("restored");
        assert_eq!(champions(&saves), ["a"]);
        let deleted = restored.undo(&saves).expect("deleted again");
        fs::write(folder.path().join("a.ron"), "another").expect("written");
        let restored = deleted.undo(&saves).expect("restored");
        assert_eq!(restored.place().expect("there").name(), "a 2");
        assert_eq!(fs::read_to_string(folder.path().join("a.ron")).expect("there"), "another");
        // Two entries with the same name can both be deleted.
        delete(&saves, &place).expect("deleted");
        let once_more = champion_in(&saves, "a");
        delete(&saves, &once_more).expect("deleted");
        assert_eq!(fs::read_dir(folder.path().join(DELETED)).expect("there").count(), 2);
    }

    /// Returns a folder on another disk than the folder of saves. None if there is no other disk.
    #[cfg(target_os = "linux")]
    fn on_another_disk(saves: &SavesFolder) -> Option<tempfile::TempDir> {
        use std::os::unix::fs::MetadataExt;
        let disk = |path: &Path| fs::metadata(path).map(|about| about.dev()).ok();
        let elsewhere = tempfile::tempdir_in("/dev/shm").ok()?;
        (disk(elsewhere.path()) != disk(saves.path())).then_some(elsewhere)
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn undoing_an_export_to_another_disk_moves_the_copy_within_that_disk() {
        use crate::save::library::export;
        let (_folder, saves) = saves();
        let (champion, run) = (champion_in(&saves, "a"), run_in(&saves, 1));
        let Some(elsewhere) = on_another_disk(&saves) else { return };
        for place in [champion, run] {
            let exported = export(&saves, &place, Some(elsewhere.path())).expect("exported");
            let copy = exported.place().expect("there");
            let before = read_entry(&copy).expect("whole");
            let deleted = exported.undo(&saves).expect("undone");
            assert!(!copy.path().expect("a path").exists());
            assert!(
                elsewhere
                    .path()
                    .join(DELETED)
                    .join(copy.path().expect("a path").file_name().expect("a name"))
                    .exists()
            );
            let restored = deleted.undo(&saves).expect("done again");
            assert_eq!(restored.place(), Some(copy.clone()));
            assert_eq!(read_entry(&copy).expect("whole"), before);
        }
        assert!(!saves.path().join(DELETED).join("a.ron").exists(), "no reservation is left");
    }

    #[test]
    fn a_run_is_deleted_and_restored_completely_but_not_while_in_use() {
        let (_folder, saves) = saves();
        let run = run_in(&saves, 1);
        let before = read_entry(&run).expect("whole");
        let lock = Lock::take(run.path().expect("a folder"), "the studio").expect("free");
        let refusal = delete(&saves, &run).expect_err("in use").to_string();
        assert!(
            refusal.contains("in use by process") && refusal.contains("the studio"),
            "{refusal}"
        );
        assert!(run.path().expect("a folder").is_dir());
        drop(lock);
        let deleted = delete(&saves, &run).expect("deleted");
        assert!(!run.path().expect("a folder").exists());
        deleted.undo(&saves).expect("restored");
        assert_eq!(read_entry(&run).expect("whole"), before);
    }

    #[test]
    fn a_vanished_entry_is_reported_and_a_link_in_place_of_the_hidden_folder_is_refused() {
        let (folder, saves) = saves();
        let gone = SavePlace::Champion(folder.path().join("gone.ron"));
        for result in [rename(&gone, "b"), duplicate(&saves, &gone), delete(&saves, &gone)] {
            let message = result.expect_err("gone").to_string();
            assert!(message.contains("gone.ron: cannot be read"), "{message}");
        }
        assert!(champions(&saves).is_empty(), "no reservation is left");
        #[cfg(unix)]
        {
            let place = champion_in(&saves, "a");
            let elsewhere = tempfile::tempdir().expect("a folder");
            std::os::unix::fs::symlink(elsewhere.path(), folder.path().join(DELETED))
                .expect("linked");
            let message = delete(&saves, &place).expect_err("refused").to_string();
            assert!(message.contains("it is a link"), "{message}");
            assert_eq!(champions(&saves), ["a"]);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_without_permission_gives_an_error_and_nothing_is_lost() {
        use std::os::unix::fs::PermissionsExt;
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        let allow = |mode| {
            fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).expect("changed");
        };
        allow(0o555);
        // Permissions do not stop the superuser, so the test is skipped then.
        let is_stopped = fs::write(folder.path().join("probe"), "").is_err();
        if is_stopped {
            for result in [rename(&place, "b"), duplicate(&saves, &place), delete(&saves, &place)] {
                let message = result.expect_err("no permission").to_string();
                assert!(message.contains("cannot be written: "), "{message}");
            }
        }
        allow(0o755);
        assert_eq!(champions(&saves), ["a"]);
    }
}
