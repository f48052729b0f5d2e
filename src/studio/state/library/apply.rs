//! Executes the commands of the library.

use std::path::PathBuf;

use super::Library;
use super::batch_jobs::{DELETED, DUPLICATED, EXPORTED, IMPORTED, SAVED};
use super::examination::Examination;
use super::load::{champion_of, generation_of};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{MAX_LANES, Show};
use crate::studio::state::shares::shared;
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::notifications::Notices;
use snakes_core::save::champion_text;
use snakes_core::save::library::{
    FileStep, SavePlace, delete, duplicate, export, import, plain_name, rename, set_notes_text,
};
use snakes_core::score::Recording;
use snakes_lab::run::names::preset_title;
use snakes_lab::run::{BackgroundTask, LibraryReader};

impl Library {
    /// Executes a command to the library. Returns the champions to show on the stage, if any.
    ///
    /// # Errors
    /// The command cannot be executed, for the returned reason.
    pub fn apply(
        &mut self,
        request: &LibraryCommand,
        history: &mut UndoHistory,
        notices: &mut Notices,
    ) -> Result<Option<Show>, String> {
        match request {
            LibraryCommand::Refresh => self.look()?,
            LibraryCommand::LoadFirst(places) => {
                if let Some(reader) = &self.reader {
                    reader.read_first(places.clone());
                }
            }
            LibraryCommand::Replay(place) => return self.race(std::slice::from_ref(place)),
            LibraryCommand::Race(places) => return self.race(places),
            LibraryCommand::ShowLoaded => return self.loaded.take().transpose(),
            LibraryCommand::ReplayGeneration { run, generation } => {
                let (run, generation) = (run.clone(), *generation);
                return self.load(true, move || generation_of(&run, generation).map(Show::solo));
            }
            LibraryCommand::RaceGenerations { run, generations } => {
                let champions =
                    generations.iter().map(|generation| generation_of(run, *generation));
                return Ok(Some(Show::race(champions.collect::<Result<_, _>>()?)));
            }
            LibraryCommand::Rename { place, name } => {
                self.refuse_while_busy()?;
                let label = format!("renamed {}", self.name_of(place));
                let step = rename(place, name.trim())?;
                self.keep(label, vec![step], history);
            }
            LibraryCommand::SetNotes { place, text } => {
                self.refuse_while_busy()?;
                let label = format!("notes of {}", self.name_of(place));
                let step = set_notes_text(place, text.trim())?;
                self.keep(label, vec![step], history);
            }
            // The caller saves the snake, because it knows the stage.
            LibraryCommand::SaveSnake => {}
            LibraryCommand::Duplicate(places) => {
                self.carry_out(DUPLICATED, places, duplicate, history, notices)?;
            }
            LibraryCommand::Delete(places) => {
                self.carry_out(DELETED, places, delete, history, notices)?;
            }
            LibraryCommand::Export { places, to } => {
                let (saves, to) = (self.saves.clone(), to.clone());
                let act = move |place| export(&saves, &place, to.as_deref());
                self.send_out(EXPORTED, places.clone(), act)?;
            }
            LibraryCommand::Import(paths) => {
                // Files can be dropped before the library is first opened. Their copies must then be listed as well.
                self.look()?;
                let saves = self.saves.clone();
                let act = move |path: PathBuf| import(&saves, &path);
                self.send_out(IMPORTED, paths.clone(), act)?;
            }
            LibraryCommand::Examine(_) if self.examination.is_some() => {
                return Err("An exam is in progress: wait for it, or cancel it".to_owned());
            }
            LibraryCommand::Examine(places) => self.examination = Examination::begin(places)?,
            LibraryCommand::Cancel => {
                self.cancel();
                self.examination.iter().for_each(Examination::cancel);
            }
        }
        Ok(None)
    }

    /// Saves a snake of the stage with its recorded poses, in the background.
    ///
    /// # Errors
    /// No file can hold the snake, or a long batch is in progress; the error is a sentence for the user.
    pub fn save(&mut self, staged: &StagedChampion) -> Result<(), String> {
        let champion = shared(staged)?;
        self.look()?;
        let saves = self.saves.clone();
        self.send_out(SAVED, vec![champion], move |champion| {
            let (label, champion) = champion();
            let (preset, seed) = (preset_title(&champion.origin.preset), champion.origin.seed);
            let name = plain_name(&format!("{preset} {seed}, {label}"));
            let recording = Recording::of(&champion.genome, &champion.trial);
            let text = champion_text(&champion, Some(&recording), &[])?;
            Ok(FileStep::Added { path: saves.add_file(&name, "ron", text.as_bytes())? })
        })
    }

    /// Loads the champions of entries, to show them side by side, or a single one alone.
    fn race(&mut self, places: &[SavePlace]) -> Result<Option<Show>, String> {
        let known = |place: &SavePlace| {
            let own_name = self.item(place).and_then(|item| item.own_name()).map(str::to_owned);
            (place.clone(), own_name, self.best_of(place))
        };
        let racers: Vec<_> = places.iter().take(MAX_LANES).map(known).collect();
        let is_quick =
            racers.iter().all(|(place, _, best)| place.run().is_none() || best.is_some());
        self.load(is_quick, move || {
            let champions =
                racers.iter().map(|(place, name, best)| champion_of(place, name.as_deref(), *best));
            Ok(Show::race(champions.collect::<Result<_, _>>()?))
        })
    }

    pub(super) fn look(&mut self) -> Result<(), String> {
        if self.reader.is_some() {
            self.look_again();
        } else {
            let reader = LibraryReader::start(self.saves.clone());
            self.reader =
                Some(reader.map_err(|error| format!("The saves cannot be read: {error}"))?);
        }
        Ok(())
    }

    /// Loads champions for the stage: at once if this is quick, or else in the background; see [`LibraryCommand::ShowLoaded`].
    fn load(
        &mut self,
        is_quick: bool,
        load: impl FnOnce() -> Result<Show, String> + Send + 'static,
    ) -> Result<Option<Show>, String> {
        // This request replaces an earlier one.
        (self.loading, self.loaded) = (None, None);
        if is_quick {
            return load().map(Some);
        }
        let task = BackgroundTask::start(load);
        self.loading = Some(task.map_err(|error| format!("The save could not be read: {error}"))?);
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::library::tests::Tried;
    use crate::studio::state::undo::UndoDirection;
    use snakes_core::save::{load_champion, shipped_champion};

    #[test]
    fn a_run_that_is_not_read_yet_is_loaded_in_the_background() {
        let mut tried = Tried::new(&["mine"]);
        let gone = SavePlace::Run(tried.folder.path().join("gone"));
        assert!(tried.apply(&LibraryCommand::Replay(gone)).expect("begun").is_none());
        while tried.library.loading.is_some() {
            tried.take_in();
        }
        assert!(tried.library.loaded.is_some());
        let problem = tried.apply(&LibraryCommand::ShowLoaded).expect_err("gone");
        assert!(problem.contains("gone"), "{problem}");
        assert!(tried.apply(&LibraryCommand::ShowLoaded).expect("nothing").is_none());
    }

    #[test]
    fn snakes_that_are_saved_at_the_same_time_are_all_kept() {
        let mut tried = Tried::new(&[]);
        let champion = shipped_champion().expect("well formed").champion;
        let found = StagedChampion::from_run(&champion, 0);
        let frictions = [0.25, 0.5, 0.75, 1.25];
        for friction in frictions {
            let mut trial = champion.trial.clone();
            trial.surface.friction = friction;
            let changed = found.in_world(&trial, format!("friction {friction}"));
            tried.library.save(&changed).expect("begun");
        }
        tried.wait();
        let names = tried.own();
        let friction_of = |name: String| {
            let path = tried.folder.path().join(name + ".ron");
            load_champion(&path).expect("readable").champion.trial.surface.friction
        };
        let mut kept: Vec<f32> = names.into_iter().map(friction_of).collect();
        kept.sort_by(f32::total_cmp);
        assert_eq!(kept, frictions);
    }

    #[test]
    fn the_snake_on_the_stage_is_saved_in_the_world_that_is_shown_and_undone() {
        let mut tried = Tried::new(&[]);
        let mut champion = shipped_champion().expect("well formed").champion;
        champion.origin.generation = 12;
        let found = StagedChampion::from_run(&champion, 0);
        let mut trial = champion.trial.clone();
        trial.surface.friction = 0.25;
        let changed = found.in_world(&trial, "friction 0.25".to_owned());
        for (staged, trial) in [(&found, &champion.trial), (&changed, &trial)] {
            tried.library.save(staged).expect("begun");
            tried.wait();
            let place = tried.library.newest.1.clone().expect("pointed out");
            let saved = load_champion(place.path().expect("a file")).expect("readable");
            assert_eq!((&saved.champion.trial, saved.recording.is_some()), (trial, true));
            assert_eq!(saved.champion.genome, champion.genome);
        }
        let preset = preset_title(&champion.origin.preset);
        let name = format!("{preset} {}, Generation 12-1", champion.origin.seed);
        assert!(tried.own().contains(&name), "{:?}", tried.own());
        (0..2).for_each(|_| tried.step(UndoDirection::Back));
        assert_eq!(tried.own(), Vec::<String>::new());
    }

    #[test]
    fn a_race_of_saves_shows_them_under_their_names() {
        let mut tried = Tried::new(&["mine"]);
        let race = LibraryCommand::Race(vec![tried.place("mine"), SavePlace::Shipped("fast")]);
        let show = tried.apply(&race).expect("read").expect("shown");
        let names: Vec<&str> = show.champions.iter().map(StagedChampion::name).collect();
        assert_eq!(names, ["mine", "fast"]);
        assert_ne!(show.champions[0].source(), show.champions[1].source());
    }
}
