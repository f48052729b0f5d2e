//! Copies of champions in a temporary folder, for another program.

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

use super::library::plain_name;
use super::{SaveError, store_champion};
use crate::evolve::Champion;

/// Copies of champions, which are removed when this value is dropped.
#[derive(Debug)]
pub struct ChampionCopies {
    /// Temporary folder, which is removed when this value is dropped.
    _folder: TempDir,
    paths: Vec<PathBuf>,
}

impl ChampionCopies {
    /// Writes named champions to files, each under its name or the most similar name that a file can have.
    ///
    /// # Errors
    /// Fails if a file cannot be written.
    pub fn of(champions: &[(String, Champion)]) -> Result<Self, SaveError> {
        let around = std::env::temp_dir();
        let folder = tempfile::Builder::new().prefix("snakes-").tempdir_in(&around);
        let folder = folder.map_err(SaveError::unwritable(&around))?;
        let mut paths = Vec::new();
        for (number, (name, champion)) in champions.iter().enumerate() {
            // Each champion has its own folder, because names may be equal.
            let own = folder.path().join(number.to_string());
            fs::create_dir(&own).map_err(SaveError::unwritable(&own))?;
            let path = own.join(format!("{}.ron", plain_name(name)));
            store_champion(&path, champion, None)?;
            paths.push(path);
        }
        Ok(Self { _folder: folder, paths })
    }

    /// Returns the paths of the copies, in the order of the champions.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::{load_champion, shipped_champion};

    #[test]
    fn copies_have_the_names_of_their_champions_and_go_with_the_last_use() {
        let champion = shipped_champion().expect("well formed").champion;
        let named =
            ["climber", "climber", "../x/\"y\""].map(|name| (name.to_owned(), champion.clone()));
        let copies = ChampionCopies::of(&named).expect("written");
        let paths = copies.paths().to_vec();
        let stems = paths.iter().map(|path| path.file_stem().expect("a name").to_string_lossy());
        assert_eq!(stems.collect::<Vec<_>>(), ["climber", "climber", "xy"]);
        for path in &paths {
            assert_eq!(load_champion(path).expect("whole").champion, champion);
        }
        drop(copies);
        assert!(paths.iter().all(|path| !path.exists()));
    }
}
