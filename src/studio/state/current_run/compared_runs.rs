//! Other runs of the saves folder, which the charts show beside the current run.

use std::path::{Path, PathBuf};
use std::time::Duration;

use snakes_core::evolve::{GenerationRecord, RunPlan};
use snakes_core::save::{RunSummary, SavesFolder, load_log, saved_at, settings_in_words};
use snakes_lab::run::BackgroundTask;
use snakes_lab::run::names::{difference, name_of_listed, tell_apart};

/// A run of the saves folder.
#[derive(Debug)]
pub(crate) struct ListedRun {
    /// Summary of the run.
    pub run: RunSummary,
    /// Description of the run's settings: see [`settings_in_words`].
    pub settings: String,
    /// Readable name, which no other listed run has.
    pub name: String,
}

/// A run of the saves folder that cannot be read.
#[derive(Debug)]
pub(crate) struct UnreadableRun {
    /// The file that cannot be read, and the reason.
    pub problem: String,
    /// Time of the last change: see [`saved_at`].
    pub saved_at: Duration,
}

/// Runs in the saves folder, and those among them that are compared with the current run.
#[derive(Debug, Default)]
pub(crate) struct ComparedRuns {
    listing: Option<BackgroundTask<(Vec<ListedRun>, Vec<UnreadableRun>)>>,
    /// All runs in the saves folder; `None` until they are listed.
    pub runs: Option<Vec<ListedRun>>,
    /// Runs of the saves folder that cannot be read.
    pub unreadable: Vec<UnreadableRun>,
    /// Runs that are compared with the current one.
    pub compared: Vec<ComparedCurve>,
    /// Version number, which every change increments.
    pub version: u64,
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
            let listed = |run: RunSummary| {
                let settings = settings_in_words(&run.plan);
                ListedRun { name: name_of_listed(&run, &settings), run, settings }
            };
            let (mut runs, mut unreadable) = (Vec::new(), Vec::new());
            for (folder, run) in saves.all_runs() {
                match run {
                    Ok(run) => runs.push(listed(run)),
                    Err(error) => unreadable.push(UnreadableRun {
                        problem: error.to_string(),
                        saved_at: saved_at(&folder),
                    }),
                }
            }
            let names = runs.iter_mut().map(|ListedRun { run, name, .. }| {
                let difference = difference(&run.folder, run.name.is_some());
                (name, difference)
            });
            tell_apart(names);
            (runs, unreadable)
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
            let (plan, records) = load_log(&path)?;
            Ok(Other { settings: settings_in_words(&plan), plan, records })
        });
        let reading = reading.map_err(|error| format!("The run cannot be read: {error}"))?;
        let folder = folder.to_owned();
        self.compared.push(ComparedCurve { folder, reading: Some(reading), read: None });
        Ok(())
    }

    /// Receives the results of the background tasks: the list of runs, and the runs to compare.
    pub fn take_in(&mut self) {
        if let Some(listed) = BackgroundTask::take_result(&mut self.listing) {
            let (runs, unreadable) = listed.unwrap_or_default();
            (self.runs, self.unreadable) = (Some(runs), unreadable);
            self.version += 1;
        }
        for run in &mut self.compared {
            if let Some(read) = BackgroundTask::take_result(&mut run.reading) {
                run.read = Some(read.flatten());
                self.version += 1;
            }
        }
    }
}
