//! `snakes replay --no-render`: compares saved champions with their records.

use std::io;
use std::path::{Path, PathBuf};

use super::error::CliError;
use super::output::print_line;
use snakes_core::check::printable;
use snakes_core::save::LoadedChampion;
#[cfg(feature = "studio")]
use snakes_core::save::load_champion;
use snakes_lab::run;
use snakes_lab::run::headless::say;

/// Replays all files. Returns the error of the first that fails.
pub fn replay(files: &[PathBuf], json: bool) -> Result<(), CliError> {
    let replay = |file: &PathBuf| {
        if files.len() > 1 && !json {
            print_line(&file.display().to_string())?;
        }
        Ok(run::replay(file, json, &mut io::stdout().lock())?)
    };
    let done: Vec<Result<(), CliError>> = files.iter().map(replay).collect();
    done.into_iter().collect()
}

/// Returns whether a champion replays to its record. Warns the user if it does not.
pub fn equals_record(file: &Path, loaded: &LoadedChampion) -> Result<bool, CliError> {
    let difference = run::difference_from_record(file, loaded)?;
    if let Some(difference) = &difference {
        let file = file.display();
        say(&format!("warning: {file}: does not replay to its record: {difference}"));
    }
    Ok(difference.is_none())
}

/// Returns the name of a champion for people, which is the stem of its file.
pub fn name_of(file: &Path) -> String {
    printable(&file.file_stem().unwrap_or_default().to_string_lossy()).into_owned()
}

/// Loads a saved champion with its name.
#[cfg(feature = "studio")]
fn named_champion(file: &Path) -> Result<(String, LoadedChampion), CliError> {
    Ok((name_of(file), load_champion(file)?))
}

/// Loads saved champions that are to be drawn, with their names. A champion of another engine is drawn from its recording, if it
/// has one. All others are compared with their records.
#[cfg(feature = "studio")]
pub fn champions_to_draw(files: &[PathBuf]) -> Result<Vec<(String, LoadedChampion)>, CliError> {
    let named = files.iter().map(|file| named_champion(file));
    let champions = named.collect::<Result<Vec<_>, _>>()?;
    for (file, (_, loaded)) in files.iter().zip(&champions) {
        if loaded.is_of_this_engine() || loaded.recording.is_none() {
            equals_record(file, loaded)?;
        }
    }
    Ok(champions)
}

/// Returns the duration of the longest trial of some champions, in s.
#[cfg(feature = "studio")]
pub fn longest_s<'c>(champions: impl IntoIterator<Item = &'c (String, LoadedChampion)>) -> f64 {
    let trials = champions.into_iter().map(|(_, loaded)| &loaded.champion.trial);
    let lengths_s =
        trials.map(|trial| f64::from(trial.steps()) / f64::from(trial.physics.steps_per_s));
    lengths_s.fold(0.0, f64::max)
}

/// Champions and problems with which the window opens.
#[cfg(feature = "studio")]
pub struct Opened {
    /// Champions, each with the name of its file.
    pub champions: Vec<(String, LoadedChampion)>,
    /// Problems with files that could not be read, each as one line.
    pub problems: Vec<String>,
}

/// Loads the champions with which the window opens. After a start from the desktop, where printed errors are not seen, a file that
/// cannot be read becomes a problem for the window.
#[cfg(feature = "studio")]
pub fn opened(files: &[PathBuf], is_from_desktop: bool) -> Result<Opened, CliError> {
    let mut opened = Opened { champions: Vec::new(), problems: Vec::new() };
    for file in files {
        match named_champion(file) {
            Ok(champion) => opened.champions.push(champion),
            Err(error) if is_from_desktop => opened.problems.push(error.to_string()),
            Err(error) => return Err(error),
        }
    }
    Ok(opened)
}

#[cfg(test)]
mod tests {
    #[cfg(feature = "studio")]
    #[test]
    fn from_the_desktop_a_damaged_champion_is_a_problem_beside_the_others() {
        use super::*;
        let folder = tempfile::tempdir().expect("a folder");
        let damaged = folder.path().join("damaged.ron");
        std::fs::write(&damaged, "(kind: \"snakes-and-stairs champion\"").expect("written");
        let good = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/saves/climber.ron"));
        let files = [damaged, good];
        assert!(opened(&files, false).is_err());
        let Opened { champions, problems } = opened(&files, true).expect("opened");
        assert_eq!(champions.len(), 1);
        assert_eq!(champions[0].0, "climber");
        assert!(problems[0].contains("damaged.ron") && problems.len() == 1, "{problems:?}");
    }
}
