//! `snakes replay --no-render`: saved champions are checked against their records.

use std::io;
use std::path::PathBuf;

use super::error::CliError;
use super::output::print;
use crate::run;
#[cfg(feature = "studio")]
use crate::save::{LoadedChampion, load_champion};

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

/// Saved champions, each with the name of its file.
#[cfg(feature = "studio")]
pub fn named_champions(files: &[PathBuf]) -> Result<Vec<(String, LoadedChampion)>, CliError> {
    let load = |file: &PathBuf| {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((name, load_champion(file)?))
    };
    files.iter().map(load).collect()
}
