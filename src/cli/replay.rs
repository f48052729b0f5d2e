//! `snakes replay --no-render`: saved champions are checked against their records.

use std::io;
use std::path::{Path, PathBuf};

use super::error::CliError;
use super::output::print;
use crate::run;
use crate::run::headless::say;
use crate::save::LoadedChampion;
#[cfg(feature = "studio")]
use crate::save::load_champion;

/// Replays all files; the first that fails is the error.
pub fn replay(files: &[PathBuf], json: bool) -> Result<(), CliError> {
    let replay = |file: &PathBuf| {
        if files.len() > 1 && !json {
            print(&format!("{}\n", file.display()))?;
        }
        Ok(run::replay(file, json, &mut io::stdout().lock())?)
    };
    let done: Vec<Result<(), CliError>> = files.iter().map(replay).collect();
    done.into_iter().collect()
}

/// Whether a champion replays to its record; warns if it does not.
pub fn equals_record(file: &Path, loaded: &LoadedChampion) -> Result<bool, CliError> {
    let difference = run::difference_from_record(file, loaded)?;
    if let Some(difference) = &difference {
        let file = file.display();
        say(&format!("warning: {file}: does not replay to its record: {difference}"));
    }
    Ok(difference.is_none())
}

/// Saved champions, each with the name of its file.
#[cfg(feature = "studio")]
pub fn named_champions(files: &[PathBuf]) -> Result<Vec<(String, LoadedChampion)>, CliError> {
    let load = |file: &PathBuf| {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((name, load_champion(file)?))
    };
    files.iter().map(load).collect()
}
