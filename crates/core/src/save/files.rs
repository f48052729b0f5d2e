//! Reading bounded text, and writing RON.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::{Duration, UNIX_EPOCH};

use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};

use super::whole_file::write_whole;
use crate::check::{Invalid, quoted};

/// An error with a file. Each message is one line that starts with the file's name.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The file could not be opened or read.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The file or its folder could not be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Unwritable {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The file is larger than any that this program writes.
    #[error("{}: the file is larger than {limit_mib} MiB, the largest that is read", path.display())]
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
        /// The problem there.
        problem: String,
    },
    /// The file is well-formed, but of another kind.
    #[error("{}: kind is {found}; allowed: {expected:?}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The kind that the file states.
        found: String,
        /// The kind that it should state.
        expected: &'static str,
    },
    /// Written in a format that this version does not read.
    #[error("{}: format is {found}; allowed: {supported} ({} wrote this file)", path.display(),
        if found > supported { "a newer version of Snakes & Stairs" } else { "a version before the first release" })]
    OtherFormat {
        /// The file.
        path: PathBuf,
        /// The format it has.
        found: u32,
        /// The format that this version reads.
        supported: u32,
    },
    /// Another program writes into the folder.
    #[error("{}: in use by {owner}", path.display())]
    InUse {
        /// The folder.
        path: PathBuf,
        /// The program's process number and its name.
        owner: String,
    },
    /// The folder contains a run with another preset, seed or setting.
    #[error("{}: holds another run; allowed: an empty folder, or the folder of the same run", path.display())]
    OtherRun {
        /// The folder.
        path: PathBuf,
    },
    /// No built-in preset or stairs and no file have this name; the field says which of them.
    #[error("{0}")]
    Unknown(Invalid),
    /// A study does not exist, or has a value that is not allowed.
    #[error("{0}")]
    Study(Invalid),
    /// A value in the file is not allowed.
    #[error("{}: {source}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// The field, its value, and the allowed values.
        source: Invalid,
    },
}

impl SaveError {
    /// The error that a file or folder cannot be read, from the system's reason.
    pub fn unreadable(path: &Path) -> impl Fn(std::io::Error) -> Self + Copy {
        move |source| Self::Unreadable { path: path.to_owned(), source }
    }

    /// The error that a file or folder cannot be written, from the system's reason.
    pub fn unwritable(path: &Path) -> impl Fn(std::io::Error) -> Self + Copy {
        move |source| Self::Unwritable { path: path.to_owned(), source }
    }

    /// The error that a value in a file is not allowed, from the value and what is allowed.
    pub fn invalid(path: &Path) -> impl Fn(Invalid) -> Self + Copy {
        move |source| Self::Invalid { path: path.to_owned(), source }
    }
}

/// The largest file that is read, in MiB; files that this program writes stay below.
pub const LARGEST_FILE_MIB: u64 = 10;

/// Reads a text file of at most [`LARGEST_FILE_MIB`].
pub fn read_text(path: &Path) -> Result<String, SaveError> {
    text_of(path, read_bytes(path, LARGEST_FILE_MIB)?)
}

/// Reads a regular file of at most `limit_mib`. A device might never end, and a pipe might block for ever: both are
/// refused.
pub fn read_bytes(path: &Path, limit_mib: u64) -> Result<Vec<u8>, SaveError> {
    let unreadable = SaveError::unreadable(path);
    let limit = limit_mib * 1024 * 1024;
    let about = fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() {
        return Err(unreadable(std::io::Error::other("it is not a regular file")));
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

/// Reads a small text file.
///
/// # Errors
/// It cannot be read, is no text, or is larger than a MiB.
pub fn load_text(path: &Path) -> Result<String, SaveError> {
    text_of(path, read_bytes(path, 1)?)
}

/// Refuses anything that exists and is not a regular file, links included: a run's folder may come from anywhere, and
/// no name in it may lead out of it.
pub fn refuse_link(path: &Path) -> std::io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(about) if about.is_file() => Ok(()),
        Ok(_) => Err(std::io::Error::other("it is a link or not a regular file")),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Converts bytes to text; the error names the first byte that is not UTF-8.
pub fn text_of(path: &Path, bytes: Vec<u8>) -> Result<String, SaveError> {
    String::from_utf8(bytes).map_err(|error| SaveError::Damaged {
        path: path.to_owned(),
        line: 1,
        column: error.utf8_error().valid_up_to() + 1,
        problem: "not UTF-8 text".to_owned(),
    })
}

/// Parses RON; the error names the line and column.
pub fn parse<T: serde::de::DeserializeOwned>(path: &Path, text: &str) -> Result<T, SaveError> {
    ron::from_str(text).map_err(|error| damaged(path, error))
}

/// The error of a text that is no RON of the expected type.
pub fn damaged(path: &Path, error: ron::error::SpannedError) -> SaveError {
    SaveError::Damaged {
        path: path.to_owned(),
        line: error.span.start.line,
        column: error.span.start.col,
        problem: match error.code {
            // The parser would name a type of this program.
            ron::Error::ExpectedNamedStructLike(_)
            | ron::Error::ExpectedStructLike
            | ron::Error::ExpectedDifferentStructName { .. } => {
                "fields in parentheses are expected here".to_owned()
            }
            code => single_line(&code.to_string()),
        },
    }
}

/// Shortens a parser's message to one line without control characters: it may quote the file, which must not be able to
/// control a terminal.
pub fn single_line(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    plain.take(200).collect()
}

/// The part of a file that states its kind and format; the rest is skipped.
#[derive(Deserialize)]
pub struct Header {
    #[serde(default)]
    kind: String,
    #[serde(default)]
    format: u32,
}

impl Header {
    /// The kind that a text states; none of a damaged text, or one without a kind.
    pub fn kind_of(text: &str) -> Option<String> {
        let Self { kind, .. } = ron::from_str(text).ok()?;
        (!kind.is_empty()).then_some(kind)
    }

    /// Checks that a file is of the expected kind and in the supported format.
    pub fn check(
        path: &Path,
        text: &str,
        expected: &'static str,
        supported: u32,
    ) -> Result<(), SaveError> {
        let Self { kind, format } = parse(path, text)?;
        if kind != expected {
            let (path, found) = (path.to_owned(), quoted(&kind));
            return Err(SaveError::Foreign { path, found, expected });
        }
        check_format(path, format, supported)
    }
}

/// Checks a file's format; 0 stands for a file that does not state one.
pub fn check_format(path: &Path, found: u32, supported: u32) -> Result<(), SaveError> {
    let path = path.to_owned();
    if found == 0 {
        let source = Invalid::new("format", "0 or missing", supported.to_string());
        return Err(SaveError::Invalid { path, source });
    }
    if found == supported { Ok(()) } else { Err(SaveError::OtherFormat { path, found, supported }) }
}

/// The files of these names, without their extension, in a folder of the assets: each with its name and text.
macro_rules! embedded {
    ($folder:literal; $($name:literal),* $(,)?) => {
        &[$((
            concat!($name, ".ron"),
            include_str!(concat!("../../../../assets/", $folder, "/", $name, ".ron")),
        )),*]
    };
}
pub(super) use embedded;

/// The names of embedded files, without their extension.
pub fn embedded_names(files: &[(&'static str, &str)]) -> Vec<&'static str> {
    files.iter().map(|(file, _)| file.trim_end_matches(".ron")).collect()
}

/// The numbers N for which a folder has a file `<prefix>N.ron`, in no particular order.
pub fn numbered(folder: &Path, prefix: &str) -> Result<Vec<u32>, SaveError> {
    let unreadable = SaveError::unreadable(folder);
    let mut numbers = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.file_name();
        let number = file.to_str().and_then(|file| {
            let digits = file.strip_prefix(prefix)?.strip_suffix(".ron")?;
            let number = digits.parse::<u32>().ok()?;
            // Not a copy that a user named `generation-01.ron`.
            (number.to_string() == digits).then_some(number)
        });
        numbers.extend(number);
    }
    Ok(numbers)
}

/// RON with line breaks and indentation.
pub fn pretty(path: &Path, file: &impl Serialize) -> Result<String, SaveError> {
    let layout = PrettyConfig::new().compact_arrays(true).struct_names(false);
    ron::ser::to_string_pretty(file, layout).map(|text| text + "\n").map_err(|error| {
        SaveError::Unwritable { path: path.to_owned(), source: std::io::Error::other(error) }
    })
}

/// Writes readable RON atomically.
pub fn store_ron(path: &Path, file: &impl Serialize) -> Result<(), SaveError> {
    write_whole(path, pretty(path, file)?.as_bytes())
}

/// The names of all entries of a folder, hidden ones included, sorted.
#[cfg(test)]
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Time of the last change, since the beginning of 1970; zero if it is unknown.
pub(super) fn modified(about: &fs::Metadata) -> Duration {
    about.modified().ok().and_then(|at| at.duration_since(UNIX_EPOCH).ok()).unwrap_or_default()
}
