//! What every run of this session shares: worker threads, the folder of saves, the plan of the next run.

use std::path::PathBuf;
use std::sync::{Arc, PoisonError};

use bevy::prelude::*;
use rayon::ThreadPool;

use super::presets::Presets;
use super::start_up::RunInProgress;
use super::{Options, StudioError};
use crate::evolve::RunPlan;
use crate::run::headless::HeadlessError;
use crate::run::{RunSource, pool};
use crate::save::SavesFolder;

/// What every run of this session shares.
#[derive(Resource, Debug, Clone)]
pub(super) struct Engine {
    /// The worker threads.
    pub pool: Arc<ThreadPool>,
    /// Where runs are saved.
    pub saves: SavesFolder,
    /// The run the studio opens with.
    pub first: RunSource,
    /// The run after the current one.
    pub next: RunPlan,
    /// The presets that can be chosen.
    pub presets: Arc<Presets>,
    run_folder: RunInProgress,
}

impl Engine {
    /// Starts the worker threads.
    pub fn new(options: &Options) -> Result<Self, StudioError> {
        let pool = pool(options.threads).map_err(HeadlessError::from)?;
        Ok(Self {
            pool: Arc::new(pool),
            saves: options.saves.clone(),
            first: options.run.clone(),
            next: options.run.plan.clone(),
            presets: Arc::new(Presets::read(&options.saves)),
            run_folder: RunInProgress::default(),
        })
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
