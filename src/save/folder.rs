//! Where saves are.

use std::fs;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;
use xxhash_rust::xxh3::xxh3_64;

use super::files::prepare_folder;
use super::{LoadedChampion, SaveError, load_champion};
use crate::ENGINE_VERSION;
use crate::evolve::Settings;

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

    /// Makes sure that files can be written into it, creating it if need be.
    pub fn prepare(&self) -> Result<(), SaveError> {
        prepare_folder(&self.0)
    }
}

/// The name of a run's folder: it names the preset, the seed, and in eight hex digits everything else
/// that decides the bits. So two folders of one name hold the same run, and no run overwrites another.
pub fn run_name(preset: &str, seed: u64, settings: &Settings) -> String {
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
    let unreadable = |source| SaveError::Unreadable { path: folder.to_owned(), source };
    let mut generations = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let name = entry.map_err(unreadable)?.file_name();
        let number = name.to_str().and_then(|name| {
            let digits = name.strip_prefix("generation-")?.strip_suffix(".ron")?;
            let number = digits.parse::<u32>().ok()?;
            // Not a copy that a person named `generation-01.ron`.
            (champion_file_name(number) == name).then_some(number)
        });
        generations.extend(number);
    }
    generations.sort_unstable();
    if generations.is_empty() {
        let missing = "no generation-1.ron or later in it; a run's folder is wanted";
        return Err(unreadable(std::io::Error::other(missing)));
    }
    let load = |number| Ok((number, load_champion(&folder.join(champion_file_name(number)))?));
    generations.into_iter().map(load).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folders_name_tells_runs_apart_and_stays_in_its_folder() {
        let settings = Settings::default();
        let mut other = settings.clone();
        other.evolution.population += 1;
        let name = run_name("report", 1, &settings);
        assert!(name.starts_with("report-seed1-"), "{name}");
        assert_eq!(name, run_name("report", 1, &settings));
        assert_ne!(name, run_name("report", 2, &settings));
        assert_ne!(name, run_name("report", 1, &other));
        let hostile = run_name("../../etc/x", 1, &settings);
        assert!(hostile.starts_with("etcx-seed1"), "{hostile}");
    }
}
