//! Where saves are.

use std::fs;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;
use xxhash_rust::xxh3::xxh3_64;

use super::files::prepare_folder;
use super::run::{load_plan, numbered, read_records};
use super::{LoadedChampion, SaveError, load_champion};
use crate::ENGINE_VERSION;
use crate::evolve::RunPlan;

/// The folder champions are written to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavesFolder(PathBuf);

impl SavesFolder {
    /// The folder a person named; else `saves/` in the working directory, if there is one; else the
    /// platform's data folder.
    pub fn find(named: Option<&Path>) -> Self {
        if let Some(named) = named {
            let is_empty = named.as_os_str().is_empty();
            return Self(if is_empty { PathBuf::from(".") } else { named.to_owned() });
        }
        let here = PathBuf::from("saves");
        if here.is_dir() {
            return Self(here);
        }
        let data = ProjectDirs::from("", "", "snakes-and-stairs");
        Self(data.map_or(here, |data| data.data_dir().join("saves")))
    }

    /// The folder's path.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// The folder in it that belongs to a run.
    pub fn of_run(&self, plan: &RunPlan) -> PathBuf {
        self.0.join(run_name(plan))
    }

    /// The runs in it that this engine can go on with, by the names of their folders. What cannot be
    /// read is left out.
    pub fn runs(&self) -> Vec<RunSummary> {
        let Ok(entries) = fs::read_dir(&self.0) else { return Vec::new() };
        let folders = entries.flatten().filter(|entry| entry.file_type().is_ok_and(|t| t.is_dir()));
        let mut folders: Vec<PathBuf> = folders.map(|entry| entry.path()).collect();
        folders.sort();
        let summary = |folder: PathBuf| {
            let plan = load_plan(&folder).ok()?;
            let finished = read_records(&folder, &plan.settings).ok()?.len() as u32;
            Some(RunSummary { folder, plan, finished })
        };
        folders.into_iter().filter_map(summary).collect()
    }

    /// Makes sure that files can be written into it, creating it if need be.
    pub fn prepare(&self) -> Result<(), SaveError> {
        prepare_folder(&self.0)
    }
}

/// A run that is in a folder of saves.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSummary {
    /// Its folder.
    pub folder: PathBuf,
    /// What run it is.
    pub plan: RunPlan,
    /// How many generations are finished.
    pub finished: u32,
}

impl RunSummary {
    /// Whether there are generations left to evolve.
    pub fn is_stopped(&self) -> bool {
        self.finished < self.plan.settings.evolution.generations
    }
}

/// The name of a run's folder: it names the preset, the seed, and in eight hex digits everything else
/// that decides the bits. So two folders of one name hold the same run, and no run overwrites another.
pub fn run_name(plan: &RunPlan) -> String {
    let RunPlan { preset, seed, settings } = plan;
    let settings = ron::to_string(settings).unwrap_or_default();
    let fingerprint = xxh3_64(format!("{ENGINE_VERSION} {settings}").as_bytes()) as u32;
    let preset: String =
        preset.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '-').take(40).collect();
    format!("{preset}-seed{seed}-{fingerprint:08x}")
}

/// The name of the file, in a run's folder, of the champion of a generation; the first is 1.
pub fn champion_file_name(generation: u32) -> String {
    format!("generation-{generation}.ron")
}

/// The champions of a run's folder with the numbers of their generations, the first generation first.
///
/// # Errors
/// The folder cannot be read, has no champion in it, or one that is damaged.
pub fn load_run(folder: &Path) -> Result<Vec<(u32, LoadedChampion)>, SaveError> {
    let mut generations = numbered(folder, "generation-")?;
    generations.sort_unstable();
    if generations.is_empty() {
        let missing = "no generation-1.ron or later in it; a run's folder is wanted";
        let source = std::io::Error::other(missing);
        return Err(SaveError::Unreadable { path: folder.to_owned(), source });
    }
    let load = |number| Ok((number, load_champion(&folder.join(champion_file_name(number)))?));
    generations.into_iter().map(load).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;

    #[test]
    fn a_folders_name_tells_runs_apart_and_stays_in_its_folder() {
        let name = |preset: &str, seed, population| {
            let mut settings = Settings::default();
            settings.evolution.population = population;
            run_name(&RunPlan { preset: preset.to_owned(), seed, settings })
        };
        let first = name("report", 1, 500);
        assert!(first.starts_with("report-seed1-"), "{first}");
        assert_eq!(first, name("report", 1, 500));
        assert_ne!(first, name("report", 2, 500));
        assert_ne!(first, name("report", 1, 501));
        let hostile = name("../../etc/x", 1, 500);
        assert!(hostile.starts_with("etcx-seed1"), "{hostile}");
    }
}
