//! Properties that a new file or folder takes over from the replaced one: the place to which links lead, the mode and the owner.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

/// Mode of new files: others may read them as far as the user's umask allows.
pub const ANYONES_FILE: u32 = 0o666;
/// Mode of new folders: others may read them as far as the user's umask allows.
pub const ANYONES_FOLDER: u32 = 0o777;

/// Maximum number of links that are followed, as on Linux.
const MOST_LINKS: usize = 40;

/// The file or folder that a new one will replace, if there is one.
#[derive(Debug)]
pub struct Replaced {
    /// Path of the new file or folder: that to which links lead, so that the links stay.
    pub path: PathBuf,
    about: Option<Metadata>,
}

impl Replaced {
    /// Finds the file that a new file at `path` will replace.
    ///
    /// # Errors
    /// Fails if the file is write-protected or not a regular file, or if links lead in a circle.
    pub fn file_at(path: &Path) -> Result<Self> {
        let found = Self::at(path)?;
        if let Some(about) = &found.about {
            if !about.is_file() {
                return Err(Error::other("it is not a regular file"));
            }
            // A rename needs no permission to write the file that it replaces, so the file is opened. Nothing is written into it.
            OpenOptions::new().write(true).open(path)?;
        }
        Ok(found)
    }

    /// Finds the folder that a new folder at `path` will replace.
    ///
    /// # Errors
    /// Fails if something other than an empty folder has the path, if the folder is write-protected, or if links lead in a circle.
    pub fn folder_at(path: &Path) -> Result<Self> {
        let found = Self::at(path)?;
        if found.about.is_some() && !fs::read_dir(path).is_ok_and(|mut all| all.next().is_none()) {
            let taken = "it exists already and is not empty; name another, or remove it";
            return Err(Error::other(taken));
        }
        Ok(found)
    }

    fn at(path: &Path) -> Result<Self> {
        let about = match fs::metadata(path) {
            Ok(about) => {
                refuse_protected(&about)?;
                Some(about)
            }
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        Ok(Self { path: followed(path)?, about })
    }

    /// Returns the mode with which the new file or folder is created: that of the replaced one, or else `new`.
    pub fn mode(&self, new: u32) -> u32 {
        self.about.as_ref().and_then(mode_of).unwrap_or(new)
    }

    /// Gives the new file or folder the mode and the owner of the replaced one. Where only an administrator may give files away, at
    /// least the group is kept, if possible.
    ///
    /// # Errors
    /// Fails if the mode cannot be changed.
    pub fn hand_on(&self, new: &File) -> Result<()> {
        #[cfg(unix)]
        if let Some(about) = &self.about {
            use std::os::unix::fs::{MetadataExt, fchown};
            let (own, [user, group]) = (new.metadata()?, [about.uid(), about.gid()]);
            if [own.uid(), own.gid()] != [user, group]
                && fchown(new, Some(user), Some(group)).is_err()
            {
                let _ = fchown(new, None, Some(group));
            }
            if own.mode() != about.mode() {
                new.set_permissions(about.permissions())?;
            }
        }
        #[cfg(not(unix))]
        let _ = (&self.about, new);
        Ok(())
    }
}

/// Refuses what is marked as write-protected, which administrators could write all the same.
pub fn refuse_protected(about: &Metadata) -> Result<()> {
    if about.permissions().readonly() {
        return Err(Error::other("it is write-protected"));
    }
    Ok(())
}

/// Returns the folder that contains a file.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Follows the links at a path. Nothing need exist where they lead.
pub fn followed(path: &Path) -> Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = folder_of(&path).join(next),
            Err(_) => return Ok(path),
        }
    }
    Err(Error::other("its links lead in a circle"))
}

/// Returns the mode of a copy: that of the original, but its owner may change it. Copies of private files and folders are thus private.
/// Without an original, or on systems without modes, the mode is `new`.
pub fn mode_of_copy(original: Option<&Path>, new: u32) -> u32 {
    let about = original.and_then(|path| fs::metadata(path).ok());
    let owners = 0o700 & new;
    about.as_ref().and_then(mode_of).map_or(new, |mode| mode | owners)
}

/// Creates an empty file with the mode of a copy. Fails if a file or a link with this name already exists.
pub fn create_copy(path: &Path, original: &Path) -> Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    let mode = mode_of_copy(Some(original), ANYONES_FILE);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, mode);
    #[cfg(not(unix))]
    let _ = mode;
    options.open(path)
}

/// Returns the mode of a file or folder. None on systems without modes.
fn mode_of(about: &Metadata) -> Option<u32> {
    #[cfg(unix)]
    let mode = Some(std::os::unix::fs::MetadataExt::mode(about) & 0o777);
    #[cfg(not(unix))]
    let (mode, _) = (None, about);
    mode
}

#[cfg(test)]
mod tests;
