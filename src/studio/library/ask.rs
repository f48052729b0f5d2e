//! What a person can ask of the library, and how it is done.

use std::path::PathBuf;

use super::Library;
use super::cast::{exhibit_of, generation_of};
use super::history::Change;
use super::under_way::{
    DELETED, DUPLICATED, EXPORTED, IMPORTED, MOST_AT_ONCE, Outcome, Task, Verb,
};
use crate::run::{Errand, Librarian};
use crate::save::library::{Place, Step, delete, duplicate, export, import, rename};
use crate::save::{SaveError, SavesFolder};
use crate::studio::casting::evenly_chosen;
use crate::studio::notice::Notices;
use crate::studio::stage::{MOST_LANES, Show};

/// Something a person asks of the library.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::studio) enum Ask {
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
    /// End what is being done with many after the file that it is about.
    Cancel,
    /// Put on the stage what was read for it meanwhile.
    Present,
}

impl Library {
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
            Ask::Replay(place) => {
                let (place, best) = (place.clone(), self.best_of(place));
                let is_quick = place.run().is_none() || best.is_some();
                return self.load(is_quick, move || exhibit_of(&place, best).map(Show::solo));
            }
            Ask::Race(places) => {
                let places = places.iter().take(MOST_LANES);
                let racers: Vec<(Place, Option<u32>)> =
                    places.map(|place| (place.clone(), self.best_of(place))).collect();
                let is_quick =
                    racers.iter().all(|(place, best)| place.run().is_none() || best.is_some());
                return self.load(is_quick, move || {
                    let exhibits = racers.iter().map(|(place, best)| exhibit_of(place, *best));
                    Ok(Show::race(exhibits.collect::<Result<_, _>>()?))
                });
            }
            Ask::Present => return self.loaded.take().transpose(),
            Ask::ReplayGeneration { run, generation } => {
                let (run, generation) = (run.clone(), *generation);
                return self.load(true, move || generation_of(&run, generation).map(Show::solo));
            }
            Ask::RaceGenerations { run, generations } => {
                let chosen = evenly_chosen(generations.len()).map(|index| generations[index]);
                let exhibits = chosen.map(|generation| generation_of(run, generation));
                return Ok(Some(Show::race(exhibits.collect::<Result<_, _>>()?)));
            }
            // It needs the evolution: see [`super::found_run`].
            Ask::FoundRun(_) => {}
            // The settings' steps lie between: see [`Self::step`].
            Ask::Undo | Ask::Redo => {}
            Ask::Rename { place, name } => {
                self.refuse_while_busy()?;
                let step = rename(place, name.trim()).map_err(|error| error.to_string())?;
                self.keep(Change { words: format!("renamed {}", place.name()), steps: vec![step] });
            }
            Ask::Duplicate(places) => {
                self.each(DUPLICATED, places, duplicate)?;
            }
            Ask::Delete(places) => {
                if let Some(words) = self.each(DELETED, places, delete)? {
                    notices.news(format!("{}. Ctrl Z brings it back", capital(&words)));
                }
            }
            Ask::Export { places, to } => {
                self.refuse_while_busy()?;
                let (saves, to) = (self.saves.clone(), to.clone());
                let act = move |place: Place| export(&saves, &place, to.as_deref()).into();
                self.send_out(Task::Act(EXPORTED), places.clone(), act, |_| Outcome::Left(None))?;
            }
            Ask::Import(paths) => {
                // What is dropped into a window nobody has looked into is to be seen too.
                self.look()?;
                self.refuse_while_busy()?;
                let saves = self.saves.clone();
                let act = move |path: PathBuf| import(&saves, &path).into();
                self.send_out(Task::Act(IMPORTED), paths.clone(), act, |_| Outcome::Left(None))?;
            }
            Ask::Cancel => self.cancel(),
        }
        Ok(None)
    }

    pub(super) fn look(&mut self) -> Result<(), String> {
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

    /// Reads who is to take the stage: now, if that is quick, and else beside the window; see [`Ask::Present`].
    fn load(
        &mut self,
        is_quick: bool,
        load: impl FnOnce() -> Result<Show, String> + Send + 'static,
    ) -> Result<Option<Show>, String> {
        // Whoever was asked for before would come too late.
        (self.loading, self.loaded) = (None, None);
        if is_quick {
            return load().map(Some);
        }
        let errand = Errand::start(load).map_err(|error| format!("Nothing was read: {error}"))?;
        self.loading = Some(errand);
        Ok(None)
    }

    /// Does something with each of several entries, with many of them beside the window: then nothing is returned.
    /// What was done before one fails is kept, and can be undone.
    fn each(
        &mut self,
        verb: Verb,
        places: &[Place],
        act: impl Fn(&SavesFolder, &Place) -> Result<Step, SaveError> + Send + 'static,
    ) -> Result<Option<String>, String> {
        self.refuse_while_busy()?;
        if places.len() > MOST_AT_ONCE {
            let saves = self.saves.clone();
            let act = move |place: Place| act(&saves, &place).into();
            self.send_out(Task::Act(verb), places.to_vec(), act, |_| Outcome::Left(None))?;
            return Ok(None);
        }
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
        let words = format!("{} {}", verb.done, listed(&done));
        self.keep(Change { words: words.clone(), steps });
        problem.map_or(Ok(Some(words)), Err)
    }
}

/// Names in a few words: one by itself, several counted.
fn listed(names: &[String]) -> String {
    match names {
        [one] => one.clone(),
        several => format!("{} saves", several.len()),
    }
}

pub(super) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::exhibit::Exhibit;
    use crate::studio::library::tests::{library, place};

    #[test]
    fn a_run_that_is_not_read_yet_takes_the_stage_once_it_is() {
        let (folder, mut library) = library(&["mine"]);
        let gone = Place::Run(folder.path().join("gone"));
        let mut notices = Notices::default();
        let ask = Ask::Replay(gone);
        assert!(library.apply(&ask, &mut notices).expect("begun").is_none());
        while library.loading.is_some() {
            library.take_in(&mut notices);
        }
        assert!(library.has_loaded());
        assert!(library.apply(&Ask::Present, &mut notices).expect_err("gone").contains("gone"));
        assert!(library.apply(&Ask::Present, &mut notices).expect("nothing").is_none());
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
