//! Lines of JSON that are only ever added to, each with a checksum of its own.
//!
//! The checksum (XXH3, 64 bits) is the last field of the line, over all that stands before it. A line that
//! was cut off by a kill, a full disk or a power cut is at the end and does not end, and is left out; a whole
//! line that is wrong is damage.

use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use xxhash_rust::xxh3::xxh3_64;

use super::SaveError;
use super::files::{LARGEST_FILE_MIB, read_bytes, refuse_link, tamed};

/// A log that is open for writing.
#[derive(Debug)]
pub struct Log {
    path: PathBuf,
    file: File,
    /// Where the last whole line ends: what lies beyond is overwritten.
    end: u64,
}

const BEFORE_SUM: &str = ",\"sum\":\"";
const AFTER_SUM: &str = "\"}";
const SUM_DIGITS: usize = 16;

impl Log {
    /// Opens a log to go on after its first `kept` lines, which must be whole; makes it, if there is none.
    pub fn open(path: &Path, kept: usize) -> Result<Self, SaveError> {
        let unwritable = |source| SaveError::Unwritable { path: path.to_owned(), source };
        refuse_link(path).map_err(unwritable)?;
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false).open(path);
        let file = file.map_err(unwritable)?;
        let end = if kept == 0 {
            0
        } else {
            let bytes = read_bytes(path, LARGEST_FILE_MIB)?;
            bytes.split_inclusive(|byte| *byte == b'\n').take(kept).map(<[u8]>::len).sum()
        };
        file.set_len(end as u64).map_err(unwritable)?;
        Ok(Self { path: path.to_owned(), file, end: end as u64 })
    }

    /// Adds a line that survives a power cut. If that fails, the next line takes its place.
    pub fn append(&mut self, entry: &impl Serialize) -> Result<(), SaveError> {
        self.write(entry, true)
    }

    /// Adds a line that survives a kill, and a power cut only with luck; none, if the log would become too
    /// long to be read again.
    pub fn append_lightly(&mut self, entry: &impl Serialize) -> Result<(), SaveError> {
        self.write(entry, false)
    }

    fn write(&mut self, entry: &impl Serialize, to_disk: bool) -> Result<(), SaveError> {
        let unwritable = |source| SaveError::Unwritable { path: self.path.clone(), source };
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
            // What was said not to be written shall not count later.
            let _ = self.file.set_len(self.end);
            return Err(unwritable(error));
        }
        self.end = end;
        Ok(())
    }
}

/// Reads the bytes of a log. A log that is not there has none.
///
/// # Errors
/// The file is unreadable or too large.
pub fn read_log_bytes(path: &Path) -> Result<Vec<u8>, SaveError> {
    refuse_link(path).map_err(|source| SaveError::Unreadable { path: path.to_owned(), source })?;
    if path.exists() { read_bytes(path, LARGEST_FILE_MIB) } else { Ok(Vec::new()) }
}

/// Reads the whole lines of a log's bytes; `path` is what errors call it.
///
/// # Errors
/// A whole line is damaged.
pub fn parse_log<T: DeserializeOwned>(path: &Path, bytes: &[u8]) -> Result<Vec<T>, SaveError> {
    let mut entries = Vec::new();
    for (index, line) in bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
        match entry_of(line) {
            Ok(entry) => entries.push(entry),
            // Cut off while it was written.
            Err(_) if !line.ends_with(b"\n") => break,
            Err(problem) => {
                let path = path.to_owned();
                return Err(SaveError::Damaged { path, line: index + 1, column: 1, problem });
            }
        }
    }
    Ok(entries)
}

fn line_of(entry: &impl Serialize) -> serde_json::Result<String> {
    let mut line = serde_json::to_string(entry)?;
    // Every entry is an object: its brace is opened again for one more field.
    line.pop();
    let sum = xxh3_64(line.as_bytes());
    line += &format!("{BEFORE_SUM}{sum:016x}{AFTER_SUM}\n");
    Ok(line)
}

fn entry_of<T: DeserializeOwned>(line: &[u8]) -> Result<T, String> {
    let checked = || {
        let line = std::str::from_utf8(line).ok()?.strip_suffix('\n')?.strip_suffix(AFTER_SUM)?;
        let (line, sum) = line.split_at_checked(line.len().checked_sub(SUM_DIGITS)?)?;
        let line = line.strip_suffix(BEFORE_SUM)?;
        (u64::from_str_radix(sum, 16) == Ok(xxh3_64(line.as_bytes()))).then_some(line)
    };
    let line = checked().ok_or("the line does not fit its checksum")?;
    serde_json::from_str(&format!("{line}}}")).map_err(|error| tamed(&error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;
    use std::fs;

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Entry {
        number: u32,
        mean: f64,
    }

    fn read_log<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, SaveError> {
        parse_log(path, &read_log_bytes(path)?)
    }

    fn entries() -> Vec<Entry> {
        [0.1 + 0.2, f64::MIN_POSITIVE, -7.233_333_333_333_333]
            .into_iter()
            .zip(1..)
            .map(|(mean, number)| Entry { number, mean })
            .collect()
    }

    #[test]
    fn a_log_does_not_grow_beyond_what_is_read_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log.jsonl");
        let mut log = Log::open(&path, 0).expect("opened");
        let long = vec![0.123_456_78; 100_000];
        let written =
            (0..20).take_while(|_| log.append_lightly(&Long { long: long.clone() }).is_ok());
        let written = written.count();
        assert!((5..20).contains(&written), "{written}");
        assert_eq!(read_log::<serde_json::Value>(&path).expect("read").len(), written);
    }

    #[derive(Serialize)]
    struct Long {
        long: Vec<f64>,
    }

    fn written(folder: &tempfile::TempDir) -> PathBuf {
        let path = folder.path().join("log.jsonl");
        let mut log = Log::open(&path, 0).expect("opened");
        entries().iter().for_each(|entry| log.append(entry).expect("written"));
        path
    }

    #[test]
    fn entries_come_back_in_every_bit_and_a_reader_of_json_lines_understands_them() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        assert_eq!(read_log::<Entry>(&path).expect("read"), entries());
        assert_eq!(read_log::<Entry>(&folder.path().join("none")).expect("none"), []);
        let text = fs::read_to_string(&path).expect("read");
        let values = text.lines().map(|line| serde_json::from_str(line).expect("JSON"));
        let values: Vec<serde_json::Value> = values.collect();
        assert_eq!(values[1]["number"], 2);
    }

    #[test]
    fn wherever_the_last_line_is_cut_off_the_others_are_kept_and_it_is_written_anew() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        let whole = fs::read(&path).expect("read");
        let two =
            whole.len() - whole.split_inclusive(|b| *b == b'\n').next_back().map_or(0, <[u8]>::len);
        for length in two..whole.len() {
            fs::write(&path, &whole[..length]).expect("written");
            let kept = read_log::<Entry>(&path).expect("read");
            assert_eq!(kept, entries()[..2], "cut off at {length}");
            let mut log = Log::open(&path, kept.len()).expect("opened");
            log.append(&entries()[2]).expect("written");
            assert_eq!(fs::read(&path).expect("read"), whole);
        }
    }

    #[test]
    fn a_flipped_bit_in_the_middle_is_damage_with_its_line() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(&folder);
        let whole = fs::read(&path).expect("read");
        let first = whole.iter().position(|byte| *byte == b'\n').expect("a line");
        for place in (0..first).chain(whole.len() - first / 2..whole.len() - 1) {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            let error = parse_log::<Entry>(&path, &bytes).expect_err("damaged").to_string();
            assert!(error.contains("damaged or incomplete at line"), "{error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }
}
