//! Saves the best of a run as soon as it is found, so that a crash or a closed window loses nothing.

use std::path::{Path, PathBuf};

use super::Experiment;
use crate::save::{SaveError, SavesFolder, champion_file_name, store_champion};

/// Writes each new best champion of one run to its own file.
#[derive(Debug)]
pub struct Keeper {
    saves: SavesFolder,
    kept: Option<PathBuf>,
}

impl Keeper {
    /// A keeper that writes into `saves`.
    pub fn new(saves: SavesFolder) -> Self {
        Self { saves, kept: None }
    }

    /// Saves the experiment's best champion, unless it is saved already.
    ///
    /// # Errors
    /// The folder or the file cannot be written.
    pub fn keep_best(&mut self, experiment: &Experiment) -> Result<(), SaveError> {
        let Some(best) = experiment.best() else { return Ok(()) };
        let name = champion_file_name(&best.origin, experiment.settings());
        let path = self.saves.path().join(name);
        if self.kept.as_ref() != Some(&path) {
            self.saves.prepare()?;
            store_champion(&path, best)?;
            self.kept = Some(path);
        }
        Ok(())
    }

    /// The file of the best champion so far.
    pub fn kept(&self) -> Option<&Path> {
        self.kept.as_deref()
    }
}
