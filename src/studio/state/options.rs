//! Options of the studio.

use std::path::PathBuf;
use std::sync::Arc;

use bevy::prelude::*;

use crate::studio::ui::theme::Theme;
use snakes_core::save::{LoadedChampion, PreferencesFile, SavesFolder, StudyRuns};
#[cfg(test)]
use snakes_lab::run::LocalPool;
use snakes_lab::run::{Evaluator, RunSource};

/// Options of the studio.
#[derive(Debug, Clone)]
pub struct Options {
    /// The first run.
    pub run: RunSource,
    /// Whether to offer the run that was stopped last; it is not offered to a user who named a run.
    pub offers_stopped_run: bool,
    /// Evaluates the genomes of runs.
    pub evaluator: Arc<dyn Evaluator>,
    /// Where the next runs are saved.
    pub saves: SavesFolder,
    /// Champions to open with, and their names; several race. If empty, the built-in champion.
    pub champions: Vec<(String, LoadedChampion)>,
    /// Problems with the files that the user opened, to show in the window.
    pub problems: Vec<String>,
    /// A study to show.
    pub comparison: Option<StudyRuns>,
    /// Size of the window, in logical pixels; `None`: as last time.
    pub window_size: Option<(u32, u32)>,
    /// Colour theme; `None`: as last time.
    pub theme: Option<Theme>,
    /// Whether the stage is presented on the full screen from the start.
    pub presents: bool,
    /// File of the window preferences.
    pub preferences: PreferencesFile,
    /// File to which the panels' texts and positions are written, for scripts and tests.
    pub places: Option<PathBuf>,
    /// Number of frames after which the window closes.
    pub exit_after_frames: Option<u32>,
}

#[cfg(test)]
impl Options {
    /// Options for tests: this run, on one thread, without preferences.
    pub(crate) fn of_test(run: RunSource, saves: SavesFolder) -> Self {
        Self {
            run,
            offers_stopped_run: false,
            evaluator: Arc::new(LocalPool::new(1).expect("threads")),
            saves,
            champions: Vec::new(),
            problems: Vec::new(),
            comparison: None,
            window_size: None,
            theme: None,
            presents: false,
            preferences: PreferencesFile::nowhere(),
            places: None,
            exit_after_frames: None,
        }
    }
}

/// The study that the studio was opened with.
#[derive(Resource, Debug, Clone, Default)]
pub(crate) struct OpenedComparison(pub Option<StudyRuns>);
