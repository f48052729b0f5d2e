//! What every run of this session shares: the evaluator, the folder of saves, the plan of the next run.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use bevy::prelude::*;

use super::options::Options;
use crate::evolve::RunPlan;
use crate::run::{Evaluator, RunSource};
use crate::save::{PresetList, SavesFolder};

/// What every run of this session shares.
#[derive(Resource, Debug, Clone)]
pub(crate) struct RunContext {
    /// Evaluates the genomes of runs.
    pub evaluator: Arc<dyn Evaluator>,
    /// Where runs are saved.
    pub saves: SavesFolder,
    /// The run the studio opens with.
    pub first: RunSource,
    /// The run after the current one.
    pub next: RunPlan,
    /// The presets that can be chosen.
    pub presets: Arc<PresetList>,
    run_folder: RunInProgress,
}

impl RunContext {
    /// The context of the first run.
    pub fn new(options: &Options) -> Self {
        Self {
            evaluator: Arc::clone(&options.evaluator),
            saves: options.saves.clone(),
            first: options.run.clone(),
            next: options.run.plan.clone(),
            presets: Arc::new(PresetList::read(&options.saves)),
            run_folder: RunInProgress::default(),
        }
    }

    /// Where it is kept in which folder a run is going on.
    pub fn run_folder(&self) -> RunInProgress {
        Arc::clone(&self.run_folder)
    }

    /// Keeps in which folder a run is going on that could go on later, if one is.
    pub fn set_run_folder(&self, folder: Option<PathBuf>) {
        *self.run_folder.lock().unwrap_or_else(PoisonError::into_inner) = folder;
    }
}

/// The folder of the run that is going on, if one is.
pub(crate) type RunInProgress = Arc<Mutex<Option<PathBuf>>>;
