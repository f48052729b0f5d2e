//! Atomic writing of files: at every instant either the old or the complete new file exists.

use std::fs::{self, File};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, PersistError};

use super::SaveError;

/// Writes a file atomically: at every instant either the old or the complete new file exists. The contents go into a temporary file in the
/// same folder, are flushed to the disk, and then renamed.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), SaveError> {
    write_and(path, contents, |file| file.persist(path))
}

/// Writes a new file atomically. Fails if a file with this name already exists.
pub fn write_new(path: &Path, contents: &[u8]) -> Result<(), SaveError> {
    write_and(path, contents, |file| file.persist_noclobber(path))
}

fn write_and(
    path: &Path,
    contents: &[u8],
    put: impl FnOnce(NamedTempFile) -> Result<File, PersistError>,
) -> Result<(), SaveError> {
    let mut file = UnfinishedFile::create(path)?;
    file.write_all(contents).map_err(|error| unwritable(path, error))?;
    file.finish_with(put)
}

/// A file that is written piece by piece, and gets its name only when it is complete. If this value is dropped before, nothing remains.
#[derive(Debug)]
pub struct UnfinishedFile {
    file: NamedTempFile,
    path: PathBuf,
}

impl UnfinishedFile {
    /// Begins the file that will have the path `path`.
    ///
    /// # Errors
    /// Fails if the folder of the file cannot be written.
    pub fn create(path: &Path) -> Result<Self, SaveError> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(UNFINISHED);
        // Others may read the file as far as the user's umask allows; the default of the library is private.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder_of(path)).map_err(|error| unwritable(path, error))?;
        Ok(Self { file, path: path.to_owned() })
    }

    /// Returns the path of the temporary file, for another program that writes it.
    pub fn temporary_path(&self) -> &Path {
        self.file.path()
    }

    /// Flushes the file to the disk and gives it its name, in place of an earlier file.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn finish(self) -> Result<(), SaveError> {
        let path = self.path.clone();
        self.finish_with(|file| file.persist(path))
    }

    fn finish_with(
        self,
        put: impl FnOnce(NamedTempFile) -> Result<File, PersistError>,
    ) -> Result<(), SaveError> {
        let Self { file, path } = self;
        let finish = || -> std::io::Result<()> {
            file.as_file().sync_all()?;
            put(file).map_err(|error| error.error)?;
            // The file exists now. The folder is flushed, so that the file's name survives a power cut; errors are ignored.
            #[cfg(unix)]
            let _ = File::open(folder_of(&path)).and_then(|folder| folder.sync_all());
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

/// Returns the folder that contains a file.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
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
    match error.kind() {
        ErrorKind::NotFound => Error::new(ErrorKind::NotFound, "its folder does not exist"),
        kind => kind.into(),
    }
}

/// Prefix of the names of incomplete files.
pub const UNFINISHED: &str = ".unfinished-";

/// Removes the incomplete files that a kill left in a folder. The caller must hold the folder's lock.
pub fn remove_unfinished(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(UNFINISHED))
    {
        // Errors are ignored, because an incomplete file does no harm.
        let _ = fs::remove_file(entry.path());
    }
}

/// Checks that files can be written into `folder`, and creates it if it does not exist.
pub fn prepare_folder(folder: &Path) -> Result<(), SaveError> {
    let unwritable = |error| unwritable(folder, error);
    let is_new = !folder.exists();
    fs::create_dir_all(folder).map_err(unwritable)?;
    if is_new {
        // The parent folder is flushed, so that the folder's name survives a power cut. Errors are ignored.
        #[cfg(unix)]
        let _ = folder.parent().map(File::open).map(|parent| parent.and_then(|p| p.sync_all()));
    }
    // Permissions alone do not suffice (read-only mounts, quotas), so a file is created. It is removed when dropped.
    tempfile::tempfile_in(folder).map(drop).map_err(unwritable)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_folder_is_told_in_words_and_without_the_name_of_a_temporary_file() {
        let around = tempfile::tempdir().expect("a folder");
        let path = around.path().join("none").join("champion.ron");
        let error = write_whole(&path, b"text").expect_err("no folder").to_string();
        let expected = format!("{}: cannot be written: its folder does not exist", path.display());
        assert_eq!(error, expected);
    }
}
