//! The library: the entries of the folder of saves, read in the background, and operations on them.
//!
//! Every file operation can be undone. All operations of one command are one undo step.

mod apply;
mod batch_jobs;
mod examination;
mod item;
mod load;
pub mod poll;

use std::path::{Path, PathBuf};

use bevy::prelude::*;

use super::undo::{UndoHistory, UndoStep};
use crate::studio::commands::files::FileQuestion;
use crate::studio::stage::Show;
use snakes_core::check::printable;
use snakes_core::save::SavesFolder;
use snakes_core::save::library::{FileStep, SavePlace};
use snakes_lab::run::{BackgroundTask, LibraryReader};

use batch_jobs::BatchJobs;
use examination::Examination;

pub(crate) use item::LibraryItem;
pub(crate) use load::founder_of;

/// Entries of the saves folder, and the operations that are in progress or can be undone.
#[derive(Resource, Debug, Default)]
pub(crate) struct Library {
    /// Saves folder, in which files can be stored.
    pub saves: SavesFolder,
    /// Thread that reads the saves folder; `None` until the library is first opened.
    reader: Option<LibraryReader>,
    /// Entries of the saves folder, sorted by place.
    pub items: Vec<LibraryItem>,
    /// Whether the entries have been listed.
    pub is_listed: bool,
    /// Number of entries that have not been read yet.
    pub unread: usize,
    /// Reason why the saves folder cannot be read, if there is one.
    pub problem: Option<String>,
    /// Counter that every visible change increments.
    pub revision: u64,
    /// Counter that is incremented when entries are added or removed.
    pub listings: u64,
    /// Counter that is incremented when a sort or search key changes.
    pub sortings: u64,
    /// Whether runs may read alike until they are told apart.
    has_new_names: bool,
    batches: Vec<BatchJobs>,
    examination: Option<Examination>,
    /// Champions that are being read for the stage.
    loading: Option<BackgroundTask<Result<Show, String>>>,
    /// Result of `loading`, until it is shown on the stage.
    loaded: Option<Result<Show, String>>,
    /// Counter of entries to highlight, and the latest of them.
    pub newest: (u64, Option<SavePlace>),
    /// Folder of the run in progress, if any.
    current: Option<PathBuf>,
    /// Whether files are being dragged over the window.
    pub is_drop_near: bool,
    /// Counter of questions that the panel asks because no dialog can be shown, and the latest question with the reason.
    pub unanswered: (u64, Option<(FileQuestion, String)>),
    /// Number of requests so far to export the selected entries.
    pub export_requests: u64,
}

impl Library {
    /// Creates the library of a folder, without reading it.
    pub fn new(saves: SavesFolder) -> Self {
        Self { saves, ..Self::default() }
    }

    /// Returns whether the library has been opened, so that it is kept up to date.
    pub fn is_open(&self) -> bool {
        self.reader.is_some() || self.is_listed
    }

    /// Returns the entry at a place, if there is one.
    pub fn item(&self, place: &SavePlace) -> Option<&LibraryItem> {
        let found = self.items.binary_search_by(|item| item.place().cmp(place));
        found.ok().map(|index| &self.items[index])
    }

    /// Returns the generation of a run's best saved champion, if the run has been read.
    pub fn best_of(&self, place: &SavePlace) -> Option<u32> {
        let run = self.item(place)?.run()?;
        let best = run.best.map(|(generation, _)| generation);
        let there = best.filter(|best| run.champions.binary_search(best).is_ok());
        there.or(run.champions.last().copied())
    }

    /// Returns the displayed name of an entry.
    pub fn name_of(&self, place: &SavePlace) -> String {
        self.item(place).map_or_else(|| place.shown_name(), |item| item.name().to_owned())
    }

    /// Returns whether the place is the folder of the run in progress.
    pub fn is_current(&self, place: &SavePlace) -> bool {
        self.current.is_some() && place.run() == self.current.as_deref()
    }

    /// Makes the panel ask for a path, because no dialog can be shown for `reason`.
    pub fn ask_in_panel(&mut self, question: FileQuestion, reason: String) {
        self.unanswered = (self.unanswered.0 + 1, Some((question, reason)));
    }

    /// Returns the progress of the exam in words, and its finished share from 0 to 1, if an exam is in progress.
    pub fn exam_under_way(&self) -> Option<(String, f32)> {
        self.examination.as_ref().map(Examination::progress)
    }

    fn look_again(&self) {
        if let Some(reader) = &self.reader {
            reader.list_again();
        }
    }

    /// Records completed file operations as one undo step, and highlights their entry.
    fn keep(&mut self, label: String, steps: Vec<FileStep>, history: &mut UndoHistory) {
        self.look_again();
        self.point_out(steps.iter().find_map(FileStep::place));
        if !steps.is_empty() {
            history.push(UndoStep::Files { label, steps });
        }
    }

    fn point_out(&mut self, place: Option<SavePlace>) {
        if place.is_some() {
            self.newest = (self.newest.0 + 1, place);
        }
    }

    /// Creates a library with these entries but without a folder, for tests.
    #[cfg(test)]
    pub fn of(events: Vec<snakes_lab::run::LibraryEvent>) -> Self {
        let mut library = Self::new(SavesFolder::find(Some(Path::new("saves"))));
        events.into_iter().for_each(|event| library.learn(event));
        library
    }

    /// Reads all entries, for tests.
    #[cfg(test)]
    pub fn read_all(&mut self) {
        self.look().expect("a thread");
        let events = self.reader.as_ref().expect("started").wait();
        events.into_iter().for_each(|event| self.learn(event));
    }
}

fn name_of(path: &Path) -> String {
    printable(&path.file_stem().unwrap_or_default().to_string_lossy()).into_owned()
}

#[cfg(test)]
mod tests;
