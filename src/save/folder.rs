//! Where saves are.

use std::path::{Path, PathBuf};

use directories::ProjectDirs;
use xxhash_rust::xxh3::xxh3_64;

use super::SaveError;
use super::files::prepare_folder;
use crate::ENGINE_VERSION;
use crate::evolve::{Origin, Settings};

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

/// The file name of a run's champion: it names the preset, the seed, the generation, and in eight hex
/// digits everything else that decides the bits. So two files of one name hold the same champion, and
/// no run overwrites the champion of another.
pub fn champion_file_name(origin: &Origin, settings: &Settings) -> String {
    let settings = ron::to_string(settings).unwrap_or_default();
    let fingerprint = xxh3_64(format!("{ENGINE_VERSION} {settings}").as_bytes()) as u32;
    let preset: String =
        origin.preset.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '-').take(40).collect();
    format!("{preset}-seed{}-{fingerprint:08x}-generation{}.ron", origin.seed, origin.generation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_name_tells_runs_apart_and_stays_in_its_folder() {
        let origin = |preset: &str, seed| Origin {
            preset: preset.to_owned(),
            seed,
            generation: 6,
            individual: 3,
        };
        let settings = Settings::default();
        let mut other = settings.clone();
        other.evolution.population += 1;
        let name = champion_file_name(&origin("report", 1), &settings);
        assert!(name.starts_with("report-seed1-") && name.ends_with("-generation6.ron"), "{name}");
        assert_eq!(name, champion_file_name(&origin("report", 1), &settings));
        assert_ne!(name, champion_file_name(&origin("report", 2), &settings));
        assert_ne!(name, champion_file_name(&origin("report", 1), &other));
        let hostile = champion_file_name(&origin("../../etc/x", 1), &settings);
        assert!(hostile.starts_with("etcx-seed1"), "{hostile}");
    }
}
