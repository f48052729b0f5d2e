//! A lock with which only one program at a time writes into a run's folder.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::Read;
use std::path::Path;

use super::SaveError;
use super::files::refuse_link;

/// The exclusive right to write into a folder. The operating system releases it when the program ends, even after a crash.
#[derive(Debug)]
pub struct Lock {
    /// Lock file, which stays open and locked until this value is dropped.
    _file: File,
}

/// Name of the lock file.
pub const LOCK_FILE: &str = "lock";

/// Name of the file with the process number and name of the lock's owner. It is separate from the lock file, because Windows lets no other
/// program read a locked file.
pub const OWNER_FILE: &str = "lock-owner";

impl Lock {
    /// Takes the lock of a folder. Other programs report `owner` as the owner's name, such as "the studio".
    ///
    /// # Errors
    /// Fails if another program holds the lock (the error names it), or if the lock file cannot be written.
    pub fn take(folder: &Path, owner: &str) -> Result<Self, SaveError> {
        let path = folder.join(LOCK_FILE);
        let unwritable = SaveError::unwritable(&path);
        let owner_path = folder.join(OWNER_FILE);
        refuse_link(&path).map_err(unwritable)?;
        refuse_link(&owner_path).map_err(SaveError::unwritable(&owner_path))?;
        let mut options = OpenOptions::new();
        // The file is not truncated before it is locked, so that a program without the lock changes nothing.
        options.read(true).write(true).create(true).truncate(false);
        let file = options.open(&path).map_err(unwritable)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(SaveError::InUse {
                    path: folder.to_owned(),
                    owner: read_owner(&owner_path),
                });
            }
            Err(TryLockError::Error(source)) => return Err(unwritable(source)),
        }
        let owner = format!("process {} ({owner})\n", std::process::id());
        // On a full disk the lock still works; only the owner's name is missing.
        let _ = fs::write(&owner_path, owner);
        Ok(Self { _file: file })
    }
}

/// Returns the owner's name from its file.
fn read_owner(path: &Path) -> String {
    let mut bytes = Vec::new();
    // If the name cannot be read, the lock is still held.
    let _ = File::open(path).and_then(|file| file.take(100).read_to_end(&mut bytes));
    let text = String::from_utf8_lossy(&bytes);
    let text: String = text.trim().chars().filter(|c| !c.is_control()).collect();
    if text.is_empty() { "another program".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_lock_is_refused_with_the_owners_name_until_the_first_is_dropped() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Lock::take(folder.path(), "the studio").expect("free");
        let refusal = Lock::take(folder.path(), "headless").expect_err("held").to_string();
        let owner = format!("in use by process {} (the studio)", std::process::id());
        assert!(refusal.contains(&owner), "{refusal}");
        drop(first);
        Lock::take(folder.path(), "headless").expect("free again");
    }
}
