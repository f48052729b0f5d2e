//! Carries out [`LibraryCommand`]s.

use std::path::PathBuf;

use super::Library;
use super::batch_jobs::{
    BatchOutcome, BatchTask, DELETED, DUPLICATED, EXPORTED, IMPORTED, MOST_AT_ONCE, Verb,
};
use super::file_changes::LibraryChange;
use super::load::{champion_of, generation_of};
use super::words::{capital, listed};
use crate::run::{BackgroundTask, LibraryReader};
use crate::save::library::{FileStep, SavePlace, delete, duplicate, export, import, rename};
use crate::save::{SaveError, SavesFolder};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::stage::{MAX_LANES, Show};
use crate::studio::state::lineup::evenly_chosen;
use crate::studio::ui::notifications::Notices;

impl Library {
    /// Carries out a command. Returns the champions to show, if any.
    ///
    /// # Errors
    /// The operation that failed, and why.
    pub fn apply(
        &mut self,
        request: &LibraryCommand,
        notices: &mut Notices,
    ) -> Result<Option<Show>, String> {
        match request {
            LibraryCommand::Refresh => self.look()?,
            LibraryCommand::LoadFirst(places) => {
                if let Some(reader) = &self.reader {
                    reader.read_first(places.clone());
                }
            }
            LibraryCommand::Replay(place) => {
                let (place, best) = (place.clone(), self.best_of(place));
                let is_quick = place.run().is_none() || best.is_some();
                return self.load(is_quick, move || champion_of(&place, best).map(Show::solo));
            }
            LibraryCommand::Race(places) => {
                let places = places.iter().take(MAX_LANES);
                let racers: Vec<(SavePlace, Option<u32>)> =
                    places.map(|place| (place.clone(), self.best_of(place))).collect();
                let is_quick =
                    racers.iter().all(|(place, best)| place.run().is_none() || best.is_some());
                return self.load(is_quick, move || {
                    let champions = racers.iter().map(|(place, best)| champion_of(place, *best));
                    Ok(Show::race(champions.collect::<Result<_, _>>()?))
                });
            }
            LibraryCommand::ShowLoaded => return self.loaded.take().transpose(),
            LibraryCommand::ReplayGeneration { run, generation } => {
                let (run, generation) = (run.clone(), *generation);
                return self.load(true, move || generation_of(&run, generation).map(Show::solo));
            }
            LibraryCommand::RaceGenerations { run, generations } => {
                let chosen = evenly_chosen(generations.len()).map(|index| generations[index]);
                let champions = chosen.map(|generation| generation_of(run, generation));
                return Ok(Some(Show::race(champions.collect::<Result<_, _>>()?)));
            }
            // Needs the current run: see [`super::found_run`].
            LibraryCommand::StartFrom(_) => {}
            // Handled together with the undo steps of settings: see [`Self::step`].
            LibraryCommand::Undo | LibraryCommand::Redo => {}
            LibraryCommand::Rename { place, name } => {
                self.refuse_while_busy()?;
                let step = rename(place, name.trim()).map_err(|error| error.to_string())?;
                self.keep(LibraryChange {
                    words: format!("renamed {}", place.name()),
                    steps: vec![step],
                });
            }
            LibraryCommand::Duplicate(places) => {
                self.each(DUPLICATED, places, duplicate)?;
            }
            LibraryCommand::Delete(places) => {
                if let Some(words) = self.each(DELETED, places, delete)? {
                    notices.info(format!("{}. Press Ctrl Z to undo.", capital(&words)));
                }
            }
            LibraryCommand::Export { places, to } => {
                self.refuse_while_busy()?;
                let (saves, to) = (self.saves.clone(), to.clone());
                let act = move |place: SavePlace| export(&saves, &place, to.as_deref()).into();
                self.send_out(BatchTask::Act(EXPORTED), places.clone(), act, |_| {
                    BatchOutcome::Left(None)
                })?;
            }
            LibraryCommand::Import(paths) => {
                // Imported files must appear even if the library was never opened.
                self.look()?;
                self.refuse_while_busy()?;
                let saves = self.saves.clone();
                let act = move |path: PathBuf| import(&saves, &path).into();
                self.send_out(BatchTask::Act(IMPORTED), paths.clone(), act, |_| {
                    BatchOutcome::Left(None)
                })?;
            }
            LibraryCommand::Cancel => self.cancel(),
        }
        Ok(None)
    }

    pub(super) fn look(&mut self) -> Result<(), String> {
        match &self.reader {
            Some(reader) => reader.list_again(),
            None => {
                let reader = LibraryReader::start(self.saves.clone());
                let reader =
                    reader.map_err(|error| format!("The saves cannot be read: {error}"))?;
                self.reader = Some(reader);
            }
        }
        Ok(())
    }

    /// Reads champions for the stage: immediately if `is_quick`, otherwise in the background; see
    /// [`LibraryCommand::ShowLoaded`].
    fn load(
        &mut self,
        is_quick: bool,
        load: impl FnOnce() -> Result<Show, String> + Send + 'static,
    ) -> Result<Option<Show>, String> {
        // A newer request replaces an older one.
        (self.loading, self.loaded) = (None, None);
        if is_quick {
            return load().map(Some);
        }
        let task = BackgroundTask::start(load);
        self.loading = Some(task.map_err(|error| format!("The save could not be read: {error}"))?);
        Ok(None)
    }

    /// Applies an operation to each entry. Large batches run in the background, and `None` is returned. After a
    /// failure, the finished steps are kept and can be undone.
    fn each(
        &mut self,
        verb: Verb,
        places: &[SavePlace],
        act: impl Fn(&SavesFolder, &SavePlace) -> Result<FileStep, SaveError> + Send + 'static,
    ) -> Result<Option<String>, String> {
        self.refuse_while_busy()?;
        if places.len() > MOST_AT_ONCE {
            let saves = self.saves.clone();
            let act = move |place: SavePlace| act(&saves, &place).into();
            self.send_out(BatchTask::Act(verb), places.to_vec(), act, |_| {
                BatchOutcome::Left(None)
            })?;
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
        self.keep(LibraryChange { words: words.clone(), steps });
        problem.map_or(Ok(Some(words)), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::staged_champion::StagedChampion;
    use crate::studio::state::library::tests::{library, place};

    #[test]
    fn a_run_that_is_not_read_yet_is_shown_once_it_is_read() {
        let (folder, mut library) = library(&["mine"]);
        let gone = SavePlace::Run(folder.path().join("gone"));
        let mut notices = Notices::default();
        let request = LibraryCommand::Replay(gone);
        assert!(library.apply(&request, &mut notices).expect("begun").is_none());
        while library.loading.is_some() {
            library.take_in(&mut notices);
        }
        assert!(library.has_loaded());
        assert!(
            library
                .apply(&LibraryCommand::ShowLoaded, &mut notices)
                .expect_err("gone")
                .contains("gone")
        );
        assert!(
            library.apply(&LibraryCommand::ShowLoaded, &mut notices).expect("nothing").is_none()
        );
    }

    #[test]
    fn chosen_saves_race_under_their_names() {
        let (_folder, mut library) = library(&["mine"]);
        let race = LibraryCommand::Race(vec![place(&library, "mine"), SavePlace::Shipped("fast")]);
        let show = library.apply(&race, &mut Notices::default()).expect("read").expect("shown");
        let names: Vec<&str> = show.champions.iter().map(StagedChampion::name).collect();
        assert_eq!(names, ["mine", "fast"]);
        assert_ne!(show.champions[0].source(), show.champions[1].source());
    }
}
