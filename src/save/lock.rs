//! One program at a time writes into a run's folder.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::Path;

use super::SaveError;
use super::files::refuse_link;

/// The right to write into a folder. The operating system takes it back when the program ends, however
/// that happens.
#[derive(Debug)]
pub struct Lock {
    /// Open, and locked, for as long as this value lives.
    _file: File,
}

/// The lock's file; it says who holds it, for others to read.
pub const LOCK_FILE: &str = "lock";

impl Lock {
    /// Takes the lock of a folder. `who` is what others are told: "the studio".
    ///
    /// # Errors
    /// Another program holds it, which is named; or the file cannot be written.
    pub fn take(folder: &Path, who: &str) -> Result<Self, SaveError> {
        let path = folder.join(LOCK_FILE);
        let unwritable = |source| SaveError::Unwritable { path: path.clone(), source };
        refuse_link(&path).map_err(unwritable)?;
        let mut options = OpenOptions::new();
        // Not truncated: who does not get the lock must not wipe out who has it.
        options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(&path).map_err(unwritable)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(SaveError::InUse { path: folder.to_owned(), owner: owner(&mut file) });
            }
            Err(TryLockError::Error(source)) => return Err(unwritable(source)),
        }
        let owner = format!("process {} ({who})\n", std::process::id());
        let write = |file: &mut File| {
            file.set_len(0)?;
            file.rewind()?;
            file.write_all(owner.as_bytes())
        };
        // On a full disk the lock still holds; only its owner's name is missing.
        let _ = write(&mut file);
        Ok(Self { _file: file })
    }
}

/// Who holds the lock, in the few words it left.
fn owner(file: &mut File) -> String {
    let mut bytes = Vec::new();
    // Where a locked file cannot be read by others, nothing is found.
    let _ = file.take(100).read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes);
    let text: String = text.trim().chars().filter(|c| !c.is_control()).collect();
    if text.is_empty() { "another program".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_is_refused_with_the_owner_named_until_the_first_lets_go() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Lock::take(folder.path(), "the studio").expect("free");
        let refusal = Lock::take(folder.path(), "headless").expect_err("held").to_string();
        let owner = format!("in use by process {} (the studio)", std::process::id());
        assert!(refusal.contains(&owner), "{refusal}");
        drop(first);
        Lock::take(folder.path(), "headless").expect("free again");
    }
}
