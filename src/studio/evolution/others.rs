//! Other runs in the folder of saves, to be laid over the current one.

use std::path::{Path, PathBuf};

use crate::evolve::RunPlan;
use crate::run::{Listing, LogReading};
use crate::save::{GenerationRecord, RunSummary, SavesFolder};

/// The other runs that are known, and those that are compared with the current one.
#[derive(Debug, Default)]
pub(in crate::studio) struct Others {
    listing: Option<Listing>,
    /// All runs in the folder of saves, once somebody has asked for them.
    runs: Option<Vec<RunSummary>>,
    compared: Vec<Compared>,
    /// Grows with every change.
    version: u64,
}

/// A run that is compared with the current one.
#[derive(Debug)]
pub(in crate::studio) struct Compared {
    /// Its folder.
    pub folder: PathBuf,
    reading: Option<LogReading>,
    /// What was read, once it is there; or what is wrong with it.
    pub read: Option<Result<Other, String>>,
}

/// Another run.
#[derive(Debug)]
pub(in crate::studio) struct Other {
    /// What run it is.
    pub plan: RunPlan,
    /// Its finished generations, the first first.
    pub records: Vec<GenerationRecord>,
}

/// More lines than those of so many other runs nobody could tell apart.
pub(in crate::studio) const MOST_COMPARED: usize = 3;

impl Others {
    /// Begins to look for all runs.
    pub fn list(&mut self, saves: SavesFolder) -> Result<(), String> {
        let listing = Listing::start(saves);
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
        let reading = LogReading::start(folder.to_owned());
        let reading = reading.map_err(|error| format!("The run cannot be read: {error}"))?;
        let folder = folder.to_owned();
        self.compared.push(Compared { folder, reading: Some(reading), read: None });
        Ok(())
    }

    /// Takes in what was found meanwhile.
    pub fn take_in(&mut self) {
        if let Some(runs) = self.listing.as_ref().and_then(Listing::poll) {
            (self.runs, self.listing) = (Some(runs), None);
            self.version += 1;
        }
        for run in &mut self.compared {
            if let Some(read) = run.reading.as_ref().and_then(LogReading::poll) {
                run.read = Some(read.map(|(plan, records)| Other { plan, records }));
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
    pub fn compared(&self) -> &[Compared] {
        &self.compared
    }

    /// Another number after every change.
    pub fn version(&self) -> u64 {
        self.version
    }
}
