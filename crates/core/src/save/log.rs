//! An append-only log: lines of JSON, each with its own checksum.
//!
//! The checksum (XXH3, 64 bits) is the last field of a line and covers everything before it. A kill, a full disk or a power cut can only
//! leave an incomplete last line, which is ignored. A complete line with a wrong checksum is an error. Line ends and a byte order mark, which
//! other programs convert, are not covered.

use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use xxhash_rust::xxh3::xxh3_64;

use super::SaveError;
use super::files::{
    LARGEST_FILE_MIB, UTF_16, is_utf_16, read_bytes, refuse_link, single_line, without_mark,
};
use super::replaced::refuse_protected;

/// A log that is open for writing.
#[derive(Debug)]
pub struct Log {
    path: PathBuf,
    file: File,
    /// Length of the complete lines, in bytes. The next line overwrites anything beyond.
    end: u64,
}

const BEFORE_SUM: &str = ",\"sum\":\"";
const AFTER_SUM: &str = "\"}";
const SUM_DIGITS: usize = 16;

impl Log {
    /// Opens a log to continue it after its first `kept` lines, which must be complete. Creates it if it does not exist.
    pub fn open(path: &Path, kept: usize) -> Result<Self, SaveError> {
        let unwritable = SaveError::unwritable(path);
        refuse_link(path).map_err(unwritable)?;
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false).open(path);
        let file = file.map_err(unwritable)?;
        file.metadata().and_then(|about| refuse_protected(&about)).map_err(unwritable)?;
        let end = if kept == 0 {
            0
        } else {
            let bytes = read_bytes(path, LARGEST_FILE_MIB)?;
            bytes.split_inclusive(|byte| *byte == b'\n').take(kept).map(<[u8]>::len).sum()
        };
        file.set_len(end as u64).map_err(unwritable)?;
        Ok(Self { path: path.to_owned(), file, end: end as u64 })
    }

    /// Adds a line and flushes it to the disk, so that it survives a power cut. If writing fails, the next line replaces it.
    pub fn append(&mut self, entry: &impl Serialize) -> Result<(), SaveError> {
        self.write(entry, true)
    }

    /// Adds a line without flushing it: it survives a kill, but perhaps not a power cut. Fails if the log would become too large to be
    /// read.
    pub fn append_lightly(&mut self, entry: &impl Serialize) -> Result<(), SaveError> {
        self.write(entry, false)
    }

    fn write(&mut self, entry: &impl Serialize, to_disk: bool) -> Result<(), SaveError> {
        let unwritable = SaveError::unwritable(&self.path);
        let line = line_of(entry).map_err(|error| unwritable(std::io::Error::other(error)))?;
        let end = self.end + line.len() as u64;
        if end > LARGEST_FILE_MIB * 1024 * 1024 {
            let (path, limit_mib) = (self.path.clone(), LARGEST_FILE_MIB);
            return Err(SaveError::TooLarge { path, limit_mib });
        }
        self.file.seek(SeekFrom::Start(self.end)).map_err(unwritable)?;
        let written = self.file.write_all(line.as_bytes());
        let written = written.and_then(|()| if to_disk { self.file.sync_data() } else { Ok(()) });
        if let Err(error) = written {
            // The line is reported as not written, so it must not remain in the log.
            let _ = self.file.set_len(self.end);
            return Err(unwritable(error));
        }
        self.end = end;
        Ok(())
    }
}

/// Reads the bytes of a log; empty if the file does not exist.
///
/// # Errors
/// Fails if the file is unreadable or too large.
pub fn read_log_bytes(path: &Path) -> Result<Vec<u8>, SaveError> {
    refuse_link(path).map_err(SaveError::unreadable(path))?;
    if path.exists() { read_bytes(path, LARGEST_FILE_MIB) } else { Ok(Vec::new()) }
}

/// Parses the complete lines of a log; errors name the file `path`.
///
/// # Errors
/// Fails if a complete line is damaged.
pub fn parse_log<T: DeserializeOwned>(path: &Path, bytes: &[u8]) -> Result<Vec<T>, SaveError> {
    let mut entries = Vec::new();
    for (index, line) in without_mark(bytes).split_inclusive(|byte| *byte == b'\n').enumerate() {
        match entry_of(line) {
            Ok(entry) => entries.push(entry),
            // An incomplete last line: the program was stopped while it wrote the line.
            Err(_) if !line.ends_with(b"\n") => break,
            Err(problem) => {
                let problem = if is_utf_16(bytes) { UTF_16.to_owned() } else { problem };
                let path = path.to_owned();
                return Err(SaveError::Damaged { path, line: index + 1, column: 1, problem });
            }
        }
    }
    Ok(entries)
}

fn line_of(entry: &impl Serialize) -> serde_json::Result<String> {
    let mut line = serde_json::to_string(entry)?;
    // Every line is an object. Its closing brace is removed to add one more field.
    line.pop();
    let sum = xxh3_64(line.as_bytes());
    line += &format!("{BEFORE_SUM}{sum:016x}{AFTER_SUM}\n");
    Ok(line)
}

fn entry_of<T: DeserializeOwned>(line: &[u8]) -> Result<T, String> {
    let checked = || {
        let line = std::str::from_utf8(line).ok()?.strip_suffix('\n')?;
        let line = line.strip_suffix('\r').unwrap_or(line).strip_suffix(AFTER_SUM)?;
        let (line, sum) = line.split_at_checked(line.len().checked_sub(SUM_DIGITS)?)?;
        let line = line.strip_suffix(BEFORE_SUM)?;
        (u64::from_str_radix(sum, 16) == Ok(xxh3_64(line.as_bytes()))).then_some(line)
    };
    let line = checked().ok_or("the line does not match its checksum")?;
    serde_json::from_str(&format!("{line}}}")).map_err(|error| single_line(&error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;
    use std::fs;

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct TestLine {
        number: u32,
        mean: f64,
    }

    fn read_log<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, SaveError> {
        parse_log(path, &read_log_bytes(path)?)
    }

    fn entries() -> Vec<TestLine> {
        [0.1 + 0.2, f64::MIN_POSITIVE, -7.233_333_333_333_333]
            .into_iter()
            .zip(1..)
            .map(|(mean, number)| TestLine { number, mean })
            .collect()
    }

    #[test]
    fn a_log_stops_growing_at_the_largest_size_that_is_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log.jsonl");
        let mut log = Log::open(&path, 0).expect("opened");
        let long = serde_json::json!({ "long": vec![0.123_456_78; 100_000] });
        let written = (0..20).take_while(|_| log.append_lightly(&long).is_ok()).count();
        assert!((5..20).contains(&written), "{written}");
        assert_eq!(read_log::<serde_json::Value>(&path).expect("read").len(), written);
    }

    fn written(folder: &tempfile::TempDir) -> PathBuf {
        let path = folder.path().join("log.jsonl");
        let mut log = Log::open(&path, 0).expect("opened");
        entries().iter().for_each(|entry| log.append(entry).expect("written"));
        path
    }

    #[test]
    fn lines_are_read_back_bit_for_bit_and_are_valid_json() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        assert_eq!(read_log::<TestLine>(&path).expect("read"), entries());
        assert_eq!(read_log::<TestLine>(&folder.path().join("none")).expect("none"), []);
        let text = fs::read_to_string(&path).expect("read");
        let values = text.lines().map(|line| serde_json::from_str(line).expect("JSON"));
        let values: Vec<serde_json::Value> = values.collect();
        assert_eq!(values[1]["number"], 2);
    }

    #[test]
    fn f4_a_log_with_other_line_ends_is_read_and_continued() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        let text = fs::read_to_string(&path).expect("read");
        for mark in ["", "\u{feff}"] {
            fs::write(&path, format!("{mark}{}", text.replace('\n', "\r\n"))).expect("written");
            assert_eq!(read_log::<TestLine>(&path).expect("read"), entries());
            let mut log = Log::open(&path, 2).expect("opened");
            log.append(&entries()[2]).expect("written");
            assert_eq!(read_log::<TestLine>(&path).expect("read"), entries());
        }
        let utf_16 = "\u{feff}".encode_utf16().chain(text.encode_utf16());
        fs::write(&path, utf_16.flat_map(u16::to_le_bytes).collect::<Vec<u8>>()).expect("written");
        let error = read_log::<TestLine>(&path).expect_err("damaged").to_string();
        assert!(
            error.ends_with("line 1, column 1: the text is UTF-16; save it as UTF-8"),
            "{error}"
        );
        // Other changes of a line, such as blanks at its end, are damage as before.
        fs::write(&path, text.replace('\n', " \n")).expect("written");
        let error = read_log::<TestLine>(&path).expect_err("damaged").to_string();
        assert!(error.ends_with("the line does not match its checksum"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn f6_a_write_protected_log_is_refused_and_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o444);
        fs::set_permissions(&path, mode).expect("changed");
        let error = Log::open(&path, 1).expect_err("refused").to_string();
        assert!(error.contains("log.jsonl: cannot be written: "), "{error}");
        assert_eq!(read_log::<TestLine>(&path).expect("read"), entries());
    }

    #[test]
    fn an_incomplete_last_line_is_ignored_and_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        let whole = fs::read(&path).expect("read");
        let two =
            whole.len() - whole.split_inclusive(|b| *b == b'\n').next_back().map_or(0, <[u8]>::len);
        for length in two..whole.len() {
            fs::write(&path, &whole[..length]).expect("written");
            let kept = read_log::<TestLine>(&path).expect("read");
            assert_eq!(kept, entries()[..2], "cut off at {length}");
            let mut log = Log::open(&path, kept.len()).expect("opened");
            log.append(&entries()[2]).expect("written");
            assert_eq!(fs::read(&path).expect("read"), whole);
        }
    }

    #[test]
    fn a_flipped_bit_in_a_complete_line_is_damage() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        let whole = fs::read(&path).expect("read");
        let first = whole.iter().position(|byte| *byte == b'\n').expect("a line");
        for place in (0..first).chain(whole.len() - first / 2..whole.len() - 1) {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            let error = parse_log::<TestLine>(&path, &bytes).expect_err("damaged").to_string();
            assert!(error.contains("damaged or incomplete at line"), "{error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }
}
