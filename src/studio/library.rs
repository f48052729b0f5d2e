//! The library in the window: what is in the folder of saves, read beside the window, and what is done with it.
//!
//! Whatever changes files can be undone. Several things that were done at once are undone at once.

mod cast;
mod history;
mod item;
mod take_in;

use std::path::{Path, PathBuf};

use bevy::prelude::*;

use super::casting::evenly_chosen;
use super::engine::Engine;
use super::notice::Notices;
use super::stage::{MOST_LANES, Show};
use crate::run::{Errand, Librarian};
use crate::save::library::{Place, Step, delete, duplicate, export, import, rename};
use crate::save::{SaveError, SavesFolder};

pub(super) use cast::found_run;
use cast::{exhibit_of, generation_of};
use history::{Change, History};
pub(super) use item::{Item, fitness_text};
pub(super) use take_in::plugin;

/// Something a person asks of the library.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Ask {
    /// Begin to read the folder, or look at it again.
    Look,
    /// Read these first: they are in sight.
    Hurry(Vec<Place>),
    /// Put the champion of an entry on the stage; of a run its best.
    Replay(Place),
    /// Let the champions of entries race.
    Race(Vec<Place>),
    /// Put the champion of a run's generation on the stage; the first is 1.
    ReplayGeneration {
        /// The run's folder.
        run: PathBuf,
        /// The first is 1.
        generation: u32,
    },
    /// Let the champions of these generations of a run race; of many, some at equal distances.
    RaceGenerations {
        /// The run's folder.
        run: PathBuf,
        /// The generations that have one.
        generations: Vec<u32>,
    },
    /// Begin a run of which the champion of an entry is a parent.
    FoundRun(Place),
    /// Give a champion another name.
    Rename {
        /// Which.
        place: Place,
        /// How it is to be called.
        name: String,
    },
    /// Copy champions beside themselves.
    Duplicate(Vec<Place>),
    /// Put entries away, from where undoing brings them back.
    Delete(Vec<Place>),
    /// Copy entries out.
    Export {
        /// Which.
        places: Vec<Place>,
        /// To which folder, or for one champion to which file; without it, to the usual folder.
        to: Option<PathBuf>,
    },
    /// Copy champions or runs in.
    Import(Vec<PathBuf>),
    /// Undo what was done last.
    Undo,
    /// Do again what was undone last.
    Redo,
}

/// What is in the folder of saves, as far as it is read, and what was done with it.
#[derive(Resource, Debug)]
pub(super) struct Library {
    saves: SavesFolder,
    /// Nobody reads before somebody has looked.
    librarian: Option<Librarian>,
    /// In the order of their places.
    items: Vec<Item>,
    is_listed: bool,
    /// How many entries are not read yet.
    unread: usize,
    /// Why the folder cannot be read.
    problem: Option<String>,
    /// Counts the changes of what there is to be seen.
    revision: u64,
    /// Counts the changes of what there is.
    listings: u64,
    history: History,
    /// What was done lately: see [`Self::take_done`].
    done: Vec<String>,
    errands: Vec<Outstanding>,
    /// What there is new, to be pointed out, and how often there was.
    newest: (u64, Option<Place>),
    /// The folder of the run that goes on now.
    current: Option<PathBuf>,
    /// Whether files are held over the window.
    is_drop_near: bool,
}

/// Copies that are under way.
#[derive(Debug)]
struct Outstanding {
    verb: &'static str,
    errand: Errand<Vec<Result<Step, SaveError>>>,
}

impl FromWorld for Library {
    fn from_world(world: &mut World) -> Self {
        Self::new(world.resource::<Engine>().saves.clone())
    }
}

impl Library {
    /// That of a folder, which nobody has looked into yet.
    pub fn new(saves: SavesFolder) -> Self {
        Self {
            saves,
            librarian: None,
            items: Vec::new(),
            is_listed: false,
            unread: 0,
            problem: None,
            revision: 0,
            listings: 0,
            history: History::default(),
            done: Vec::new(),
            errands: Vec::new(),
            newest: (0, None),
            current: None,
            is_drop_near: false,
        }
    }

    /// Whether somebody has looked: from then on it is read.
    pub fn is_open(&self) -> bool {
        self.librarian.is_some() || self.is_listed
    }

    /// Whether it is known what there is.
    pub fn is_listed(&self) -> bool {
        self.is_listed
    }

    /// What there is, in the order of places.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// The entry at a place.
    pub fn item(&self, place: &Place) -> Option<&Item> {
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

    /// What was made, renamed or brought back last, and how often that has happened.
    pub fn newest(&self) -> (u64, Option<&Place>) {
        (self.newest.0, self.newest.1.as_ref())
    }

    /// Whether it is the folder of the run that goes on now.
    pub fn is_current(&self, place: &Place) -> bool {
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
    pub fn steps(&self) -> (usize, usize) {
        self.history.steps()
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

    /// Undoes what was done last. Returns what to say of it; nothing, if there is nothing to undo.
    ///
    /// # Errors
    /// A file cannot be moved back.
    pub fn undo(&mut self) -> Result<Option<String>, String> {
        let undone = self.history.undo(&self.saves);
        self.after_undoing(undone, "Undone")
    }

    /// Does again what was undone last. Returns what to say of it; nothing, if there is nothing.
    ///
    /// # Errors
    /// A file cannot be moved.
    pub fn redo(&mut self) -> Result<Option<String>, String> {
        let redone = self.history.redo(&self.saves);
        self.after_undoing(redone, "Done again")
    }

    fn after_undoing(
        &mut self,
        result: Result<Option<Change>, String>,
        verb: &str,
    ) -> Result<Option<String>, String> {
        self.look_again();
        let Some(change) = result? else { return Ok(None) };
        let elsewhere = change.steps.iter().filter_map(|step| match step {
            Step::Restored { wanted, to } if wanted != to => {
                let [wanted, to] = [wanted, to].map(|path| name_of(path));
                Some(format!(" The name {wanted} is taken by now: it is called {to}."))
            }
            _ => None,
        });
        let elsewhere: String = elsewhere.collect();
        self.point_out(change.steps.iter().find_map(Step::place));
        Ok(Some(format!("{verb}: {}.{elsewhere}", change.words)))
    }

    /// Does what a person asks for, and says who is to take the stage.
    ///
    /// # Errors
    /// What cannot be done, and why.
    pub fn apply(&mut self, ask: &Ask, notices: &mut Notices) -> Result<Option<Show>, String> {
        match ask {
            Ask::Look => self.look()?,
            Ask::Hurry(places) => {
                if let Some(librarian) = &self.librarian {
                    librarian.hurry(places.clone());
                }
            }
            Ask::Replay(place) => return exhibit_of(place).map(Show::solo).map(Some),
            Ask::Race(places) => {
                let exhibits = places.iter().take(MOST_LANES).map(exhibit_of);
                return Ok(Some(Show::race(exhibits.collect::<Result<_, _>>()?)));
            }
            Ask::ReplayGeneration { run, generation } => {
                return generation_of(run, *generation).map(Show::solo).map(Some);
            }
            Ask::RaceGenerations { run, generations } => {
                let chosen = evenly_chosen(generations.len()).map(|index| generations[index]);
                let exhibits = chosen.map(|generation| generation_of(run, generation));
                return Ok(Some(Show::race(exhibits.collect::<Result<_, _>>()?)));
            }
            // It needs the evolution: see [`found_run`].
            Ask::FoundRun(_) => {}
            Ask::Rename { place, name } => {
                let step = rename(place, name.trim()).map_err(|error| error.to_string())?;
                self.keep(Change { words: format!("renamed {}", place.name()), steps: vec![step] });
            }
            Ask::Duplicate(places) => {
                self.each("duplicated", places, duplicate)?;
            }
            Ask::Delete(places) => {
                let words = self.each("deleted", places, delete)?;
                notices.news(format!("{}. Ctrl Z brings it back", capital(&words)));
            }
            Ask::Export { places, to } => {
                let (saves, places, to) = (self.saves.clone(), places.clone(), to.clone());
                self.send_out("exported", move || {
                    places.iter().map(|place| export(&saves, place, to.as_deref())).collect()
                })?;
            }
            Ask::Import(paths) => {
                // What is dropped into a window nobody has looked into is to be seen too.
                self.look()?;
                let (saves, paths) = (self.saves.clone(), paths.clone());
                self.send_out("imported", move || {
                    paths.iter().map(|path| import(&saves, path)).collect()
                })?;
            }
            Ask::Undo => notices.news(self.undo()?.unwrap_or("There is nothing to undo".into())),
            Ask::Redo => {
                notices.news(self.redo()?.unwrap_or("There is nothing to do again".into()));
            }
        }
        Ok(None)
    }

    fn look(&mut self) -> Result<(), String> {
        match &self.librarian {
            Some(librarian) => librarian.look_again(),
            None => {
                let librarian = Librarian::start(self.saves.clone());
                let librarian =
                    librarian.map_err(|error| format!("The saves cannot be read: {error}"))?;
                self.librarian = Some(librarian);
            }
        }
        Ok(())
    }

    fn look_again(&self) {
        if let Some(librarian) = &self.librarian {
            librarian.look_again();
        }
    }

    /// Does something with each of several entries. What was done before one fails is kept, and can be undone.
    fn each(
        &mut self,
        verb: &str,
        places: &[Place],
        act: impl Fn(&SavesFolder, &Place) -> Result<Step, SaveError>,
    ) -> Result<String, String> {
        let mut steps = Vec::new();
        let mut done = Vec::new();
        let mut problem = None;
        for place in places {
            match act(&self.saves, place) {
                Ok(step) => {
                    steps.push(step);
                    done.push(place.name());
                }
                Err(error) => {
                    problem = Some(error.to_string());
                    break;
                }
            }
        }
        let words = format!("{verb} {}", listed(&done));
        self.keep(Change { words: words.clone(), steps });
        problem.map_or(Ok(words), Err)
    }

    /// Keeps what was done, to be undone.
    fn keep(&mut self, change: Change) {
        self.look_again();
        self.point_out(change.steps.iter().find_map(Step::place));
        if !change.steps.is_empty() {
            self.done.push(change.words.clone());
        }
        self.history.keep(change);
    }

    /// What was done since this was asked last, in a few words each, to be undone in its order with everything else.
    pub fn take_done(&mut self) -> Vec<String> {
        std::mem::take(&mut self.done)
    }

    fn point_out(&mut self, place: Option<Place>) {
        if place.is_some() {
            self.newest = (self.newest.0 + 1, place);
        }
    }

    /// Begins something that may take its time.
    fn send_out(
        &mut self,
        verb: &'static str,
        work: impl FnOnce() -> Vec<Result<Step, SaveError>> + Send + 'static,
    ) -> Result<(), String> {
        let errand = Errand::start(work).map_err(|error| format!("Nothing was {verb}: {error}"))?;
        self.errands.push(Outstanding { verb, errand });
        Ok(())
    }

    /// That of entries that were read without a folder, for tests.
    #[cfg(test)]
    pub fn of(readings: Vec<crate::run::Reading>) -> Self {
        let mut library = Self::new(SavesFolder::find(Some(Path::new("saves"))));
        readings.into_iter().for_each(|reading| library.learn(reading));
        library
    }

    /// Reads everything, for tests.
    #[cfg(test)]
    pub fn read_all(&mut self) {
        self.look().expect("a thread");
        let readings = self.librarian.as_ref().expect("started").wait();
        readings.into_iter().for_each(|reading| self.learn(reading));
    }
}

fn name_of(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Names in a few words: one by itself, several counted.
fn listed(names: &[String]) -> String {
    match names {
        [one] => one.clone(),
        several => format!("{} saves", several.len()),
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::{shipped_champion, store_champion};
    use crate::studio::exhibit::Exhibit;
    use tempfile::TempDir;

    fn library(names: &[&str]) -> (TempDir, Library) {
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
    fn own(library: &mut Library) -> Vec<String> {
        library.read_all();
        let own = library.items().iter().filter(|item| item.place().path().is_some());
        own.map(|item| item.name().to_owned()).collect()
    }

    fn place(library: &Library, name: &str) -> Place {
        let item = library.items().iter().find(|item| item.name() == name);
        item.expect("listed").place().clone()
    }

    #[test]
    fn what_is_deleted_at_once_comes_back_at_once_and_goes_again() {
        let (_folder, mut library) = library(&["a", "b", "c"]);
        let places = vec![place(&library, "a"), place(&library, "c")];
        let mut notices = Notices::default();
        library.apply(&Ask::Delete(places), &mut notices).expect("deleted");
        assert_eq!(notices.len(), 1);
        assert_eq!(own(&mut library), ["b"]);
        assert_eq!(library.undoable(), Some("deleted 2 saves"));
        let said = library.undo().expect("undone").expect("something");
        assert_eq!(said, "Undone: deleted 2 saves.");
        assert_eq!(own(&mut library), ["a", "b", "c"]);
        assert_eq!((library.undoable(), library.redoable()), (None, Some("deleted 2 saves")));
        library.redo().expect("redone");
        assert_eq!(own(&mut library), ["b"]);
        assert_eq!(library.redo(), Ok(None));
    }

    #[test]
    fn who_comes_back_under_another_name_says_so() {
        let (folder, mut library) = library(&["a"]);
        let a = place(&library, "a");
        library.apply(&Ask::Delete(vec![a]), &mut Notices::default()).expect("deleted");
        std::fs::write(folder.path().join("a.ron"), "another").expect("written");
        let said = library.undo().expect("undone").expect("something");
        assert_eq!(said, "Undone: deleted a. The name a is taken by now: it is called a 2.");
        let (count, newest) = library.newest();
        assert_eq!((count, newest.map(Place::name)), (1, Some("a 2".to_owned())));
    }

    #[test]
    fn a_refused_name_changes_nothing_and_the_next_change_forgets_what_was_undone() {
        let (_folder, mut library) = library(&["a", "b"]);
        let mut notices = Notices::default();
        let mut named = |library: &mut Library, from: &str, to: &str| {
            let ask = Ask::Rename { place: place(library, from), name: to.to_owned() };
            library.apply(&ask, &mut notices).map(|_| ())
        };
        let refusal = named(&mut library, "a", "b").expect_err("taken");
        assert!(refusal.contains("not taken yet"), "{refusal}");
        assert_eq!(library.undoable(), None);
        named(&mut library, "a", "c").expect("free");
        assert_eq!(own(&mut library), ["b", "c"]);
        library.undo().expect("undone");
        own(&mut library);
        named(&mut library, "b", "d").expect("free");
        assert_eq!(library.redoable(), None);
    }

    #[test]
    fn a_copy_that_takes_its_time_is_taken_in_when_it_is_done() {
        let (folder, mut library) = library(&["a"]);
        let mut notices = Notices::default();
        let export = Ask::Export { places: vec![place(&library, "a")], to: None };
        library.apply(&export, &mut notices).expect("begun");
        while !library.errands.is_empty() {
            library.take_in(&mut notices);
        }
        let copy = folder.path().join("exports/a.ron");
        assert!(copy.exists());
        library.apply(&Ask::Import(vec![copy]), &mut notices).expect("begun");
        while !library.errands.is_empty() {
            library.take_in(&mut notices);
        }
        assert_eq!(own(&mut library), ["a 2", "a"]);
        assert_eq!(library.undoable(), Some("imported a 2"));
        assert_eq!(notices.len(), 2);
    }

    #[test]
    fn those_who_are_chosen_take_the_stage_under_their_names() {
        let (_folder, mut library) = library(&["mine"]);
        let race = Ask::Race(vec![place(&library, "mine"), Place::Shipped("fast")]);
        let show = library.apply(&race, &mut Notices::default()).expect("read").expect("shown");
        let names: Vec<&str> = show.exhibits.iter().map(Exhibit::name).collect();
        assert_eq!(names, ["mine", "fast"]);
        assert_ne!(show.exhibits[0].source(), show.exhibits[1].source());
    }
}
