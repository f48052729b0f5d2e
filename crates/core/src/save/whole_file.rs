//! Atomic writing of files: at every instant either the old or the complete new file exists.

use std::fs::{self, File, OpenOptions};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, PersistError};

use super::SaveError;
use super::replaced::{ANYONES_FILE, Replaced, folder_of, mode_of_copy};

/// Writes a file atomically: at every instant either the old or the complete new file exists. The contents go into a temporary file in the
/// same folder, are flushed to the disk, and then renamed. Links at the path are followed, and the new file gets the mode and the owner of
/// the old one.
///
/// # Errors
/// Fails if the old file is write-protected, or if the new one cannot be written.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), SaveError> {
    UnfinishedFile::begin(path)?.fill(contents, NamedTempFile::persist)
}

/// Writes a new file atomically. Fails if a file or a link with this name already exists.
pub fn write_new(path: &Path, contents: &[u8]) -> Result<(), SaveError> {
    write_copy(path, contents, None)
}

/// Writes a new file atomically, which is as private as the file `original`, if that can be read. Fails if a file or a link with this name
/// already exists.
pub fn write_copy(path: &Path, contents: &[u8], original: Option<&Path>) -> Result<(), SaveError> {
    let file = temporary_file(folder_of(path), mode_of_copy(original, ANYONES_FILE));
    let file = file.map_err(|error| unwritable(path, error))?;
    let file = UnfinishedFile { file, path: path.to_owned(), target: path.to_owned() };
    file.fill(contents, NamedTempFile::persist_noclobber)
}

/// Makes a temporary file with a mode. It is locked until it is closed, so that no other program takes it for one that a kill left.
fn temporary_file(folder: &Path, mode: u32) -> std::io::Result<NamedTempFile> {
    loop {
        let file = temporary_of(mode).tempfile_in(folder)?;
        // Where files cannot be locked, nobody removes them either.
        let _ = file.as_file().lock();
        // Another program may have removed the file before it was locked.
        if file.path().exists() {
            return Ok(file);
        }
    }
}

/// Begins the description of a temporary file or folder with a mode, which only Unix has.
pub(super) fn temporary_of(mode: u32) -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(UNFINISHED).rand_bytes(RANDOM_CHARS);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
    builder
}

/// A file that is written piece by piece, and gets its name only when it is complete. If this value is dropped before, nothing remains.
#[derive(Debug)]
pub struct UnfinishedFile {
    file: NamedTempFile,
    /// Path that the user named.
    path: PathBuf,
    /// Path to which links lead.
    target: PathBuf,
}

impl UnfinishedFile {
    /// Begins the file that will have the path `path`. Links at the path are followed, and the new file gets the mode and the owner of an
    /// earlier one. Incomplete files that a kill left in the folder are removed.
    ///
    /// # Errors
    /// Fails if an earlier file is write-protected, or if the folder of the file cannot be written.
    pub fn create(path: &Path) -> Result<Self, SaveError> {
        let begun = Self::begin(path)?;
        remove_unfinished(folder_of(&begun.target));
        Ok(begun)
    }

    fn begin(path: &Path) -> Result<Self, SaveError> {
        let begin = || {
            let replaced = Replaced::file_at(path)?;
            let file = temporary_file(folder_of(&replaced.path), replaced.mode(ANYONES_FILE))?;
            replaced.hand_on(file.as_file())?;
            Ok(Self { file, path: path.to_owned(), target: replaced.path })
        };
        begin().map_err(|error| unwritable(path, error))
    }

    /// Returns the path of the temporary file, for another program that writes it.
    pub fn temporary_path(&self) -> &Path {
        if cfg!(windows) {
            // Windows lets no other program write a locked file. Nor does it let anyone remove a file that such a program has open.
            let _ = self.file.as_file().unlock();
        }
        self.file.path()
    }

    /// Returns whether nothing has been written yet.
    pub fn is_empty(&self) -> bool {
        self.file.as_file().metadata().is_ok_and(|about| about.len() == 0)
    }

    /// Flushes the file to the disk and gives it its name, in place of an earlier file.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn finish(self) -> Result<(), SaveError> {
        self.finish_with(NamedTempFile::persist)
    }

    fn fill(
        mut self,
        contents: &[u8],
        put: impl FnOnce(NamedTempFile, PathBuf) -> Result<File, PersistError>,
    ) -> Result<(), SaveError> {
        self.write_all(contents).map_err(|error| unwritable(&self.path, error))?;
        self.finish_with(put)
    }

    fn finish_with(
        self,
        put: impl FnOnce(NamedTempFile, PathBuf) -> Result<File, PersistError>,
    ) -> Result<(), SaveError> {
        let Self { file, path, target } = self;
        let finish = || -> std::io::Result<()> {
            file.as_file().sync_all()?;
            #[cfg(unix)]
            let folder = folder_of(&target).to_owned();
            put(file, target).map_err(|error| error.error)?;
            // The file exists now. The folder is flushed, so that the file's name survives a power cut; errors are ignored.
            #[cfg(unix)]
            let _ = File::open(folder).and_then(|folder| folder.sync_all());
            Ok(())
        };
        finish().map_err(|error| unwritable(&path, error))
    }
}

impl Write for UnfinishedFile {
    // The inner file is used, because errors of the temporary file would contain the temporary name.
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.as_file_mut().flush()
    }
}

/// Makes the error of an unwritable file or folder.
fn unwritable(path: &Path, error: Error) -> SaveError {
    SaveError::Unwritable { path: path.to_owned(), source: without_temporary_name(error) }
}

/// Removes the temporary name, which the user does not know, from an error of a temporary file or folder.
pub(super) fn without_temporary_name(error: Error) -> Error {
    if error.raw_os_error().is_some() || error.kind() == ErrorKind::Other {
        return error;
    }
    // Only the words have the reason of the system: most reasons have no kind of their own.
    let words = error.to_string();
    let reason = words.split(" at path ").next().unwrap_or(&words);
    match error.kind() {
        ErrorKind::NotFound => Error::new(ErrorKind::NotFound, "its folder does not exist"),
        kind => Error::new(kind, reason),
    }
}

/// Prefix of the names of incomplete files and folders, before [`RANDOM_CHARS`].
const UNFINISHED: &str = ".unfinished-snakes-";
/// Number of random letters and digits in the names of incomplete files and folders.
const RANDOM_CHARS: usize = 6;

/// Removes the incomplete files and folders that a kill left in a folder. Those of running programs are locked, and stay. Errors are
/// ignored, because what remains does no harm.
pub fn remove_unfinished(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (name, kind) = (entry.file_name(), entry.file_type());
        let random = name.to_str().and_then(|name| name.strip_prefix(UNFINISHED)).unwrap_or("");
        let is_own =
            random.len() == RANDOM_CHARS && random.bytes().all(|byte| byte.is_ascii_alphanumeric());
        let Ok(kind) = kind else { continue };
        if !is_own || !(kind.is_file() || kind.is_dir()) {
            continue;
        }
        let path = entry.path();
        let Ok(opened) = OpenOptions::new().read(true).write(kind.is_file()).open(&path) else {
            continue;
        };
        if opened.try_lock().is_ok() {
            let _ = if kind.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
        }
    }
}

/// Checks that files can be written into `folder`, creates it if it does not exist, and removes incomplete files that a kill left in it.
pub fn prepare_folder(folder: &Path) -> Result<(), SaveError> {
    let unwritable = |error| unwritable(folder, error);
    let is_new = !folder.exists();
    fs::create_dir_all(folder).map_err(unwritable)?;
    if is_new {
        // The parent folder is flushed, so that the folder's name survives a power cut. Errors are ignored.
        #[cfg(unix)]
        let _ = folder.parent().map(File::open).map(|parent| parent.and_then(|p| p.sync_all()));
    }
    remove_unfinished(folder);
    // Permissions alone do not suffice (read-only mounts, quotas), so a file is created. It is removed when dropped.
    tempfile::tempfile_in(folder).map(drop).map_err(unwritable)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::UnfinishedFolder;
    use crate::save::files::names_in;

    #[test]
    fn f12_what_a_kill_left_is_removed_but_nothing_in_progress_and_no_other_file() {
        let around = tempfile::tempdir().expect("a folder");
        let at = |name: &str| around.path().join(name);
        let others =
            [".unfinished-thesis", ".unfinished-snakes-notes", ".unfinished-snakes-a.b.cd"];
        let leave = || {
            fs::write(at(".unfinished-snakes-Ab12Cd"), "half a film").expect("written");
            fs::create_dir_all(at(".unfinished-snakes-zzzzz9/figures")).expect("created");
        };
        others.iter().for_each(|name| fs::write(at(name), "mine").expect("written"));
        let named = |names: &[&str]| {
            let mut all: Vec<String> =
                others.iter().chain(names).map(|&name| name.to_owned()).collect();
            all.sort();
            all
        };
        leave();
        let film = UnfinishedFile::create(&at("a.mp4")).expect("begun");
        let frames = UnfinishedFolder::create(&at("b-frames")).expect("begun");
        let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
        let left = names_in(around.path());
        assert_eq!(left.len(), others.len() + 2, "{left:?}");
        assert!(left.contains(&name(film.temporary_path())), "{left:?}");
        leave();
        prepare_folder(around.path()).expect("writable");
        assert_eq!(names_in(around.path()), left);
        film.finish().expect("written");
        frames.finish().expect("written");
        assert_eq!(names_in(around.path()), named(&["a.mp4", "b-frames"]));
        leave();
        drop(UnfinishedFolder::create(&at("c-frames")).expect("begun"));
        assert_eq!(names_in(around.path()), named(&["a.mp4", "b-frames"]));
        leave();
        drop(UnfinishedFile::create(&at("d.gif")).expect("begun"));
        assert_eq!(names_in(around.path()), named(&["a.mp4", "b-frames"]));
    }

    #[cfg(unix)]
    #[test]
    fn f12_pipes_and_links_that_are_named_like_leftovers_stay() {
        let around = tempfile::tempdir().expect("a folder");
        let at = |name: &str| around.path().join(name);
        fs::write(at("mine"), "mine").expect("written");
        std::os::unix::fs::symlink(at("mine"), at(".unfinished-snakes-linked")).expect("linked");
        let pipe = at(".unfinished-snakes-pipe00");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|made| made.success()));
        // Opening a pipe without a reader would never end.
        remove_unfinished(around.path());
        let names = [".unfinished-snakes-linked", ".unfinished-snakes-pipe00", "mine"];
        assert_eq!(names_in(around.path()), names);
    }

    #[test]
    fn s1_the_reason_of_the_system_is_told_also_if_it_has_no_kind() {
        // As the library for temporary files makes it of a refusal for too many open files.
        let system = Error::from_raw_os_error(24);
        let (kind, reason) = (system.kind(), system.to_string());
        let error = Error::new(
            kind,
            format!("{system} at path \"/a at path b/.unfinished-snakes-Ab12Cd\""),
        );
        let told = without_temporary_name(error);
        assert_eq!((told.kind(), told.to_string()), (kind, reason));
    }

    #[test]
    fn a_missing_folder_is_told_in_words_and_without_the_name_of_a_temporary_file() {
        let around = tempfile::tempdir().expect("a folder");
        let path = around.path().join("none").join("champion.ron");
        let error = write_whole(&path, b"text").expect_err("no folder").to_string();
        let expected = format!("{}: cannot be written: its folder does not exist", path.display());
        assert_eq!(error, expected);
    }
}
