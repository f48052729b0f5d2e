//! Reading bounded text and writing whole files.

use std::fs::{self, File};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};
use tempfile::{NamedTempFile, PersistError};

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
    /// Another program writes into the folder.
    #[error("{}: in use by {owner}", path.display())]
    InUse {
        /// The folder.
        path: PathBuf,
        /// The program's process, and what it is.
        owner: String,
    },
    /// The folder holds the run of another preset, seed or setting.
    #[error("{}: holds another run; allowed: an empty folder, or one of the same run", path.display())]
    OtherRun {
        /// The folder.
        path: PathBuf,
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

/// The largest file that is read; what is written stays below.
pub const LARGEST_FILE_MIB: u64 = 10;

/// Reads a text file, but never more than [`LARGEST_FILE_MIB`].
pub fn read_text(path: &Path) -> Result<String, SaveError> {
    text_of(path, read_bytes(path, LARGEST_FILE_MIB)?)
}

/// Reads a file, but never more than a limit, and nothing that is no file: a device has no end, and a
/// pipe may wait for ever.
pub fn read_bytes(path: &Path, limit_mib: u64) -> Result<Vec<u8>, SaveError> {
    let unreadable = |source| SaveError::Unreadable { path: path.to_owned(), source };
    let limit = limit_mib * 1024 * 1024;
    let about = fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() {
        return Err(unreadable(std::io::Error::other("it is no file")));
    }
    if about.len() > limit {
        return Err(SaveError::TooLarge { path: path.to_owned(), limit_mib });
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(limit + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > limit {
        return Err(SaveError::TooLarge { path: path.to_owned(), limit_mib });
    }
    Ok(bytes)
}

/// Refuses a symbolic link and whatever else is there but is no file: within a run's folder, which may be
/// anybody's, no name leads elsewhere.
pub fn refuse_link(path: &Path) -> std::io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(about) if about.is_file() => Ok(()),
        Ok(_) => Err(std::io::Error::other("it is a link or no file")),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Text from bytes, or where it stops being text.
pub fn text_of(path: &Path, bytes: Vec<u8>) -> Result<String, SaveError> {
    String::from_utf8(bytes).map_err(|error| SaveError::Damaged {
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
        problem: tamed(&error.code.to_string()),
    })
}

/// What a parser says may repeat what stands in the file: a line's worth of it, and nothing that could
/// write elsewhere in a terminal.
pub fn tamed(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    plain.take(200).collect()
}

/// A hash of 64 bits from its 16 hexadecimal digits.
pub fn hash_of(field: &str, text: &str) -> Result<u64, Invalid> {
    let digits = text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let hash = u64::from_str_radix(text, 16).ok().filter(|_| digits);
    hash.ok_or_else(|| {
        let start: String = text.chars().take(40).collect();
        Invalid::new(field, format!("{start:?}"), "16 hexadecimal digits")
    })
}

/// The part of a file that says what it is; everything else is skipped.
#[derive(Deserialize)]
pub struct Header {
    #[serde(default)]
    kind: String,
    #[serde(default)]
    format: u32,
}

impl Header {
    /// Reads what a file is, and returns its format: 1 to `newest`.
    pub fn read(
        path: &Path,
        text: &str,
        expected: &'static str,
        newest: u32,
    ) -> Result<u32, SaveError> {
        let Self { kind, format } = parse(path, text)?;
        let path = path.to_owned();
        if kind != expected {
            let start: String = kind.chars().take(60).collect();
            return Err(SaveError::Foreign { path, found: format!("{start:?}"), expected });
        }
        match format {
            0 => {
                let source = Invalid::new("format", "0 or missing", format!("1 to {newest}"));
                Err(SaveError::Invalid { path, source })
            }
            known if known <= newest => Ok(known),
            found => Err(SaveError::Newer { path, found, newest }),
        }
    }
}

/// Writes a file so that at every instant either the old or the whole new one is there: into a
/// temporary file beside it, flushed to the disk, then renamed.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), SaveError> {
    write_and(path, contents, |file| file.persist(path))
}

/// The same for a file that must not be there yet: what has taken its name meanwhile stays.
pub fn write_new(path: &Path, contents: &[u8]) -> Result<(), SaveError> {
    write_and(path, contents, |file| file.persist_noclobber(path))
}

fn write_and(
    path: &Path,
    contents: &[u8],
    put: impl FnOnce(NamedTempFile) -> Result<File, PersistError>,
) -> Result<(), SaveError> {
    let write = || -> std::io::Result<()> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(UNFINISHED);
        // Readable by others as far as the person's umask allows; the default is for secrets.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut file = builder.tempfile_in(folder)?;
        // Past the temporary file's own wrapping of errors, which names that file.
        file.as_file_mut().write_all(contents)?;
        file.as_file().sync_all()?;
        put(file).map_err(|error| error.error)?;
        // The file is there by now; that its name survives a power cut too is up to the platform.
        #[cfg(unix)]
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    };
    write().map_err(|error| unwritable(path, error))
}

/// That a file or folder cannot be written, and why.
fn unwritable(path: &Path, error: std::io::Error) -> SaveError {
    // A temporary file's error names that file, which nobody has heard of, and is no error of the system's own.
    let names_another = error.raw_os_error().is_none() && error.kind() != ErrorKind::Other;
    let source = if names_another { error.kind().into() } else { error };
    SaveError::Unwritable { path: path.to_owned(), source }
}

/// The numbers N for which a folder has a file `<prefix>N.ron`, in no order.
pub fn numbered(folder: &Path, prefix: &str) -> Result<Vec<u32>, SaveError> {
    let unreadable = |source| SaveError::Unreadable { path: folder.to_owned(), source };
    let mut numbers = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.file_name();
        let number = file.to_str().and_then(|file| {
            let digits = file.strip_prefix(prefix)?.strip_suffix(".ron")?;
            let number = digits.parse::<u32>().ok()?;
            // Not a copy that a person named `generation-01.ron`.
            (number.to_string() == digits).then_some(number)
        });
        numbers.extend(number);
    }
    Ok(numbers)
}

/// RON as a person can read it.
pub fn pretty(path: &Path, file: &impl Serialize) -> Result<String, SaveError> {
    let layout = PrettyConfig::new().compact_arrays(true).struct_names(false);
    ron::ser::to_string_pretty(file, layout).map(|text| text + "\n").map_err(|error| {
        SaveError::Unwritable { path: path.to_owned(), source: std::io::Error::other(error) }
    })
}

/// Writes a file of RON so that a person can read it, whole or not at all.
pub fn store_ron(path: &Path, file: &impl Serialize) -> Result<(), SaveError> {
    write_whole(path, pretty(path, file)?.as_bytes())
}

/// How the name of a file begins that is not whole yet.
pub const UNFINISHED: &str = ".unfinished-";

/// Removes what a kill left half written in a folder into which nobody else writes.
pub fn remove_unfinished(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(UNFINISHED))
    {
        // One that stays is no harm.
        let _ = fs::remove_file(entry.path());
    }
}

/// Makes sure that files can be written into `folder`, creating it if need be.
pub fn prepare_folder(folder: &Path) -> Result<(), SaveError> {
    let unwritable = |error| unwritable(folder, error);
    let is_new = !folder.exists();
    fs::create_dir_all(folder).map_err(unwritable)?;
    if is_new {
        // That the folder's name survives a power cut is up to the platform.
        #[cfg(unix)]
        let _ = folder.parent().map(File::open).map(|parent| parent.and_then(|p| p.sync_all()));
    }
    // Permissions alone do not tell (read-only mounts, quotas): try it. The file goes when dropped.
    tempfile::tempfile_in(folder).map(drop).map_err(unwritable)
}

/// The names of what is in a folder, sorted, those that are hidden too: for tests.
#[cfg(test)]
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
