//! Atomic writing of folders: a folder gets its name only when all of its files are complete.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::SaveError;
use super::picture::{Picture, encoded_picture};
use super::replaced::{ANYONES_FOLDER, Replaced, folder_of};
use super::whole_file::{remove_unfinished, temporary_of, without_temporary_name};

/// A folder under a temporary name, which is removed when this value is dropped.
#[derive(Debug)]
pub(super) struct TemporaryFolder {
    pub folder: TempDir,
    /// Lock of the folder, so that no other program takes it for one that a kill left. None where folders cannot be opened as files; nobody
    /// removes them there either.
    lock: Option<File>,
}

impl TemporaryFolder {
    /// Makes a folder with a mode within the folder `around`. Incomplete files and folders that a kill left there are removed.
    pub fn within(around: &Path, mode: u32) -> io::Result<Self> {
        remove_unfinished(around);
        loop {
            let folder = temporary_of(mode).tempdir_in(around)?;
            let lock = File::open(folder.path()).ok();
            lock.iter().for_each(|lock| drop(lock.lock()));
            // Another program may have removed the folder before it was locked.
            if folder.path().exists() {
                return Ok(Self { folder, lock });
            }
        }
    }
}

/// A folder that is filled file by file, and gets its name only when it is complete. If this value is dropped before, nothing remains.
#[derive(Debug)]
pub struct UnfinishedFolder {
    temporary: TemporaryFolder,
    /// Path that the user named.
    path: PathBuf,
    /// Path to which links lead.
    target: PathBuf,
}

impl UnfinishedFolder {
    /// Begins the folder that will have the path `path`. Links at the path are followed, and the new folder gets the mode and the owner of
    /// an earlier one.
    ///
    /// # Errors
    /// Fails if something other than an empty folder has the path, if that is write-protected, or if the folder around it cannot be
    /// written.
    pub fn create(path: &Path) -> Result<Self, SaveError> {
        let begin = || {
            let replaced = Replaced::folder_at(path)?;
            let mode = replaced.mode(ANYONES_FOLDER);
            let temporary = TemporaryFolder::within(folder_of(&replaced.path), mode)?;
            temporary.lock.iter().try_for_each(|folder| replaced.hand_on(folder))?;
            Ok(Self { temporary, path: path.to_owned(), target: replaced.path })
        };
        begin().map_err(|error| SaveError::unwritable(path)(without_temporary_name(error)))
    }

    /// Adds a picture as a PNG file with a name.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn store_picture(&self, name: &str, picture: &Picture) -> Result<(), SaveError> {
        let written = encoded_picture(picture)
            .and_then(|bytes| fs::write(self.temporary.folder.path().join(name), bytes));
        written.map_err(SaveError::unwritable(&self.path.join(name)))
    }

    /// Gives the folder its name.
    ///
    /// # Errors
    /// Fails if the folder cannot be renamed, or if something other than an empty folder has the name by now.
    pub fn finish(self) -> Result<(), SaveError> {
        let Self { temporary: TemporaryFolder { folder, .. }, path, target } = self;
        let finish = || -> io::Result<()> {
            // On Unix a rename replaces an empty folder; on other systems the empty folder must be removed before.
            if target.is_dir() {
                fs::remove_dir(&target)?;
            }
            fs::rename(folder.path(), &target)
        };
        let finished = finish().map_err(SaveError::unwritable(&path));
        if finished.is_ok() {
            // The temporary folder has been renamed, so nothing is left to remove.
            let _ = folder.keep();
        }
        finished
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::files::names_in;

    #[test]
    fn a_folder_appears_only_when_it_is_complete_and_replaces_nothing() {
        let around = tempfile::tempdir().expect("a folder");
        let path = around.path().join("frames");
        let names = || names_in(around.path());
        let folder = UnfinishedFolder::create(&path).expect("free");
        folder.store_picture("1.png", &Picture::new(2, 2)).expect("written");
        assert!(!path.exists());
        drop(folder);
        assert!(names().is_empty(), "{:?}", names());
        let folder = UnfinishedFolder::create(&path).expect("free");
        folder.store_picture("1.png", &Picture::new(2, 2)).expect("written");
        folder.finish().expect("named");
        assert_eq!(names(), ["frames"]);
        assert!(path.join("1.png").exists());
        let refused = UnfinishedFolder::create(&path).expect_err("taken").to_string();
        assert!(refused.contains("frames: cannot be written: it exists already"), "{refused}");
        fs::remove_file(path.join("1.png")).expect("removed");
        UnfinishedFolder::create(&path).expect("empty").finish().expect("named");
        assert_eq!(names(), ["frames"]);
    }
}
