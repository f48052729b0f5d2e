//! Saves the champion of each generation as soon as it is found, so that a crash or a closed window
//! loses nothing.

use std::path::{Path, PathBuf};

use super::Experiment;
use crate::evolve::Champion;
use crate::save::{SaveError, SavesFolder, champion_file_name, run_name, store_champion};

/// Writes the champions of one run into a folder of its own.
#[derive(Debug)]
pub struct Keeper {
    saves: SavesFolder,
    /// The best champion's file, and what it reached.
    best: Option<(PathBuf, f32)>,
}

impl Keeper {
    /// A keeper that makes the run's folder in `saves`.
    pub fn new(saves: SavesFolder) -> Self {
        Self { saves, best: None }
    }

    /// Saves the champion of the generation that was just finished, if it has one.
    ///
    /// # Errors
    /// The folder or the file cannot be written.
    pub fn keep(
        &mut self,
        experiment: &Experiment,
        champion: Option<&Champion>,
    ) -> Result<(), SaveError> {
        let Some(champion) = champion else { return Ok(()) };
        let origin = &champion.origin;
        let run = run_name(&origin.preset, origin.seed, experiment.settings());
        let folder = SavesFolder::find(Some(&self.saves.path().join(run)));
        folder.prepare()?;
        let path = folder.path().join(champion_file_name(origin.generation));
        store_champion(&path, champion)?;
        let fitness = champion.evaluation.fitness;
        if self.best.as_ref().is_none_or(|(_, best)| fitness > *best) {
            self.best = Some((path, fitness));
        }
        Ok(())
    }

    /// The file of the best champion so far.
    pub fn best(&self) -> Option<&Path> {
        self.best.as_ref().map(|(path, _)| path.as_path())
    }
}
