//! The options that the studio is opened with.

use std::path::PathBuf;
use std::sync::Arc;

use bevy::prelude::*;

#[cfg(test)]
use crate::run::LocalPool;
use crate::run::{Evaluator, RunSource};
use crate::save::{Comparison, LoadedChampion, PreferencesFile, SavesFolder};
use crate::studio::ui::theme::Theme;

/// With what the studio opens.
#[derive(Debug, Clone)]
pub struct Options {
    /// The first run.
    pub run: RunSource,
    /// Evaluates the genomes of runs.
    pub evaluator: Arc<dyn Evaluator>,
    /// Where the next runs are saved.
    pub saves: SavesFolder,
    /// The champions to open with, and what they are called; several race. Without one, the shipped one.
    pub champions: Vec<(String, LoadedChampion)>,
    /// A comparison of methods to show.
    pub comparison: Option<Comparison>,
    /// Size of the window, in logical pixels; none: as it was before.
    pub window_size: Option<(u32, u32)>,
    /// The colours to open with; none: as they were before.
    pub theme: Option<Theme>,
    /// Where it is kept what a person has chosen for the window.
    pub preferences: PreferencesFile,
    /// Where to write what the panels show, for scripts and tests.
    pub places: Option<PathBuf>,
    /// After how many frames to close by itself.
    pub exit_after_frames: Option<u32>,
}

#[cfg(test)]
impl Options {
    /// Those of a test: this run, on one thread, and nothing of a person's own.
    pub(crate) fn of_test(run: RunSource, saves: SavesFolder) -> Self {
        Self {
            run,
            evaluator: Arc::new(LocalPool::new(1).expect("threads")),
            saves,
            champions: Vec::new(),
            comparison: None,
            window_size: None,
            theme: None,
            preferences: PreferencesFile::nowhere(),
            places: None,
            exit_after_frames: None,
        }
    }
}

/// The comparison of methods that the studio was opened with.
#[derive(Resource, Debug, Clone, Default)]
pub(crate) struct OpenedComparison(pub Option<Comparison>);
