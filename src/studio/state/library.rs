//! The library in the window: what is in the folder of saves, read beside the window, and what is done with it.
//!
//! Whatever changes files can be undone. Several things that were done at once are undone at once.

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

/// What is in the folder of saves, as far as it is read, and what was done with it.
#[derive(Resource, Debug)]
pub(crate) struct Library {
    saves: SavesFolder,
    /// Nobody reads before somebody has looked.
    reader: Option<LibraryReader>,
    /// In the order of their places.
    items: Vec<LibraryItem>,
    is_listed: bool,
    /// How many entries are not read yet.
    unread: usize,
    /// Why the folder cannot be read.
    problem: Option<String>,
    /// Counts the changes of what there is to be seen.
    revision: u64,
    /// Counts the changes of what there is.
    listings: u64,
    /// Counts the changes of what entries are sorted and found by.
    sortings: u64,
    history: FileHistory,
    /// What was done lately: see [`Self::take_done`].
    done: Vec<String>,
    /// What was left of taking back or doing again: see [`Self::take_left`].
    left: Vec<(UndoDirection, String)>,
    errands: Vec<BatchJobs>,
    /// Who is being read to take the stage.
    loading: Option<BackgroundTask<Result<Show, String>>>,
    /// Who is to take the stage, once read.
    loaded: Option<Result<Show, String>>,
    /// What there is new, to be pointed out, and how often there was.
    newest: (u64, Option<SavePlace>),
    /// The folder of the run that goes on now.
    current: Option<PathBuf>,
    /// Whether files are held over the window.
    is_drop_near: bool,
}

impl FromWorld for Library {
    fn from_world(world: &mut World) -> Self {
        Self::new(world.resource::<RunContext>().saves.clone())
    }
}

impl Library {
    /// That of a folder, which nobody has looked into yet.
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

    /// Whether somebody has looked: from then on it is read.
    pub fn is_open(&self) -> bool {
        self.reader.is_some() || self.is_listed
    }

    /// Whether it is known what there is.
    pub fn is_listed(&self) -> bool {
        self.is_listed
    }

    /// What there is, in the order of places.
    pub fn items(&self) -> &[LibraryItem] {
        &self.items
    }

    /// The entry at a place.
    pub fn item(&self, place: &SavePlace) -> Option<&LibraryItem> {
        let found = self.items.binary_search_by(|item| item.place().cmp(place));
        found.ok().map(|index| &self.items[index])
    }

    /// How many entries are not read yet.
    pub fn unread(&self) -> usize {
        self.unread
    }

    /// Why the folder cannot be read, if it cannot.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Changes whenever there is something else to be seen.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Changes whenever there are other entries: an index of before means another one then.
    pub fn listings(&self) -> u64 {
        self.listings
    }

    /// Changes whenever something that entries are sorted or found by has changed.
    pub fn sortings(&self) -> u64 {
        self.sortings
    }

    /// The generation of a run's best, as far as that has been read.
    pub fn best_of(&self, place: &SavePlace) -> Option<u32> {
        let run = self.item(place)?.run()?;
        let best = run.best.map(|(generation, _)| generation);
        let there = best.filter(|best| run.champions.binary_search(best).is_ok());
        there.or(run.champions.last().copied())
    }

    /// What was made, renamed or brought back last, and how often that has happened.
    pub fn newest(&self) -> (u64, Option<&SavePlace>) {
        (self.newest.0, self.newest.1.as_ref())
    }

    /// Whether it is the folder of the run that goes on now.
    pub fn is_current(&self, place: &SavePlace) -> bool {
        self.current.is_some() && place.run() == self.current.as_deref()
    }

    /// Whether files are held over the window, to be dropped.
    pub fn is_drop_near(&self) -> bool {
        self.is_drop_near
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.saves.path()
    }

    /// How many changes can be undone, and how many done again.
    pub fn counts(&self) -> (usize, usize) {
        self.history.counts()
    }

    /// Forgets what could be done again.
    pub fn forget_undone(&mut self) {
        self.history.forget_undone();
    }

    /// What undoing would undo, in a few words: "deleted climber".
    pub fn undoable(&self) -> Option<&str> {
        self.history.undoable()
    }

    /// What doing again would do, in a few words.
    pub fn redoable(&self) -> Option<&str> {
        self.history.redoable()
    }

    /// Undoes what was done last, or does again what was undone last. Returns what to say of it; nothing, if there is
    /// nothing.
    ///
    /// # Errors
    /// A file cannot be moved, or something else is being done.
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
        let verb = if way == UndoDirection::Back { "Undone" } else { "Done again" };
        let Some(change) = result? else { return Ok(None) };
        let elsewhere = change.steps.iter().filter_map(|step| match step {
            FileStep::Restored { wanted, to } if wanted != to => {
                let [wanted, to] = [wanted, to].map(|path| name_of(path));
                Some(format!(" The name {wanted} is taken by now: it is called {to}."))
            }
            _ => None,
        });
        let mut elsewhere: Vec<String> = elsewhere.collect();
        if elsewhere.len() > MOST_AT_ONCE {
            let count = elsewhere.len();
            elsewhere =
                vec![format!(" {count} names are taken by now: those have a number added.")];
        }
        let elsewhere = elsewhere.concat();
        self.point_out(change.steps.iter().find_map(FileStep::place));
        Ok(Some(format!("{verb}: {}.{elsewhere}", change.words)))
    }

    fn look_again(&self) {
        if let Some(reader) = &self.reader {
            reader.list_again();
        }
    }

    /// Keeps what was done, to be undone.
    fn keep(&mut self, change: LibraryChange) {
        self.look_again();
        self.point_out(change.steps.iter().find_map(FileStep::place));
        if !change.steps.is_empty() {
            self.done.push(change.words.clone());
        }
        self.history.keep(change);
    }

    /// What was done since this was asked last, in a few words each, to be undone in its order with everything else.
    pub fn take_done(&mut self) -> Vec<String> {
        std::mem::take(&mut self.done)
    }

    /// What could not be taken back, or not be done again, as a whole since this was asked last, in a few words each:
    /// the rest of it can be tried again.
    pub fn take_left(&mut self) -> Vec<(UndoDirection, String)> {
        std::mem::take(&mut self.left)
    }

    fn point_out(&mut self, place: Option<SavePlace>) {
        if place.is_some() {
            self.newest = (self.newest.0 + 1, place);
        }
    }

    /// That of entries that were read without a folder, for tests.
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

    /// The names of what is in the folder.
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
    fn what_is_deleted_at_once_comes_back_at_once_and_goes_again() {
        let (_folder, mut library) = library(&["a", "b", "c"]);
        let places = vec![place(&library, "a"), place(&library, "c")];
        let mut notices = Notices::default();
        library.apply(&LibraryCommand::Delete(places), &mut notices).expect("deleted");
        assert_eq!(notices.len(), 1);
        assert_eq!(own(&mut library), ["b"]);
        assert_eq!(library.undoable(), Some("deleted 2 saves"));
        let said = library.step(UndoDirection::Back).expect("undone").expect("something");
        assert_eq!(said, "Undone: deleted 2 saves.");
        assert_eq!(own(&mut library), ["a", "b", "c"]);
        assert_eq!((library.undoable(), library.redoable()), (None, Some("deleted 2 saves")));
        library.step(UndoDirection::Forth).expect("redone");
        assert_eq!(own(&mut library), ["b"]);
        assert_eq!(library.step(UndoDirection::Forth), Ok(None));
    }

    #[test]
    fn who_comes_back_under_another_name_says_so() {
        let (folder, mut library) = library(&["a"]);
        let a = place(&library, "a");
        library.apply(&LibraryCommand::Delete(vec![a]), &mut Notices::default()).expect("deleted");
        std::fs::write(folder.path().join("a.ron"), "another").expect("written");
        let said = library.step(UndoDirection::Back).expect("undone").expect("something");
        assert_eq!(said, "Undone: deleted a. The name a is taken by now: it is called a 2.");
        let (count, newest) = library.newest();
        assert_eq!((count, newest.map(SavePlace::name)), (1, Some("a 2".to_owned())));
    }

    #[test]
    fn a_refused_name_changes_nothing_and_the_next_change_forgets_what_was_undone() {
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
    fn a_copy_that_takes_its_time_is_taken_in_when_it_is_done() {
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
