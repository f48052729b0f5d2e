//! The studio's view of the saves folder: its entries, read in a background thread, and the operations on them.
//!
//! Every change of files can be undone; a batch is undone as a whole.

mod apply;
mod batch_jobs;
mod file_changes;
mod item;
mod load;
mod poll;
mod words;

use std::path::{Path, PathBuf};

use bevy::prelude::*;

use super::run_context::RunContext;
use super::undo::UndoDirection;
use crate::run::{BackgroundTask, LibraryReader};
use crate::save::SavesFolder;
use crate::save::library::{FileStep, SavePlace};
use crate::studio::stage::Show;

use batch_jobs::{BatchJobs, MOST_AT_ONCE};
use file_changes::{FileHistory, LibraryChange};

pub(crate) use item::{LibraryItem, fitness_text};
pub(crate) use load::found_run;
pub(crate) use poll::plugin;

/// Entries of the saves folder, and the operations that are under way or can be undone.
#[derive(Resource, Debug)]
pub(crate) struct Library {
    saves: SavesFolder,
    /// `None` until the library is first opened.
    reader: Option<LibraryReader>,
    /// Sorted by place.
    items: Vec<LibraryItem>,
    is_listed: bool,
    /// Number of entries not read yet.
    unread: usize,
    /// Reason why the folder cannot be read.
    problem: Option<String>,
    /// Incremented with every visible change.
    revision: u64,
    /// Incremented when entries are added or removed.
    listings: u64,
    /// Incremented when a sort or search key changes.
    sortings: u64,
    history: FileHistory,
    /// Labels for [`Self::take_done`].
    done: Vec<String>,
    /// Labels for [`Self::take_left`].
    left: Vec<(UndoDirection, String)>,
    errands: Vec<BatchJobs>,
    /// Champions being read for the stage.
    loading: Option<BackgroundTask<Result<Show, String>>>,
    /// Result of `loading`, until it is shown.
    loaded: Option<Result<Show, String>>,
    /// Entry to highlight, and a counter of such entries.
    newest: (u64, Option<SavePlace>),
    /// Folder of the run in progress.
    current: Option<PathBuf>,
    /// Whether files are being dragged over the window.
    is_drop_near: bool,
}

impl FromWorld for Library {
    fn from_world(world: &mut World) -> Self {
        Self::new(world.resource::<RunContext>().saves.clone())
    }
}

impl Library {
    /// The library of a folder; nothing is read yet.
    pub fn new(saves: SavesFolder) -> Self {
        Self {
            saves,
            reader: None,
            items: Vec::new(),
            is_listed: false,
            unread: 0,
            problem: None,
            revision: 0,
            listings: 0,
            sortings: 0,
            history: FileHistory::default(),
            done: Vec::new(),
            left: Vec::new(),
            errands: Vec::new(),
            loading: None,
            loaded: None,
            newest: (0, None),
            current: None,
            is_drop_near: false,
        }
    }

    /// Whether the library was opened; from then on it is read.
    pub fn is_open(&self) -> bool {
        self.reader.is_some() || self.is_listed
    }

    /// Whether the entries are listed.
    pub fn is_listed(&self) -> bool {
        self.is_listed
    }

    /// The entries, sorted by place.
    pub fn items(&self) -> &[LibraryItem] {
        &self.items
    }

    /// The entry at a place.
    pub fn item(&self, place: &SavePlace) -> Option<&LibraryItem> {
        let found = self.items.binary_search_by(|item| item.place().cmp(place));
        found.ok().map(|index| &self.items[index])
    }

    /// Number of entries not read yet.
    pub fn unread(&self) -> usize {
        self.unread
    }

    /// Why the folder cannot be read, if it cannot.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Changes with every visible change.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Changes when entries are added or removed, which invalidates indices.
    pub fn listings(&self) -> u64 {
        self.listings
    }

    /// Changes when a sort or search key of an entry changes.
    pub fn sortings(&self) -> u64 {
        self.sortings
    }

    /// The generation of a run's best champion, if it has been read.
    pub fn best_of(&self, place: &SavePlace) -> Option<u32> {
        let run = self.item(place)?.run()?;
        let best = run.best.map(|(generation, _)| generation);
        let there = best.filter(|best| run.champions.binary_search(best).is_ok());
        there.or(run.champions.last().copied())
    }

    /// The entry created, renamed or restored last, and a counter of such changes.
    pub fn newest(&self) -> (u64, Option<&SavePlace>) {
        (self.newest.0, self.newest.1.as_ref())
    }

    /// Whether it is the folder of the run in progress.
    pub fn is_current(&self, place: &SavePlace) -> bool {
        self.current.is_some() && place.run() == self.current.as_deref()
    }

    /// Whether files are being dragged over the window.
    pub fn is_drop_near(&self) -> bool {
        self.is_drop_near
    }

    /// The saves folder.
    pub fn folder(&self) -> &Path {
        self.saves.path()
    }

    /// Numbers of changes that can be undone and redone.
    pub fn counts(&self) -> (usize, usize) {
        self.history.counts()
    }

    /// Clears the redo stack.
    pub fn forget_undone(&mut self) {
        self.history.forget_undone();
    }

    /// Label of the next change to undo: "deleted climber".
    pub fn undoable(&self) -> Option<&str> {
        self.history.undoable()
    }

    /// Label of the next change to redo.
    pub fn redoable(&self) -> Option<&str> {
        self.history.redoable()
    }

    /// Undoes the last change or redoes the last undone one. Returns the message to show; `None` if there is no such
    /// change.
    ///
    /// # Errors
    /// A file cannot be moved, or another operation is in progress.
    pub fn step(&mut self, way: UndoDirection) -> Result<Option<String>, String> {
        self.refuse_while_busy()?;
        if self.history.steps(way) > MOST_AT_ONCE {
            return self.send_out_undo(way);
        }
        let stepped = self.history.step(way, &self.saves);
        self.after_undoing(stepped, way)
    }

    fn after_undoing(
        &mut self,
        result: Result<Option<LibraryChange>, String>,
        way: UndoDirection,
    ) -> Result<Option<String>, String> {
        self.look_again();
        let Some(change) = result? else { return Ok(None) };
        let done = undone_in_words(way, &change);
        let elsewhere = change.steps.iter().filter_map(|step| match step {
            FileStep::Restored { wanted, to } if wanted != to => {
                let [wanted, to] = [wanted, to].map(|path| name_of(path));
                Some(format!(" The name {wanted} was taken, so the new name is {to}."))
            }
            _ => None,
        });
        let mut elsewhere: Vec<String> = elsewhere.collect();
        if elsewhere.len() > MOST_AT_ONCE {
            let count = elsewhere.len();
            elsewhere = vec![format!(" {count} names were taken, so a number was added to them.")];
        }
        let elsewhere = elsewhere.concat();
        self.point_out(change.steps.iter().find_map(FileStep::place));
        Ok(Some(format!("{done}.{elsewhere}")))
    }

    fn look_again(&self) {
        if let Some(reader) = &self.reader {
            reader.list_again();
        }
    }

    /// Records a change for undo.
    fn keep(&mut self, change: LibraryChange) {
        self.look_again();
        self.point_out(change.steps.iter().find_map(FileStep::place));
        if !change.steps.is_empty() {
            self.done.push(change.words.clone());
        }
        self.history.keep(change);
    }

    /// Labels of the changes since the last call, for the common undo history.
    pub fn take_done(&mut self) -> Vec<String> {
        std::mem::take(&mut self.done)
    }

    /// Labels of the undo or redo steps since the last call that were only partly carried out. The rest can be tried
    /// again.
    pub fn take_left(&mut self) -> Vec<(UndoDirection, String)> {
        std::mem::take(&mut self.left)
    }

    fn point_out(&mut self, place: Option<SavePlace>) {
        if place.is_some() {
            self.newest = (self.newest.0 + 1, place);
        }
    }

    /// A library of these entries without a folder, for tests.
    #[cfg(test)]
    pub fn of(events: Vec<crate::run::LibraryEvent>) -> Self {
        let mut library = Self::new(SavesFolder::find(Some(Path::new("saves"))));
        events.into_iter().for_each(|event| library.learn(event));
        library
    }

    /// Reads everything, for tests.
    #[cfg(test)]
    pub fn read_all(&mut self) {
        self.look().expect("a thread");
        let events = self.reader.as_ref().expect("started").wait();
        events.into_iter().for_each(|event| self.learn(event));
    }
}

/// Message after an undo or redo of a change.
fn undone_in_words(way: UndoDirection, change: &LibraryChange) -> String {
    let restored = change.steps.iter().map(|step| match step {
        FileStep::Restored { wanted, .. } => Some(name_of(wanted)),
        _ => None,
    });
    match (way, restored.collect::<Option<Vec<String>>>()) {
        (UndoDirection::Back, Some(names)) if !names.is_empty() => {
            format!("{} restored", words::listed(&names))
        }
        (UndoDirection::Back, _) => format!("Undone: {}", change.words),
        (UndoDirection::Forth, _) => format!("Redone: {}", change.words),
    }
}

fn name_of(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::{shipped_champion, store_champion};
    use crate::studio::commands::library::LibraryCommand;
    use crate::studio::ui::notifications::Notices;
    use tempfile::TempDir;

    pub fn library(names: &[&str]) -> (TempDir, Library) {
        let folder = tempfile::tempdir().expect("a folder");
        let loaded = shipped_champion().expect("well formed");
        for name in names {
            let path = folder.path().join(format!("{name}.ron"));
            store_champion(&path, &loaded.champion, None).expect("written");
        }
        let mut library = Library::new(SavesFolder::find(Some(folder.path())));
        library.read_all();
        (folder, library)
    }

    /// Names of the entries in the folder.
    pub fn own(library: &mut Library) -> Vec<String> {
        library.read_all();
        let own = library.items().iter().filter(|item| item.place().path().is_some());
        own.map(|item| item.name().to_owned()).collect()
    }

    pub fn place(library: &Library, name: &str) -> SavePlace {
        let item = library.items().iter().find(|item| item.name() == name);
        item.expect("listed").place().clone()
    }

    #[test]
    fn a_batch_that_is_deleted_is_restored_and_deleted_again_as_a_whole() {
        let (_folder, mut library) = library(&["a", "b", "c"]);
        let places = vec![place(&library, "a"), place(&library, "c")];
        let mut notices = Notices::default();
        library.apply(&LibraryCommand::Delete(places), &mut notices).expect("deleted");
        assert_eq!(notices.len(), 1);
        assert_eq!(own(&mut library), ["b"]);
        assert_eq!(library.undoable(), Some("deleted 2 saves"));
        let said = library.step(UndoDirection::Back).expect("undone").expect("something");
        assert_eq!(said, "2 saves restored.");
        assert_eq!(own(&mut library), ["a", "b", "c"]);
        assert_eq!((library.undoable(), library.redoable()), (None, Some("deleted 2 saves")));
        library.step(UndoDirection::Forth).expect("redone");
        assert_eq!(own(&mut library), ["b"]);
        assert_eq!(library.step(UndoDirection::Forth), Ok(None));
    }

    #[test]
    fn a_restore_under_another_name_is_reported() {
        let (folder, mut library) = library(&["a"]);
        let a = place(&library, "a");
        library.apply(&LibraryCommand::Delete(vec![a]), &mut Notices::default()).expect("deleted");
        std::fs::write(folder.path().join("a.ron"), "another").expect("written");
        let said = library.step(UndoDirection::Back).expect("undone").expect("something");
        assert_eq!(said, "a restored. The name a was taken, so the new name is a 2.");
        let (count, newest) = library.newest();
        assert_eq!((count, newest.map(SavePlace::name)), (1, Some("a 2".to_owned())));
    }

    #[test]
    fn a_refused_name_changes_nothing_and_a_new_change_clears_the_redo_stack() {
        let (_folder, mut library) = library(&["a", "b"]);
        let mut notices = Notices::default();
        let mut named = |library: &mut Library, from: &str, to: &str| {
            let request =
                LibraryCommand::Rename { place: place(library, from), name: to.to_owned() };
            library.apply(&request, &mut notices).map(|_| ())
        };
        let refusal = named(&mut library, "a", "b").expect_err("taken");
        assert!(refusal.contains("not taken yet"), "{refusal}");
        assert_eq!(library.undoable(), None);
        named(&mut library, "a", "c").expect("free");
        assert_eq!(own(&mut library), ["b", "c"]);
        library.step(UndoDirection::Back).expect("undone");
        own(&mut library);
        named(&mut library, "b", "d").expect("free");
        assert_eq!(library.redoable(), None);
    }

    #[test]
    fn a_copy_appears_when_it_is_finished() {
        let (folder, mut library) = library(&["a"]);
        let mut notices = Notices::default();
        let export = LibraryCommand::Export { places: vec![place(&library, "a")], to: None };
        library.apply(&export, &mut notices).expect("begun");
        while !library.errands.is_empty() {
            library.take_in(&mut notices);
        }
        let copy = folder.path().join("exports/a.ron");
        assert!(copy.exists());
        library.apply(&LibraryCommand::Import(vec![copy]), &mut notices).expect("begun");
        while !library.errands.is_empty() {
            library.take_in(&mut notices);
        }
        assert_eq!(own(&mut library), ["a 2", "a"]);
        assert_eq!(library.undoable(), Some("imported a 2"));
        assert_eq!(notices.len(), 2);
    }
}
