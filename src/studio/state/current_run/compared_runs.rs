//! Other runs in the folder of saves, to be laid over the current one.

use std::path::{Path, PathBuf};

use crate::evolve::RunPlan;
use crate::run::BackgroundTask;
use crate::save::{GenerationRecord, RunSummary, SavesFolder, load_log};

/// The other runs that are known, and those that are compared with the current one.
#[derive(Debug, Default)]
pub(crate) struct ComparedRuns {
    listing: Option<BackgroundTask<Vec<RunSummary>>>,
    /// All runs in the folder of saves, once somebody has asked for them.
    runs: Option<Vec<RunSummary>>,
    compared: Vec<ComparedCurve>,
    /// Grows with every change.
    version: u64,
}

/// The learning curve of another run, drawn over that of the current one.
#[derive(Debug)]
pub(crate) struct ComparedCurve {
    /// Its folder.
    pub folder: PathBuf,
    reading: Option<BackgroundTask<Result<Other, String>>>,
    /// What was read, once it is there; or what is wrong with it.
    pub read: Option<Result<Other, String>>,
}

/// Another run.
#[derive(Debug)]
pub(crate) struct Other {
    /// What run it is.
    pub plan: RunPlan,
    /// Its finished generations, the first first.
    pub records: Vec<GenerationRecord>,
}

/// More lines than those of so many other runs nobody could tell apart.
pub(crate) const MOST_COMPARED: usize = 3;

impl ComparedRuns {
    /// Begins to look for all runs.
    pub fn list(&mut self, saves: SavesFolder) -> Result<(), String> {
        let listing = BackgroundTask::start(move || saves.runs());
        self.listing =
            Some(listing.map_err(|error| format!("The runs cannot be listed: {error}"))?);
        Ok(())
    }

    /// Lays a run over the current one, or takes it away again.
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

    /// Takes in what was found meanwhile.
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

    /// All runs in the folder of saves, once somebody has asked for them.
    pub fn runs(&self) -> Option<&[RunSummary]> {
        self.runs.as_deref()
    }

    /// Those that are compared with the current run.
    pub fn compared(&self) -> &[ComparedCurve] {
        &self.compared
    }

    /// Another number after every change.
    pub fn version(&self) -> u64 {
        self.version
    }
}
