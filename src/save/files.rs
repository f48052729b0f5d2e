//! Reading bounded text and writing whole files.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use crate::check::Invalid;

/// What can go wrong with a file. Each message is one line that starts with the file's name.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The file could not be opened or read.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file or its folder could not be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Unwritable {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is larger than any honest one.
    #[error("{}: size is over {limit_mib} MiB; allowed: up to {limit_mib} MiB", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The largest size that is read, in MiB.
        limit_mib: u64,
    },
    /// The text is damaged, or ends too early.
    #[error("{}: damaged or incomplete at line {line}, column {column}: {problem}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Line of the damage; the first is 1.
        line: usize,
        /// Column of the damage; the first is 1.
        column: usize,
        /// What is wrong there.
        problem: String,
    },
    /// Well-formed, but of another kind.
    #[error("{}: kind is {found}; allowed: {expected:?}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What the file says it is.
        found: String,
        /// What it should say.
        expected: &'static str,
    },
    /// Written by a later version of the program.
    #[error("{}: format is {found}; allowed: 1 to {newest} (a newer version of Snakes & Stairs wrote this file)", path.display())]
    Newer {
        /// The file.
        path: PathBuf,
        /// The format it has.
        found: u32,
        /// The newest format this version reads.
        newest: u32,
    },
    /// Neither a preset nor a file has that name.
    #[error("{0}")]
    UnknownPreset(Invalid),
    /// A value in it is not allowed.
    #[error("{}: {source}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// The field, its value, and what is allowed.
        source: Invalid,
    },
}

/// The largest file that is read. A champion's torque points are bounded so that it stays below.
const LARGEST_FILE_MIB: u64 = 10;

/// Reads a text file, but never more than [`LARGEST_FILE_MIB`].
pub fn read_text(path: &Path) -> Result<String, SaveError> {
    let unreadable = |source| SaveError::Unreadable { path: path.to_owned(), source };
    let limit = LARGEST_FILE_MIB * 1024 * 1024;
    let file = File::open(path).map_err(unreadable)?;
    let mut text = Vec::new();
    file.take(limit + 1).read_to_end(&mut text).map_err(unreadable)?;
    if text.len() as u64 > limit {
        return Err(SaveError::TooLarge { path: path.to_owned(), limit_mib: LARGEST_FILE_MIB });
    }
    String::from_utf8(text).map_err(|error| SaveError::Damaged {
        path: path.to_owned(),
        line: 1,
        column: error.utf8_error().valid_up_to() + 1,
        problem: "not UTF-8 text".to_owned(),
    })
}

/// Parses RON, turning a failure into an error that names the place.
pub fn parse<T: serde::de::DeserializeOwned>(path: &Path, text: &str) -> Result<T, SaveError> {
    ron::from_str(text).map_err(|error| SaveError::Damaged {
        path: path.to_owned(),
        line: error.span.start.line,
        column: error.span.start.col,
        problem: error.code.to_string(),
    })
}

/// Writes a file so that at every instant either the old or the whole new one is there: into a
/// temporary file beside it, flushed to the disk, then renamed.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), SaveError> {
    let write = || -> std::io::Result<()> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".unfinished-");
        // Readable by others as far as the person's umask allows; the default is for secrets.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut file = builder.tempfile_in(folder)?;
        file.write_all(contents)?;
        file.as_file().sync_all()?;
        file.persist(path).map_err(|error| error.error)?;
        // The file is there by now; that its name survives a power cut too is up to the platform.
        #[cfg(unix)]
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    };
    write().map_err(|source| SaveError::Unwritable { path: path.to_owned(), source })
}

/// Makes sure that files can be written into `folder`, creating it if need be.
pub fn prepare_folder(folder: &Path) -> Result<(), SaveError> {
    let unwritable = |source| SaveError::Unwritable { path: folder.to_owned(), source };
    fs::create_dir_all(folder).map_err(unwritable)?;
    // Permissions alone do not tell (read-only mounts, quotas): try it. The file goes when dropped.
    tempfile::tempfile_in(folder).map(drop).map_err(unwritable)
}
