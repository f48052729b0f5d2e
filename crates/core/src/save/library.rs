//! The library: the champions and runs in a folder of saves, and the operations on them.
//!
//! [`list`] reads names only, so that ten thousand files take little time. [`read_entry`] reads the contents of one entry; a damaged entry
//! does not affect the others. The library does not simulate.
//!
//! No operation loses data: no file is overwritten, deleted entries are moved into a hidden folder, and every [`FileStep`]
//! can be undone. Links are not followed.

mod change;
mod details;
mod list;
mod moving;
mod name;
mod notes;
mod place;
mod problem;
mod shipped;
mod thumbnail;
mod transfer;

pub use change::{DELETED, FileStep, delete, duplicate, rename};
pub use details::{
    ChampionDetails, EntryDetails, RunDetails, load_entry, read_entry, shipped_champions,
};
pub use list::{LibraryEntry, list};
pub(super) use moving::taken;
pub(super) use name::is_free;
pub use name::{check_entry_name, plain_name};
pub use notes::{read_notes, set_notes_text};
pub use place::SavePlace;
pub use problem::EntryProblem;
pub use thumbnail::Thumbnail;
pub use transfer::{EXPORTS, export, import, run_of_plan};

/// Folders of saves for tests.
#[cfg(test)]
pub(in crate::save) mod fixtures {
    use tempfile::TempDir;

    use super::{LibraryEntry, SavePlace};
    use crate::evolve::{
        Champion, GenerationRecord, Origin, RunPlan, Settings, Statistics, begin, run_hash,
    };
    use crate::save::{
        ExistingRun, RunFolder, SavesFolder, SearchState, shipped_champion, store_champion,
    };
    use crate::score::{Recording, evaluate};

    /// Makes an empty folder of saves, which is removed when the first value is dropped.
    pub fn saves() -> (TempDir, SavesFolder) {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        (folder, saves)
    }

    /// Stores the shipped champion under a name in a folder of saves.
    pub fn champion_in(saves: &SavesFolder, name: &str) -> SavePlace {
        let path = saves.path().join(format!("{name}.ron"));
        let loaded = shipped_champion().expect("well formed");
        store_champion(&path, &loaded.champion, loaded.recording.as_ref()).expect("written");
        SavePlace::Champion(path)
    }

    /// Stores a run, stopped after two of four generations, in a folder of saves.
    pub fn run_in(saves: &SavesFolder, seed: u64) -> SavePlace {
        let mut settings = Settings::default();
        settings.evolution.population = 6;
        settings.evolution.generations = 4;
        settings.trial.duration_s = 0.5;
        let plan = RunPlan::new("test", seed, settings);
        let path = saves.of_run(&plan);
        let opened = RunFolder::open(&path, &plan, ExistingRun::Keep, "a test");
        let (mut folder, _) = opened.expect("opened");
        let (mut search, mut records) = (begin(&plan), Vec::new());
        for generation in 1..=2 {
            let asked = search.ask();
            let evaluations: Vec<_> =
                asked.iter().map(|of| evaluate(&of.genome, &plan.settings.trial)).collect();
            search.tell(&asked, &evaluations);
            let champion = Champion {
                genome: asked[0].genome.clone(),
                trial: plan.settings.trial.clone(),
                evaluation: evaluations[0],
                chosen_by: None,
                origin: Origin { preset: "test".to_owned(), seed, generation, individual: 0 },
            };
            let recording = Recording::of(&champion.genome, &champion.trial);
            let fitness = f64::from(champion.evaluation.fitness);
            let statistics = Statistics {
                mean: fitness,
                best: fitness,
                median: fitness,
                std: 0.0,
                worst: fitness,
                mean_centre_y_m: champion.evaluation.centre_y_m.into(),
                lower_quartile: None,
                upper_quartile: None,
            };
            let of_test = GenerationRecord::of_test(generation, asked.len() as u32);
            records.push(GenerationRecord { statistics: Some(statistics), ..of_test });
            let hash = run_hash(&records);
            let state = SearchState { strategy: search.state(), front: Default::default() };
            folder
                .finish_generation(
                    &records[records.len() - 1],
                    Some((&champion, &recording)),
                    &state,
                    hash,
                )
                .expect("kept");
        }
        SavePlace::Run(path)
    }

    /// Returns the names of the matching entries.
    pub fn names(entries: &[LibraryEntry], matches: impl Fn(&SavePlace) -> bool) -> Vec<String> {
        let matching = entries.iter().filter(|entry| matches(&entry.place));
        matching.map(|entry| entry.place.name()).collect()
    }
}
