//! An entry of the library list: its texts and sort keys.

use crate::studio::ui::decimals::in_percent;
use snakes_core::genome::ControllerKind;
use snakes_core::save::EntryNotes;
use snakes_core::save::library::{
    ChampionDetails, EntryDetails, EntryProblem, LibraryEntry, RunDetails, SavePlace, Thumbnail,
};
use snakes_core::score::Fitness;
use snakes_lab::run::names::{date, difference, run_name, with_title};

/// An entry of the library with its contents, once they are read.
#[derive(Debug)]
pub struct LibraryItem {
    /// Place, size and modification time of the entry.
    pub entry: LibraryEntry,
    /// Entry after the file has changed, until the file is read again.
    awaited: Option<LibraryEntry>,
    name: String,
    /// Name of the entry without the addition that tells it apart from others of the same name.
    plain_name: String,
    /// Contents of the entry or the error of reading it; `None` until it is read.
    pub read: Option<Result<EntryDetails, EntryProblem>>,
    /// Name of the entry in lower case, which is its sort key.
    pub sorted_as: String,
    /// Words of the entry in lower case, which the search compares.
    words: String,
}

impl LibraryItem {
    /// Creates an entry that has not been read yet.
    pub fn new(entry: LibraryEntry) -> Self {
        let (name, plain_name, sorted_as, words) = Default::default();
        let mut item =
            Self { entry, awaited: None, name, plain_name, read: None, words, sorted_as };
        item.describe();
        item
    }

    /// Records a change of the file. The old contents and date stay until the file is read again, so that the entry's
    /// row moves only once.
    pub fn follow(&mut self, entry: LibraryEntry) {
        if *self.awaited.as_ref().unwrap_or(&self.entry) != entry {
            self.awaited = Some(entry);
        }
    }

    /// Returns whether the entry must be read, for the first time or again.
    pub fn is_to_be_read(&self) -> bool {
        self.read.is_none() || self.awaited.is_some()
    }

    /// Stores the contents of the entry. Returns whether a sort or search key changed.
    pub fn learn(&mut self, read: Result<EntryDetails, EntryProblem>) -> bool {
        // The words include the name, the preset and "damaged".
        let keys = |item: &Self| {
            let way = item.way().map(f32::to_bits);
            (item.entry.modified, way, item.generation(), item.words.clone())
        };
        let before = keys(self);
        self.entry = self.awaited.take().unwrap_or_else(|| self.entry.clone());
        self.read = Some(read);
        self.describe();
        before != keys(self)
    }

    fn describe(&mut self) {
        let folder = self.place().shown_name();
        let own = self.own_name().map(str::to_owned);
        let name = own.or_else(|| self.readable_name(&folder)).unwrap_or_else(|| folder.clone());
        if name != self.plain_name {
            (self.sorted_as, self.name, self.plain_name) =
                (name.to_lowercase(), name.clone(), name);
        }
        let kind = match self.place() {
            SavePlace::Shipped(_) => "champion built-in",
            SavePlace::Champion(_) => "champion",
            SavePlace::Run(_) => "run",
        };
        let mut words = vec![self.plain_name.as_str(), kind];
        if self.plain_name != folder {
            words.push(&folder);
        }
        words.extend(self.notes().ok().map(|notes| notes.text.as_str()));
        words.extend(self.problem().map(|problem| problem.words));
        words.extend(self.preset());
        let titled = self.preset_title();
        words.extend(titled.as_deref());
        words.extend(self.controller().map(ControllerKind::name));
        let method = self.run().and_then(|run| run.strategy);
        words.extend(method.map(|method| method.title()));
        self.words = words.join("\n").to_lowercase();
    }

    /// Returns the readable name of a run in a folder that the program named.
    fn readable_name(&self, folder: &str) -> Option<String> {
        let RunDetails { preset, seed, rewarded, best, .. } = self.run()?;
        let of_program = format!("{}-seed{seed}-", preset.split(", ").next()?);
        let best = best.map(|(_, fitness)| (*rewarded, fitness));
        let name = || run_name(preset, *seed, self.entry.modified, best);
        folder.starts_with(&of_program).then(name)
    }

    /// Returns the user's own name for the entry, if any.
    pub fn own_name(&self) -> Option<&str> {
        self.notes().ok().and_then(EntryNotes::own_name)
    }

    /// Returns the name of a run without an addition, and the addition that would tell it apart from others of this name.
    pub fn name_to_tell_apart(&mut self) -> Option<(&mut String, String)> {
        let difference = difference(self.place().run()?, self.own_name().is_some());
        self.name.clone_from(&self.plain_name);
        Some((&mut self.name, difference))
    }

    /// Returns the place of the entry.
    pub fn place(&self) -> &SavePlace {
        &self.entry.place
    }

    /// Returns the user's name for the entry, or else a readable one of a run, or else the name of the file or folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns whether the words of the entry contain all of these lower-case words.
    pub fn has_all(&self, sought: &[&str]) -> bool {
        sought.iter().all(|sought| self.words.contains(sought))
    }

    /// Returns the error of reading the entry, if any.
    pub fn problem(&self) -> Option<&EntryProblem> {
        self.read.as_ref()?.as_ref().err()
    }

    /// Returns the user's name and notes for the entry.
    ///
    /// # Errors
    /// The notes cannot be read, for the returned reason.
    pub fn notes(&self) -> Result<&EntryNotes, &str> {
        self.entry.notes.as_ref().map_err(String::as_str)
    }

    /// Returns the contents if the entry is a champion that has been read.
    pub fn champion(&self) -> Option<&ChampionDetails> {
        match &self.read {
            Some(Ok(EntryDetails::Champion(champion))) => Some(champion),
            _ => None,
        }
    }

    /// Returns the contents if the entry is a run that has been read.
    pub fn run(&self) -> Option<&RunDetails> {
        match &self.read {
            Some(Ok(EntryDetails::Run(run))) => Some(run),
            _ => None,
        }
    }

    /// Returns the part of the way from the start to the landing that a champion, or the best of a run, covered, from 0 to 1. Unlike the
    /// fitness, it is the same measure for all entries. `None` without stairs, a result or a recording.
    pub fn way(&self) -> Option<f32> {
        let of_run = || self.run().and_then(|of| Some((of.rewarded, of.best?.1)));
        let result = self.champion().map(|of| (of.rewarded, of.fitness)).or_else(of_run);
        let ((rewarded, fitness), seen) = (result?, self.thumbnail()?);
        let from_m = seen.way_m.first()?[0];
        // The outline of the stairs ends with the landing's front edge, back edge and foot.
        let landing_m = seen.stairs_m.iter().rev().nth(2)?[0];
        let covered = match rewarded {
            Fitness::Share => fitness,
            of if of.is_along_y() => (fitness - from_m) / (landing_m - from_m),
            _ => (seen.way_m.last()?[0] - from_m) / (landing_m - from_m),
        };
        Some(covered.clamp(0.0, 1.0))
    }

    /// Returns the covered part of the way as text, such as "76 %" before `of_what`, or an empty text if it is unknown.
    pub fn way_text(&self, of_what: &str) -> String {
        self.way().map(|way| in_percent(way) + of_what).unwrap_or_default()
    }

    /// Returns the generation of a champion, or the number of finished generations of a run.
    pub fn generation(&self) -> Option<u32> {
        let of_champion = self.champion().map(|champion| champion.origin.generation);
        of_champion.or(self.run().map(|run| run.finished))
    }

    /// Describes the generation: "generation 3", or "3 of at most 100 generations" for a run.
    pub fn generation_text(&self) -> String {
        match (self.champion(), self.run()) {
            (Some(champion), _) => format!("generation {}", champion.origin.generation),
            (_, Some(RunDetails { generations: Some(words), .. })) => words.clone(),
            (_, Some(run)) => format!("{} generations", run.finished),
            _ => String::new(),
        }
    }

    /// Returns the title of the preset with which the champion's run or the run began, and what differs from the preset.
    pub fn preset_title(&self) -> Option<String> {
        self.preset().map(with_title)
    }

    /// Returns the name of the preset with which the champion's run or the run began.
    fn preset(&self) -> Option<&str> {
        let of_run = || self.run().map(|run| run.preset.as_str());
        self.champion().map(|champion| champion.origin.preset.as_str()).or_else(of_run)
    }

    /// Returns the kind of the entry's controller.
    pub fn controller(&self) -> Option<ControllerKind> {
        self.champion().map(|of| of.controller).or(self.run().map(|of| of.controller))
    }

    /// Returns the thumbnail of the entry, seen from the side.
    pub fn thumbnail(&self) -> Option<&Thumbnail> {
        self.champion().map(|of| &of.thumbnail).or(self.run().map(|of| &of.thumbnail))
    }

    /// Returns the modification date, or "built-in".
    pub fn date_text(&self) -> String {
        match self.place() {
            SavePlace::Shipped(_) => "built-in".to_owned(),
            SavePlace::Champion(_) | SavePlace::Run(_) => date(self.entry.modified),
        }
    }

    /// Describes the entry in one line for screen readers.
    pub fn label(&self) -> String {
        if let Some(EntryProblem { words, message }) = self.problem() {
            return format!("{}, {words}: {message}", self.name);
        }
        if self.read.is_none() {
            return format!("{}, not read yet", self.name);
        }
        let kind = if self.place().run().is_some() { "run" } else { "" };
        let (date, generation) = (self.date_text(), self.generation_text());
        let (way, preset) = (self.way_text(" of the way"), self.preset_title().unwrap_or_default());
        let parts = [&self.name, kind, &way, &preset, &generation, &date];
        let said: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        said.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::library::read_entry;
    use std::time::Duration;

    fn entry(place: SavePlace, notes: EntryNotes) -> LibraryEntry {
        LibraryEntry { place, bytes: 0, modified: Duration::ZERO, notes: Ok(notes) }
    }

    #[test]
    fn the_search_finds_name_preset_controller_and_damage() {
        let item = |read: bool| {
            let place = SavePlace::Shipped("fast");
            let details = read_entry(&place).map_err(EntryProblem::from);
            let mut item = LibraryItem::new(entry(place, EntryNotes::default()));
            item.learn(if read { details } else { Err(EntryProblem::damaged("cut off")) });
            item
        };
        let good = item(true);
        for sought in ["fast", "climb", "gait", "built-in"] {
            assert!(good.has_all(&[sought]), "{sought}");
        }
        assert!(good.has_all(&["gait", "fas"]) && !good.has_all(&["gait", "slow"]));
        assert!(!good.has_all(&["damaged"]));
        assert_eq!(good.label(), "fast, 100 % of the way, Climb, generation 102, built-in");
        let bad = item(false);
        assert!(bad.has_all(&["damaged"]) && !bad.has_all(&["climb"]));
        assert_eq!(bad.label(), "fast, damaged: cut off");
    }

    #[test]
    fn the_covered_way_is_one_measure_for_every_kind_of_fitness() {
        for (name, of_the_way) in [
            ("climber", "100 %"),
            ("learner", "76 %"),
            ("first-climber", "57 %"),
            ("twister", "91 %"),
        ] {
            let place = SavePlace::Shipped(name);
            let read = read_entry(&place).map_err(EntryProblem::from);
            let mut item = LibraryItem::new(entry(place, EntryNotes::default()));
            assert_eq!(item.way_text(""), "", "not read yet");
            item.learn(read);
            assert_eq!(item.way_text(""), of_the_way, "{name}");
        }
    }

    #[test]
    fn a_run_is_shown_sorted_and_found_under_its_own_name_and_notes() {
        let entry = |name: &str, text: &str| {
            let notes = EntryNotes { name: name.to_owned(), text: text.to_owned() };
            entry(SavePlace::Run("saves/climb-seed1-be07eab1".into()), notes)
        };
        let mut item = LibraryItem::new(entry("", ""));
        assert_eq!(item.name(), "climb-seed1-be07eab1");
        item.learn(Err(EntryProblem::damaged("cut off")));
        item.follow(entry("Icy One", "slips at step 3"));
        assert!(item.learn(Err(EntryProblem::damaged("cut off"))), "it is sorted again");
        assert_eq!((item.name(), item.sorted_as.as_str()), ("Icy One", "icy one"));
        for sought in ["icy", "seed1", "slips at"] {
            assert!(item.has_all(&[sought]), "{sought}");
        }
    }

    #[test]
    fn a_file_of_a_newer_version_is_not_called_damaged() {
        let place = SavePlace::Champion("saves/future.ron".into());
        let mut item = LibraryItem::new(entry(place, EntryNotes::default()));
        let message = "format is 99".to_owned();
        item.learn(Err(EntryProblem { words: "from a newer version", message }));
        assert_eq!(item.label(), "future, from a newer version: format is 99");
        assert!(item.has_all(&["newer"]) && !item.has_all(&["damaged"]));
    }
}
