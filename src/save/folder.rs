//! Where saves are.

use std::fs;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;
use xxhash_rust::xxh3::xxh3_64;

use super::change::read_changes;
use super::files::{numbered, prepare_folder, refuse_link};
use super::plan::load_plan;
use super::record::{count_records, read_records};
use super::{GenerationRecord, LoadedChampion, SaveError, load_champion};
use crate::ENGINE_VERSION;
use crate::evolve::{RunPlan, SettingChange, StrategyKind};

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

    /// A folder within a run's, which may be anybody's: it must not be a link to elsewhere.
    ///
    /// # Errors
    /// It is one.
    pub fn within_run(run: &Path, name: &str) -> Result<Self, SaveError> {
        let path = run.join(name);
        if path.is_symlink() {
            let source = std::io::Error::other("it is a link");
            return Err(SaveError::Unwritable { path, source });
        }
        Ok(Self(path))
    }

    /// The folder in it for pictures of the stage.
    #[must_use]
    pub fn pictures(&self) -> Self {
        Self(self.0.join("pictures"))
    }

    /// The folder in it for charts that were written as files.
    #[must_use]
    pub fn exports(&self) -> Self {
        Self(self.0.join("exports"))
    }

    /// A path in it that is not taken yet: the name and the next number.
    pub fn free_name(&self, name: &str, extension: &str) -> PathBuf {
        let path = |number: u32| self.0.join(format!("{name}-{number}.{extension}"));
        let mut free = (1..=u32::MAX).map(path).filter(|path| path.symlink_metadata().is_err());
        free.next().unwrap_or_else(|| path(0))
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
            let begun = load_plan(&folder).ok()?;
            let changes = read_changes(&folder, &begun).ok()?;
            let plan = begun.in_generation(u32::MAX, &changes).ok()?;
            let finished = count_records(&folder).ok()?;
            let evolution = &plan.settings.evolution;
            let mut is_stopped = finished < evolution.generations;
            if is_stopped && finished > 0 && evolution.strategy == StrategyKind::CmaEs {
                is_stopped = goes_on(&plan, &read_records(&folder, &plan).ok()?);
            }
            Some(RunSummary { folder, plan, finished, is_stopped })
        };
        folders.into_iter().filter_map(summary).collect()
    }

    /// Makes sure that files can be written into it, creating it if need be.
    pub fn prepare(&self) -> Result<(), SaveError> {
        prepare_folder(&self.0)
    }
}

/// Whether a run with these generations behind it has evaluations left for another.
pub fn goes_on(plan: &RunPlan, records: &[GenerationRecord]) -> bool {
    let evolution = &plan.settings.evolution;
    if evolution.strategy == StrategyKind::CmaEs && !records.is_empty() {
        // Restarts make larger generations, which may use the budget up before.
        let spent: u64 = records.iter().map(|record| u64::from(record.evaluations)).sum();
        let next = records.last().map_or(0, |last| u64::from(last.evaluations));
        if spent + next > plan.budget() {
            return false;
        }
    }
    (records.len() as u64) < u64::from(evolution.generations)
}

/// A run that is in a folder of saves.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSummary {
    /// Its folder.
    pub folder: PathBuf,
    /// What run it is, after all its changes.
    pub plan: RunPlan,
    /// How many generations are finished.
    pub finished: u32,
    /// Whether there are evaluations left for another generation.
    is_stopped: bool,
}

impl RunSummary {
    /// Whether there are generations left to evolve.
    pub fn is_stopped(&self) -> bool {
        self.is_stopped
    }
}

/// The name of a run's folder: it names the preset, the seed, and in eight hex digits everything else
/// that decides the bits. So two folders of one name hold the same run, and no run overwrites another.
pub fn run_name(plan: &RunPlan) -> String {
    let plain = plan.preset.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '-');
    let preset: String = plain.take(40).collect();
    format!("{preset}-seed{}-{}", plan.seed, settings_fingerprint(plan))
}

/// Eight hexadecimal digits that stand for a plan's settings, its founder and the engine.
pub fn settings_fingerprint(plan: &RunPlan) -> String {
    let settings = ron::to_string(&plan.settings).unwrap_or_default();
    let founder = plan.founder.as_ref().map(|founder| {
        let genome = founder.genome();
        format!(" from {} {:016x}", genome.controller.kind(), genome.hash())
    });
    let text = format!("{ENGINE_VERSION} {settings}{}", founder.unwrap_or_default());
    format!("{:08x}", xxh3_64(text.as_bytes()) as u32)
}

/// Sixteen hexadecimal digits that stand for all that decides a run's bits, up to the generations of its latest
/// change.
pub fn fingerprint(plan: &RunPlan) -> String {
    let mut text = format!("{} {}", plan.seed, settings_fingerprint(plan));
    for SettingChange { generation, field, value } in plan.changes.made() {
        text += &format!(" {generation} {field} {value:?}");
    }
    format!("{:016x}", xxh3_64(text.as_bytes()))
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
    let load = |number| Ok((number, load_generation(folder, number)?));
    generations.into_iter().map(load).collect()
}

/// The champion of a generation of a run's folder; the first generation is 1.
///
/// # Errors
/// It has none, or one that is damaged.
pub fn load_generation(folder: &Path, generation: u32) -> Result<LoadedChampion, SaveError> {
    let path = folder.join(champion_file_name(generation));
    refuse_link(&path).map_err(|source| SaveError::Unreadable { path: path.clone(), source })?;
    load_champion(&path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;

    #[cfg(unix)]
    #[test]
    fn no_link_in_a_runs_folder_is_followed() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a folder");
        let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/first-climber.ron");
        symlink(shipped, folder.path().join("generation-1.ron")).expect("linked");
        let error = load_run(folder.path()).expect_err("refused").to_string();
        assert!(error.contains("generation-1.ron: cannot be read: it is a link"), "{error}");
        symlink("/tmp", folder.path().join("figures")).expect("linked");
        let error = SavesFolder::within_run(folder.path(), "figures").expect_err("refused");
        assert!(error.to_string().contains("figures: cannot be written: it is a link"), "{error}");
        assert!(SavesFolder::within_run(folder.path(), "other").is_ok());
    }

    #[test]
    fn a_folders_name_tells_runs_apart_and_stays_in_its_folder() {
        let name = |preset: &str, seed, population| {
            let mut settings = Settings::default();
            settings.evolution.population = population;
            run_name(&RunPlan::new(preset, seed, settings))
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
