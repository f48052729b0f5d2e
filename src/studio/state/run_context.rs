//! Evaluator, saves folder and presets, which all runs since the start of the program use.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use super::options::Options;
use snakes_core::save::{KnownFiles, NamedStairs, Preset, SavesFolder};
use snakes_lab::run::{Evaluator, RunSource};

/// Evaluator, saves folder and presets, which all runs since the start of the program use.
#[derive(Debug, Clone)]
pub(crate) struct RunContext {
    /// Evaluator of the genomes of runs.
    pub evaluator: Arc<dyn Evaluator>,
    /// Folder in which runs and champions are saved.
    pub saves: SavesFolder,
    /// Run with which the studio opens.
    pub first: RunSource,
    /// Presets that the user can choose.
    pub presets: Arc<KnownFiles<Preset>>,
    /// Stairs that the user can choose.
    pub stairs: Arc<KnownFiles<NamedStairs>>,
    /// Shared cell with the folder of the run in progress.
    pub run_folder: RunInProgress,
}

impl RunContext {
    pub fn new(options: &Options) -> Self {
        Self {
            evaluator: Arc::clone(&options.evaluator),
            saves: options.saves.clone(),
            first: options.run.clone(),
            presets: Arc::new(KnownFiles::read(&options.saves)),
            stairs: Arc::new(KnownFiles::read(&options.saves)),
            run_folder: RunInProgress::default(),
        }
    }

    /// Sets the folder of the run in progress, which could be resumed after a crash; `None` without a run.
    pub fn set_run_folder(&self, folder: Option<PathBuf>) {
        *self.run_folder.lock().unwrap_or_else(PoisonError::into_inner) = folder;
    }
}

/// Shared cell with the folder of the run in progress, if any.
pub(crate) type RunInProgress = Arc<Mutex<Option<PathBuf>>>;
