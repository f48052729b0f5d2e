//! Reading of text with a limited size, and writing of RON.

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
        /// Path of the file.
        path: PathBuf,
        /// Reason that the operating system gave.
        source: std::io::Error,
    },
    /// The file or its folder could not be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Unwritable {
        /// Path of the file or folder.
        path: PathBuf,
        /// Reason that the operating system gave.
        source: std::io::Error,
    },
    /// The file is larger than any that this program writes.
    #[error("{}: the file is larger than {limit_mib} MiB, the largest that is read", path.display())]
    TooLarge {
        /// Path of the file.
        path: PathBuf,
        /// Largest size that is read, in MiB.
        limit_mib: u64,
    },
    /// The text of the file is damaged, or ends too early.
    #[error("{}: damaged or incomplete at line {line}, column {column}: {problem}", path.display())]
    Damaged {
        /// Path of the file.
        path: PathBuf,
        /// Line of the damage, counted from 1.
        line: usize,
        /// Column of the damage, counted from 1.
        column: usize,
        /// Description of the damage.
        problem: String,
    },
    /// The file is well-formed, but of another kind.
    #[error("{}: kind is {found}; allowed: {expected:?}", path.display())]
    Foreign {
        /// Path of the file.
        path: PathBuf,
        /// Kind that the file states.
        found: String,
        /// Kind that the file should state.
        expected: &'static str,
    },
    /// The file has a format that this version does not read.
    #[error("{}: format is {found}; allowed: {supported} ({} wrote this file)", path.display(),
        if found > supported { "a newer version of Snakes & Stairs" } else { "a version before the first release" })]
    OtherFormat {
        /// Path of the file.
        path: PathBuf,
        /// Format that the file has.
        found: u32,
        /// Format that this version reads.
        supported: u32,
    },
    /// Another program writes into the folder.
    #[error("{}: in use by {owner}", path.display())]
    InUse {
        /// Path of the folder.
        path: PathBuf,
        /// Process number and name of the other program.
        owner: String,
    },
    /// The folder contains a run with another preset, seed or setting.
    #[error("{}: holds another run; allowed: an empty folder, or the folder of the same run", path.display())]
    OtherRun {
        /// Path of the folder.
        path: PathBuf,
    },
    /// No built-in preset or stairs and no file have this name. The field tells which of the two was wanted.
    #[error("{0}")]
    Unknown(Invalid),
    /// A study with this name does not exist, or a value of a study is not allowed.
    #[error("{0}")]
    Study(Invalid),
    /// A value in the file is not allowed.
    #[error("{}: {source}", path.display())]
    Invalid {
        /// Path of the file.
        path: PathBuf,
        /// Name of the field, its value, and the allowed values.
        source: Invalid,
    },
}

impl From<SaveError> for String {
    fn from(error: SaveError) -> Self {
        error.to_string()
    }
}

impl SaveError {
    /// Makes the error of an unreadable file or folder from the system's reason.
    pub fn unreadable(path: &Path) -> impl Fn(std::io::Error) -> Self + Copy {
        move |source| Self::Unreadable { path: path.to_owned(), source }
    }

    /// Makes the error of an unwritable file or folder from the system's reason.
    pub fn unwritable(path: &Path) -> impl Fn(std::io::Error) -> Self + Copy {
        move |source| Self::Unwritable { path: path.to_owned(), source }
    }

    /// Makes the error of a value in a file that is not allowed.
    pub fn invalid(path: &Path) -> impl Fn(Invalid) -> Self + Copy {
        move |source| Self::Invalid { path: path.to_owned(), source }
    }
}

/// Largest file that is read, in MiB. Files that this program writes are smaller.
pub const LARGEST_FILE_MIB: u64 = 10;

/// Reads a text file of at most [`LARGEST_FILE_MIB`].
pub fn read_text(path: &Path) -> Result<String, SaveError> {
    text_of(path, read_bytes(path, LARGEST_FILE_MIB)?)
}

/// Reads a regular file of at most `limit_mib`. Devices and pipes are refused, because a device might never end and a pipe might block for
/// ever.
///
/// # Errors
/// Fails if the file cannot be read, is not a regular file, or is larger.
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

/// Reads a text file of at most 1 MiB.
///
/// # Errors
/// Fails if the file cannot be read, is not text, or is larger than 1 MiB.
pub fn load_text(path: &Path) -> Result<String, SaveError> {
    text_of(path, read_bytes(path, 1)?)
}

/// Refuses a path at which something other than a regular file exists, such as a link. A run's folder may come from anyone, and no file
/// name in it may lead out of the folder.
pub fn refuse_link(path: &Path) -> std::io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(about) if about.is_file() => Ok(()),
        Ok(_) => Err(std::io::Error::other("it is a link or not a regular file")),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Mark with which some editors begin UTF-8 text. It is no part of the text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Returns the bytes of a text without its byte order mark.
pub fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes)
}

/// Returns whether the bytes begin with the mark of UTF-16 text, into which some programs convert.
pub fn is_utf_16(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF")
}

/// Description of the damage of UTF-16 text.
pub const UTF_16: &str = "the text is UTF-16; save it as UTF-8";

/// Converts bytes to text, without a byte order mark. The error names the first byte that is not UTF-8.
pub fn text_of(path: &Path, mut bytes: Vec<u8>) -> Result<String, SaveError> {
    bytes.drain(..bytes.len() - without_mark(&bytes).len());
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let lines = || before.split(|byte| *byte == b'\n');
        SaveError::Damaged {
            path: path.to_owned(),
            line: lines().count(),
            column: lines().next_back().map_or(0, <[u8]>::len) + 1,
            problem: if is_utf_16(error.as_bytes()) { UTF_16 } else { "not UTF-8 text" }.to_owned(),
        }
    })
}

/// Parses RON; the error names the line and column.
pub fn parse<T: serde::de::DeserializeOwned>(path: &Path, text: &str) -> Result<T, SaveError> {
    ron::from_str(text).map_err(|error| damaged(path, error))
}

/// Makes the error of a text that is not RON of the expected type.
pub fn damaged(path: &Path, error: ron::error::SpannedError) -> SaveError {
    SaveError::Damaged {
        path: path.to_owned(),
        line: error.span.start.line,
        column: error.span.start.col,
        problem: match error.code {
            // The parser's message would name a type of this program.
            ron::Error::ExpectedNamedStructLike(_)
            | ron::Error::ExpectedStructLike
            | ron::Error::ExpectedDifferentStructName { .. } => {
                "fields in parentheses are expected here".to_owned()
            }
            code => single_line(&code.to_string()),
        },
    }
}

/// Shortens a parser's message to one line without control characters. The message may quote the file, which must not be able to control a
/// terminal.
pub fn single_line(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    plain.take(200).collect()
}

/// The kind and format that a file states; its other fields are skipped.
#[derive(Deserialize)]
pub struct Header {
    #[serde(default)]
    kind: String,
    #[serde(default)]
    format: u32,
}

impl Header {
    /// Returns the kind that a text states. None if the text is damaged or states no kind.
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

/// Checks a file's format; `found` is 0 for a file that does not state one.
pub fn check_format(path: &Path, found: u32, supported: u32) -> Result<(), SaveError> {
    let path = path.to_owned();
    if found == 0 {
        let source = Invalid::new("format", "0 or missing", supported.to_string());
        return Err(SaveError::Invalid { path, source });
    }
    if found == supported { Ok(()) } else { Err(SaveError::OtherFormat { path, found, supported }) }
}

/// Embeds the files with the given names, without extension, from a folder of the assets: each as its name and text.
macro_rules! embedded {
    ($folder:literal; $($name:literal),* $(,)?) => {
        &[$((
            concat!($name, ".ron"),
            include_str!(concat!("../../../../assets/", $folder, "/", $name, ".ron")),
        )),*]
    };
}
pub(super) use embedded;

/// Returns the names of embedded files, without their extension.
pub fn embedded_names(files: &[(&'static str, &str)]) -> Vec<&'static str> {
    files.iter().map(|(file, _)| file.trim_end_matches(".ron")).collect()
}

/// Returns the numbers N for which a folder has a file `<prefix>N.ron`, in no particular order.
pub fn numbered(folder: &Path, prefix: &str) -> Result<Vec<u32>, SaveError> {
    let unreadable = SaveError::unreadable(folder);
    let mut numbers = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.file_name();
        let number = file.to_str().and_then(|file| {
            let digits = file.strip_prefix(prefix)?.strip_suffix(".ron")?;
            let number = digits.parse::<u32>().ok()?;
            // A copy that a user named `generation-01.ron` is skipped.
            (number.to_string() == digits).then_some(number)
        });
        numbers.extend(number);
    }
    Ok(numbers)
}

/// Writes RON with line breaks and indentation.
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

/// Returns the names of all entries of a folder, hidden ones included, sorted.
#[cfg(test)]
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Returns the time of the last change, since the beginning of 1970; zero if it is unknown.
pub(super) fn modified(about: &fs::Metadata) -> Duration {
    about.modified().ok().and_then(|at| at.duration_since(UNIX_EPOCH).ok()).unwrap_or_default()
}

#[cfg(test)]
mod tests;
