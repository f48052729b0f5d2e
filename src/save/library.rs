//! The library: every champion and every run in a folder of saves, and what can be done with them.
//!
//! [`list`] looks at names alone, so that ten thousand files take no time; what stands in one of them is read by
//! itself ([`read_entry`]), and one that is damaged stands in no other's way. Nothing here simulates.
//!
//! Whatever is done loses nothing: no name that is taken is written over, what is deleted is moved into a folder
//! beside, and every [`Step`] can be undone. No link is followed.

mod change;
mod details;
mod list;
mod name;
mod shipped;
mod thumbnail;
mod transfer;

pub use change::{Step, delete, duplicate, rename};
pub use details::{ChampionDetails, Details, RunDetails, load_entry, read_entry};
pub use list::{Entry, Place, list};
pub use name::{LONGEST_NAME, check_entry_name};
pub use thumbnail::Thumbnail;
pub use transfer::{export, import};

/// Where in a folder of saves it is that deleted entries are kept.
pub const DELETED: &str = ".deleted";
/// Where in a folder of saves exported copies go, if no other place is named.
pub const EXPORTS: &str = "exports";

/// Folders of saves for tests.
#[cfg(test)]
mod fixtures {
    use tempfile::TempDir;

    use super::{Entry, Place};
    use crate::evolve::{RunPlan, Settings};
    use crate::save::{Earlier, SavesFolder, shipped_champion, store_champion};

    /// An empty folder of saves, which goes when it is dropped.
    pub fn saves() -> (TempDir, SavesFolder) {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        (folder, saves)
    }

    /// A champion in it.
    pub fn champion_in(saves: &SavesFolder, name: &str) -> Place {
        let path = saves.path().join(format!("{name}.ron"));
        let loaded = shipped_champion().expect("well formed");
        store_champion(&path, &loaded.champion, loaded.recording.as_ref()).expect("written");
        Place::Champion(path)
    }

    /// A run in it that was stopped after two of four generations.
    pub fn run_in(saves: &SavesFolder, seed: u64) -> Place {
        let mut settings = Settings::default();
        settings.evolution.population = 6;
        settings.evolution.generations = 4;
        settings.trial.duration_s = 0.5;
        let plan = RunPlan::new("test", seed, settings);
        let place = Place::Run(saves.of_run(&plan));
        let source = crate::run::RunSource::in_saves(saves, plan, Earlier::Keep);
        let mut run = source.open("a test").expect("opened");
        let pool = crate::run::pool(1).expect("a pool");
        for _ in 0..2 {
            let report = run.experiment.run_generation(&pool, &crate::run::Control::default());
            run.keeper.keep(&run.experiment, &report.expect("not cancelled")).expect("kept");
        }
        place
    }

    /// The names of those that are meant.
    pub fn names(entries: &[Entry], is_meant: impl Fn(&Place) -> bool) -> Vec<String> {
        let meant = entries.iter().filter(|entry| is_meant(&entry.place));
        meant.map(|entry| entry.place.name()).collect()
    }
}
