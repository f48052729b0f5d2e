//! Options with which the studio is opened.

use std::path::PathBuf;
use std::sync::Arc;

use bevy::prelude::*;

use crate::studio::ui::theme::Theme;
use snakes_core::save::{LoadedChampion, PreferencesFile, SavesFolder, StudyRuns};
#[cfg(test)]
use snakes_lab::run::LocalPool;
use snakes_lab::run::{Evaluator, RunSource};

/// Options with which the studio is opened.
#[derive(Resource, Debug, Clone)]
pub struct Options {
    /// Run with which the studio opens.
    pub run: RunSource,
    /// Whether to open the latest run, stopped or finished, or to offer it. This is not done if the user named a run.
    pub offers_stopped_run: bool,
    /// Whether the user named the preset, even if it is the default one.
    pub names_preset: bool,
    /// Evaluator of the genomes of runs.
    pub evaluator: Arc<dyn Evaluator>,
    /// Folder in which the next runs are saved.
    pub saves: SavesFolder,
    /// Champions with which the studio opens, and their names; several race. If empty, the built-in champion is shown.
    pub champions: Vec<(String, LoadedChampion)>,
    /// Problems with the files that the user named, to show in the window.
    pub problems: Vec<String>,
    /// Study whose comparison the charts show, if any.
    pub comparison: Option<StudyRuns>,
    /// Size of the window, in logical pixels; `None` for the size of the last time.
    pub window_size: Option<(u32, u32)>,
    /// Theme of the studio; `None` for the theme of the last time.
    pub theme: Option<Theme>,
    /// Whether the studio begins in the presenting mode.
    pub presents: bool,
    /// File that stores the window preferences.
    pub preferences: PreferencesFile,
    /// File to which the panels' texts and positions are written, for scripts and tests.
    pub places: Option<PathBuf>,
    /// Number of frames after which the window closes; `None` if only the user closes it.
    pub exit_after_frames: Option<u32>,
}

#[cfg(test)]
impl Options {
    /// Creates options for tests: this run, on one thread, without preferences.
    pub(crate) fn of_test(run: RunSource, saves: SavesFolder) -> Self {
        Self {
            run,
            offers_stopped_run: false,
            names_preset: false,
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
