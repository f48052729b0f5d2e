//! Other runs of the saves folder, which the charts show beside the current run.

use std::path::{Path, PathBuf};

use crate::studio::state::run_names::{difference, name_of_listed, tell_apart};
use snakes_core::evolve::{GenerationRecord, RunPlan};
use snakes_core::save::{RunSummary, SavesFolder, load_log, settings_in_words};
use snakes_lab::run::BackgroundTask;

/// Runs of the saves folder, with the description of each one's settings, and each one's readable name.
type RunListing = (Vec<RunSummary>, Vec<String>, Vec<String>);

/// Runs in the saves folder, and those among them that are compared with the current run.
#[derive(Debug, Default)]
pub(crate) struct ComparedRuns {
    listing: Option<BackgroundTask<RunListing>>,
    /// All runs in the saves folder; `None` until they are listed.
    runs: Option<Vec<RunSummary>>,
    /// Description of the settings of each listed run.
    settings: Vec<String>,
    /// Readable name of each listed run.
    names: Vec<String>,
    compared: Vec<ComparedCurve>,
    /// Version number, which every change increments.
    version: u64,
}

/// Learning curve of another run, drawn in the chart of the current run.
#[derive(Debug)]
pub(crate) struct ComparedCurve {
    /// Folder of the other run.
    pub folder: PathBuf,
    reading: Option<BackgroundTask<Result<Other, String>>>,
    /// Contents of the other run or the error of reading it; `None` until it is read.
    pub read: Option<Result<Other, String>>,
}

/// A run that was read from the saves folder.
#[derive(Debug)]
pub(crate) struct Other {
    /// Plan of the run.
    pub plan: RunPlan,
    /// Description of the plan's settings: see [`settings_in_words`].
    pub settings: String,
    /// Records of the finished generations, in order.
    pub records: Vec<GenerationRecord>,
}

/// Maximum number of compared runs. The lines of more runs could not be distinguished.
pub(crate) const MOST_COMPARED: usize = 3;

impl ComparedRuns {
    /// Starts to list all runs.
    pub fn list(&mut self, saves: SavesFolder) -> Result<(), String> {
        let listing = BackgroundTask::start(move || {
            let runs = saves.runs();
            let settings: Vec<String> =
                runs.iter().map(|run| settings_in_words(&run.plan)).collect();
            let named = runs.iter().zip(&settings);
            let mut names: Vec<String> =
                named.map(|(run, settings)| name_of_listed(run, settings)).collect();
            let differences = runs.iter().map(|run| difference(&run.folder, run.name.is_some()));
            tell_apart(names.iter_mut().zip(differences));
            (runs, settings, names)
        });
        self.listing =
            Some(listing.map_err(|error| format!("The runs cannot be listed: {error}"))?);
        Ok(())
    }

    /// Adds a run to the comparison, or removes it if it is there.
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
            Ok(Other { settings: settings_in_words(&plan), plan, records })
        });
        let reading = reading.map_err(|error| format!("The run cannot be read: {error}"))?;
        let folder = folder.to_owned();
        self.compared.push(ComparedCurve { folder, reading: Some(reading), read: None });
        Ok(())
    }

    /// Receives the results of the background tasks: the list of runs, and the runs to compare.
    pub fn take_in(&mut self) {
        if let Some(runs) = self.listing.as_ref().and_then(BackgroundTask::poll) {
            let (runs, settings, names) = runs.unwrap_or_default();
            (self.runs, self.listing) = (Some(runs), None);
            (self.settings, self.names) = (settings, names);
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

    /// Returns all runs in the saves folder, or `None` until they are listed.
    pub fn runs(&self) -> Option<&[RunSummary]> {
        self.runs.as_deref()
    }

    /// Returns the description of the settings of each listed run: see [`settings_in_words`].
    pub fn settings(&self) -> &[String] {
        &self.settings
    }

    /// Returns the readable name of each listed run.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the runs that are compared with the current one.
    pub fn compared(&self) -> &[ComparedCurve] {
        &self.compared
    }

    /// Returns the version number, which every change increments.
    pub fn version(&self) -> u64 {
        self.version
    }
}
