//! Atomic writing of folders: a folder gets its name only when all of its files are complete.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::SaveError;
use super::picture::{Picture, encoded};
use super::whole_file::{UNFINISHED, folder_of, without_temporary_name};

/// A folder that is filled file by file, and gets its name only when it is complete. If this value is dropped before, nothing remains.
#[derive(Debug)]
pub struct UnfinishedFolder {
    folder: TempDir,
    path: PathBuf,
}

impl UnfinishedFolder {
    /// Begins the folder that will have the path `path`.
    ///
    /// # Errors
    /// Fails if something other than an empty folder has the path, or if the folder around it cannot be written.
    pub fn create(path: &Path) -> Result<Self, SaveError> {
        let unwritable = SaveError::unwritable(path);
        if !is_free(path) {
            let taken = "it exists already and is not empty; name another, or remove it";
            return Err(unwritable(io::Error::other(taken)));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(UNFINISHED);
        // Others may read the folder as far as the user's umask allows; the default of the library is private.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let made = builder.tempdir_in(folder_of(path));
        let folder = made.map_err(|error| unwritable(without_temporary_name(error)))?;
        Ok(Self { folder, path: path.to_owned() })
    }

    /// Adds a picture as a PNG file with a name.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn store_picture(&self, name: &str, picture: &Picture) -> Result<(), SaveError> {
        let written =
            encoded(picture).and_then(|bytes| fs::write(self.folder.path().join(name), bytes));
        written.map_err(SaveError::unwritable(&self.path.join(name)))
    }

    /// Gives the folder its name.
    ///
    /// # Errors
    /// Fails if the folder cannot be renamed, or if something other than an empty folder has the name by now.
    pub fn finish(self) -> Result<(), SaveError> {
        let Self { folder, path } = self;
        let finish = || -> io::Result<()> {
            // On Unix a rename replaces an empty folder; on other systems the empty folder must be removed before.
            if path.is_dir() {
                fs::remove_dir(&path)?;
            }
            fs::rename(folder.path(), &path)
        };
        let finished = finish().map_err(SaveError::unwritable(&path));
        if finished.is_ok() {
            // The temporary folder has been renamed, so nothing is left to remove.
            let _ = folder.keep();
        }
        finished
    }
}

/// Returns whether the path is free, or that of an empty folder.
fn is_free(path: &Path) -> bool {
    match fs::read_dir(path) {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) => path.symlink_metadata().is_err(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_appears_only_when_it_is_complete_and_replaces_nothing() {
        let around = tempfile::tempdir().expect("a folder");
        let path = around.path().join("frames");
        let names = || -> Vec<String> {
            let entries = fs::read_dir(around.path()).expect("a folder");
            entries.map(|of| of.expect("one").file_name().to_string_lossy().into_owned()).collect()
        };
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
