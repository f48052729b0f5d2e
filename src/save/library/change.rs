//! What can be done with an entry in its folder, and undone: renamed, duplicated, deleted, restored.

use std::fs::{self, OpenOptions};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::DELETED;
use super::details::{text_of_file, text_of_shipped};
use super::list::Place;
use super::name::{ENDING, check_entry_name, free_path, shortened};
use crate::check::Invalid;
use crate::save::files::{prepare_folder, write_new};
use crate::save::lock::Lock;
use crate::save::{SaveError, SavesFolder};

/// Something that was done with an entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// It has another name.
    Renamed {
        /// Where it was.
        from: PathBuf,
        /// Where it is.
        to: PathBuf,
    },
    /// It was put away.
    Deleted {
        /// Where it was.
        from: PathBuf,
        /// Where it is kept.
        kept: PathBuf,
    },
    /// It was brought back.
    Restored {
        /// Where it was before it was deleted.
        wanted: PathBuf,
        /// Where it is: elsewhere, if its name was taken meanwhile.
        to: PathBuf,
    },
    /// There is something new: a copy.
    Added {
        /// Where it is.
        path: PathBuf,
    },
}

impl Step {
    /// Undoes it. What is returned undoes that, in turn.
    ///
    /// # Errors
    /// It cannot be moved back, or is not there any more; everything is as it was before then.
    pub fn undo(&self, saves: &SavesFolder) -> Result<Self, SaveError> {
        match self {
            Self::Renamed { from, to } => {
                move_new(to, from)?;
                Ok(Self::Renamed { from: to.clone(), to: from.clone() })
            }
            Self::Deleted { from, kept } => restore(kept, from),
            Self::Restored { to: path, .. } | Self::Added { path } => put_away(saves, path),
        }
    }

    /// Where the entry is now; none, if it was deleted.
    pub fn place(&self) -> Option<Place> {
        let path = match self {
            Self::Renamed { to, .. } | Self::Restored { to, .. } | Self::Added { path: to } => to,
            Self::Deleted { .. } => return None,
        };
        Some(if path.is_dir() { Place::Run(path.clone()) } else { Place::Champion(path.clone()) })
    }
}

/// Gives a champion another name.
///
/// # Errors
/// The name is not allowed or taken; it is a run, whose folder's name says what run it is; it is part of the
/// program; the file cannot be renamed.
pub fn rename(place: &Place, name: &str) -> Result<Step, SaveError> {
    let Place::Champion(from) = place else {
        return Err(refused(place, "only a champion's file can be renamed"));
    };
    let invalid = |source| SaveError::Invalid { path: from.clone(), source };
    check_entry_name(name).map_err(invalid)?;
    let to = from.with_file_name(format!("{name}.{ENDING}"));
    move_new(from, &to)?;
    Ok(Step::Renamed { from: from.clone(), to })
}

/// Copies a champion beside it: "NAME copy", "NAME copy 2". One that is part of the program is copied into the
/// folder of saves.
///
/// # Errors
/// It is a run; the file cannot be read or the copy written.
pub fn duplicate(saves: &SavesFolder, place: &Place) -> Result<Step, SaveError> {
    let text = match place {
        Place::Shipped(name) => text_of_shipped(name)?.to_owned(),
        Place::Champion(path) => text_of_file(path)?,
        Place::Run(_) => return Err(refused(place, "only a champion's file can be duplicated")),
    };
    // Of ten thousand copies one would try out ten thousand times whether files can be written there.
    if !saves.path().is_dir() {
        saves.prepare()?;
    }
    let name = shortened(&place.name(), " copy");
    let path = free_path(saves.path(), &name, Some(ENDING));
    write_new(&path, text.as_bytes())?;
    Ok(Step::Added { path })
}

/// Deletes an entry: moves it into a hidden folder of the saves, or of where it is if that is on another disk, from
/// where undoing brings it back.
///
/// # Errors
/// A program writes into the run's folder; it is part of the program; it cannot be moved.
pub fn delete(saves: &SavesFolder, place: &Place) -> Result<Step, SaveError> {
    let path = place.path().ok_or_else(|| refused(place, "it comes with the program"))?;
    put_away(saves, path)
}

fn put_away(saves: &SavesFolder, path: &Path) -> Result<Step, SaveError> {
    match put_into_bin(saves.path(), path) {
        // Nothing can be moved from one disk to another, only copied; what was exported stays where it went.
        Err(SaveError::Unwritable { source, .. }) if source.kind() == ErrorKind::CrossesDevices => {
            put_into_bin(path.parent().unwrap_or(Path::new(".")), path)
        }
        other => other,
    }
}

/// Moves something into the hidden folder within another.
fn put_into_bin(folder: &Path, path: &Path) -> Result<Step, SaveError> {
    let unreadable = |source| SaveError::Unreadable { path: path.to_owned(), source };
    let is_folder = fs::symlink_metadata(path).map_err(unreadable)?.is_dir();
    let lock = if is_folder { Some(Lock::take(path, "the library")?) } else { None };
    let bin = SavesFolder::within_run(folder, DELETED)?;
    // Whether files can be written there is tried out once; the move itself tells it afterwards.
    if !bin.path().is_dir() {
        prepare_folder(bin.path())?;
    }
    let name = path.file_stem().filter(|_| !is_folder).or(path.file_name()).unwrap_or_default();
    let ending = path.extension().filter(|_| !is_folder).map(|ending| ending.to_string_lossy());
    let kept = free_path(bin.path(), &name.to_string_lossy(), ending.as_deref());
    if cfg!(windows) {
        // There a folder in which a file is open cannot be moved.
        drop(lock);
        move_new(path, &kept)?;
    } else {
        move_new(path, &kept)?;
        drop(lock);
    }
    Ok(Step::Deleted { from: path.to_owned(), kept })
}

/// Brings something back that was deleted; under the next free name, if its own is taken by now.
fn restore(kept: &Path, wanted: &Path) -> Result<Step, SaveError> {
    let folder = wanted.parent().unwrap_or(Path::new("."));
    let is_folder = kept.is_dir();
    let name = wanted.file_stem().filter(|_| !is_folder).or(wanted.file_name()).unwrap_or_default();
    let ending = wanted.extension().filter(|_| !is_folder).map(|ending| ending.to_string_lossy());
    let to = if wanted.symlink_metadata().is_err() {
        wanted.to_owned()
    } else {
        free_path(folder, &name.to_string_lossy(), ending.as_deref())
    };
    move_new(kept, &to)?;
    Ok(Step::Restored { wanted: wanted.to_owned(), to })
}

fn refused(place: &Place, allowed: &str) -> SaveError {
    let what = match place {
        Place::Shipped(_) => "part of the program",
        Place::Champion(_) => "a champion",
        Place::Run(_) => "a run",
    };
    let source = Invalid::new("entry", what, allowed);
    SaveError::Invalid { path: place.path().unwrap_or(Path::new(&place.name())).to_owned(), source }
}

/// Says that a name is taken.
pub fn taken(path: &Path) -> SaveError {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let source = Invalid::new("name", format!("{name:?}"), "a name that is not taken yet");
    SaveError::Invalid { path: path.to_owned(), source }
}

/// Moves a file or folder to a name that must not be taken.
pub fn move_new(from: &Path, to: &Path) -> Result<(), SaveError> {
    let unwritable = |source| SaveError::Unwritable { path: to.to_owned(), source };
    let about = fs::symlink_metadata(from)
        .map_err(|source| SaveError::Unreadable { path: from.to_owned(), source })?;
    if about.is_dir() {
        if to.symlink_metadata().is_ok() {
            return Err(taken(to));
        }
        // A folder that appears there between the two is replaced only if it is empty: nothing is lost.
        return fs::rename(from, to).map_err(unwritable);
    }
    // A file would be replaced whatever it holds: the name is reserved before.
    match OpenOptions::new().write(true).create_new(true).open(to) {
        Ok(reserved) => drop(reserved),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Err(taken(to)),
        Err(error) => return Err(unwritable(error)),
    }
    fs::rename(from, to).map_err(|source| {
        // It is the reservation, empty.
        let _ = fs::remove_file(to);
        unwritable(source)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::fixtures::{champion_in, names, run_in, saves};
    use crate::save::library::{list, read_entry};

    /// The champions of the folder.
    fn champions(saves: &SavesFolder) -> Vec<String> {
        names(&list(saves).expect("readable"), |place| matches!(place, Place::Champion(_)))
    }

    #[test]
    fn a_champion_is_renamed_and_back_again() {
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
    fn a_name_that_is_taken_or_not_allowed_is_refused_and_nothing_changes() {
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
        assert!(refusal("a/b").contains("without slashes"));
        assert!(refusal("../out").contains("dot"));
        assert_eq!(champions(&saves), ["first", "second"]);
        let kept = fs::read_to_string(folder.path().join("second.ron")).expect("there");
        assert_eq!(kept, "mine");
    }

    #[test]
    fn a_runs_folder_keeps_its_name_and_what_comes_with_the_program_stays() {
        let (_folder, saves) = saves();
        let run = run_in(&saves, 1);
        let shipped = Place::Shipped("fast");
        let says = |result: Result<Step, SaveError>, words: &str| {
            let message = result.expect_err("refused").to_string();
            assert!(message.contains(words), "{message}");
        };
        says(
            rename(&run, "other"),
            "entry is a run; allowed: only a champion's file can be renamed",
        );
        says(duplicate(&saves, &run), "only a champion's file can be duplicated");
        says(rename(&shipped, "other"), "entry is part of the program");
        says(delete(&saves, &shipped), "it comes with the program");
    }

    #[test]
    fn copies_are_counted_and_have_every_byte() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        for expected in ["a copy", "a copy 2", "a copy 3"] {
            let step = duplicate(&saves, &place).expect("copied");
            assert_eq!(step.place().expect("there").name(), expected);
        }
        let bytes = |name: &str| fs::read(folder.path().join(name)).expect("there");
        assert_eq!(bytes("a copy 3.ron"), bytes("a.ron"));
        let step = duplicate(&saves, &Place::Shipped("fast")).expect("copied");
        assert!(read_entry(&step.place().expect("there")).is_ok());
        step.undo(&saves).expect("undone");
        assert_eq!(champions(&saves), ["a copy 2", "a copy 3", "a copy", "a"]);
    }

    #[test]
    fn what_is_deleted_comes_back_and_under_another_name_if_its_own_is_taken() {
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
        // Two of one name can both be deleted.
        delete(&saves, &place).expect("deleted");
        let once_more = champion_in(&saves, "a");
        delete(&saves, &once_more).expect("deleted");
        assert_eq!(fs::read_dir(folder.path().join(DELETED)).expect("there").count(), 2);
    }

    /// A folder on another disk than that of saves, where there is one.
    #[cfg(target_os = "linux")]
    fn on_another_disk(saves: &SavesFolder) -> Option<tempfile::TempDir> {
        use std::os::unix::fs::MetadataExt;
        let disk = |path: &Path| fs::metadata(path).map(|about| about.dev()).ok();
        let elsewhere = tempfile::tempdir_in("/dev/shm").ok()?;
        (disk(elsewhere.path()) != disk(saves.path())).then_some(elsewhere)
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_was_exported_to_another_disk_is_put_away_there_and_comes_back() {
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
    fn a_run_is_deleted_and_restored_as_a_whole_but_not_while_it_is_in_use() {
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
    fn what_is_gone_meanwhile_is_said_and_a_link_in_place_of_the_bin_is_refused() {
        let (folder, saves) = saves();
        let gone = Place::Champion(folder.path().join("gone.ron"));
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
    fn a_folder_without_permission_is_said_and_nothing_is_lost() {
        use std::os::unix::fs::PermissionsExt;
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        let allow = |mode| {
            fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).expect("changed");
        };
        allow(0o555);
        // Who may do everything is not stopped by permissions.
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
