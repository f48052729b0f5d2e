//! Other runs of the saves folder, shown in the charts beside the current one.

use std::path::{Path, PathBuf};

use snakes_core::evolve::{GenerationRecord, RunPlan};
use snakes_core::save::{RunSummary, SavesFolder, load_log};
use snakes_lab::run::BackgroundTask;

/// Known runs, and those compared with the current one.
#[derive(Debug, Default)]
pub(crate) struct ComparedRuns {
    listing: Option<BackgroundTask<Vec<RunSummary>>>,
    /// All runs in the saves folder; `None` until listed.
    runs: Option<Vec<RunSummary>>,
    compared: Vec<ComparedCurve>,
    /// Incremented with every change.
    version: u64,
}

/// The learning curve of another run, drawn over that of the current one.
#[derive(Debug)]
pub(crate) struct ComparedCurve {
    /// Its folder.
    pub folder: PathBuf,
    reading: Option<BackgroundTask<Result<Other, String>>>,
    /// Contents or read error, once read.
    pub read: Option<Result<Other, String>>,
}

/// A run read from the saves folder.
#[derive(Debug)]
pub(crate) struct Other {
    /// Its plan.
    pub plan: RunPlan,
    /// Its finished generations, in order.
    pub records: Vec<GenerationRecord>,
}

/// Maximum number of compared runs: the lines of more could not be told apart.
pub(crate) const MOST_COMPARED: usize = 3;

impl ComparedRuns {
    /// Starts to list all runs.
    pub fn list(&mut self, saves: SavesFolder) -> Result<(), String> {
        let listing = BackgroundTask::start(move || saves.runs());
        self.listing =
            Some(listing.map_err(|error| format!("The runs cannot be listed: {error}"))?);
        Ok(())
    }

    /// Adds a run to the comparison, or removes it.
    pub fn toggle(&mut self, folder: &Path) -> Result<(), String> {
        self.version += 1;
        if let Some(place) = self.compared.iter().position(|run| run.folder == folder) {
            self.compared.remove(place);
            return Ok(());
        }
        if self.compared.len() >= MOST_COMPARED {
            return Err(format!("The chart has room for {MOST_COMPARED} other runs."));
        }
        let path = folder.to_owned();
        let reading = BackgroundTask::start(move || {
            let (plan, records) = load_log(&path).map_err(|error| error.to_string())?;
            Ok(Other { plan, records })
        });
        let reading = reading.map_err(|error| format!("The run cannot be read: {error}"))?;
        let folder = folder.to_owned();
        self.compared.push(ComparedCurve { folder, reading: Some(reading), read: None });
        Ok(())
    }

    /// Receives results of the background tasks.
    pub fn take_in(&mut self) {
        if let Some(runs) = self.listing.as_ref().and_then(BackgroundTask::poll) {
            (self.runs, self.listing) = (Some(runs.unwrap_or_default()), None);
            self.version += 1;
        }
        for run in &mut self.compared {
            if let Some(read) = run.reading.as_ref().and_then(BackgroundTask::poll) {
                run.read = Some(read.flatten());
                run.reading = None;
                self.version += 1;
            }
        }
    }

    /// All runs in the saves folder; `None` until listed.
    pub fn runs(&self) -> Option<&[RunSummary]> {
        self.runs.as_deref()
    }

    /// The runs compared with the current one.
    pub fn compared(&self) -> &[ComparedCurve] {
        &self.compared
    }

    /// Changes with every change.
    pub fn version(&self) -> u64 {
        self.version
    }
}
