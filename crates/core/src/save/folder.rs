//! The folder of saves, and the runs in it.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use directories::ProjectDirs;

use super::change::load_changed_plan;
use super::files::{modified, numbered, refuse_link};
use super::library::{is_free, taken};
use super::notes::{EntryNotes, notes_in_run};
use super::plan::is_run;
use super::record::{count_records, read_records};
use super::run_name::run_name;
use super::whole_file::{prepare_folder, write_new};
use super::{LoadedChampion, SaveError, load_champion};
use crate::evolve::RunPlan;

/// Folder of saved champions and runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavesFolder(PathBuf);

impl Default for SavesFolder {
    /// Returns the folder that is used if the user names none: see [`Self::find`].
    fn default() -> Self {
        Self::find(None)
    }
}

impl SavesFolder {
    /// Returns the folder that the user named; otherwise `saves/` in the working directory, if it exists; otherwise the platform's data
    /// folder.
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
        // A relative HOME would lead to another folder from each working directory.
        let data = data.filter(|data| data.data_dir().is_absolute());
        Self(data.map_or(here, |data| data.data_dir().join("saves")))
    }

    /// Returns the folder of screenshots within this folder.
    #[must_use]
    pub fn pictures(&self) -> Self {
        Self(self.0.join("pictures"))
    }

    /// Returns the folder of exported files within this folder.
    #[must_use]
    pub fn exports(&self) -> Self {
        Self(self.0.join("exports"))
    }

    /// Adds a file under the first free name of the form `NAME-NUMBER.EXTENSION`, and makes the folder if it is missing. Returns the
    /// path. Replaces no file, not even one that gets the name while this one is written.
    ///
    /// # Errors
    /// The folder cannot be made, or the file cannot be written.
    pub fn add_file(
        &self,
        name: &str,
        extension: &str,
        contents: &[u8],
    ) -> Result<PathBuf, SaveError> {
        self.prepare()?;
        let path = |number: u32| self.0.join(format!("{name}-{number}.{extension}"));
        for path in (1..=u32::MAX).map(path).filter(|path| is_free(path, false)) {
            match write_new(&path, contents) {
                Err(SaveError::Unwritable { source, .. })
                    if source.kind() == ErrorKind::AlreadyExists => {}
                written => return written.map(|()| path),
            }
        }
        Err(taken(&path(u32::MAX)))
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Returns the folder of a run within this folder.
    pub fn of_run(&self, plan: &RunPlan) -> PathBuf {
        self.0.join(run_name(plan))
    }

    /// Returns the runs in this folder that this engine can read, in the order of their folders' names.
    pub fn runs(&self) -> Vec<RunSummary> {
        self.all_runs().into_iter().filter_map(|(_, run)| run.ok()).collect()
    }

    /// Returns the folders of all runs in this folder, in the order of their names, each with the run or with the reason why this engine
    /// cannot read it.
    pub fn all_runs(&self) -> Vec<(PathBuf, Result<RunSummary, SaveError>)> {
        let Ok(entries) = fs::read_dir(&self.0) else { return Vec::new() };
        let folders = entries.flatten().filter(|entry| entry.file_type().is_ok_and(|t| t.is_dir()));
        // Names of incomplete and deleted runs begin with a dot.
        let folders =
            folders.filter(|entry| !entry.file_name().as_encoded_bytes().starts_with(b"."));
        let folders = folders.map(|entry| entry.path()).filter(|folder| is_run(folder));
        let mut runs: Vec<_> = folders.map(|of| (of.clone(), RunSummary::read(of))).collect();
        runs.sort_by(|(a, _), (b, _)| a.cmp(b));
        runs
    }

    /// Checks that files can be written into the folder, and creates it if it does not exist.
    pub fn prepare(&self) -> Result<(), SaveError> {
        prepare_folder(&self.0)
    }
}

/// Returns the path of a file or folder to be written within a run's folder. Links are not followed, because a run's folder may come from
/// anyone.
///
/// # Errors
/// Fails if the path is that of a link.
pub fn within_run(run: &Path, name: &str) -> Result<PathBuf, SaveError> {
    let path = run.join(name);
    if path.is_symlink() {
        let source = std::io::Error::other("it is a link");
        return Err(SaveError::Unwritable { path, source });
    }
    Ok(path)
}

/// A run in a folder of saves.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSummary {
    /// Folder of the run.
    pub folder: PathBuf,
    /// Plan of the run, after all its changes.
    pub plan: RunPlan,
    /// Number of finished generations.
    pub finished: u32,
    /// Name that the user gave the run. None: the run has no name.
    pub name: Option<String>,
    /// Time of the last change: see [`saved_at`].
    pub saved_at: Duration,
    /// Whether the run can continue with another generation.
    is_stopped: bool,
}

impl RunSummary {
    fn read(folder: PathBuf) -> Result<Self, SaveError> {
        let plan = load_changed_plan(&folder)?;
        let finished = count_records(&folder)?;
        let evolution = &plan.settings.evolution;
        let mut is_stopped = finished < evolution.generations;
        if is_stopped && finished > 0 && evolution.strategy.info().is_budget_driven {
            is_stopped = !plan.has_ended(&read_records(&folder, &plan)?);
        }
        // A run whose notes cannot be read can still be resumed.
        let notes = EntryNotes::load(&notes_in_run(&folder)).unwrap_or_default();
        let name = notes.own_name().map(str::to_owned);
        let saved_at = saved_at(&folder);
        Ok(Self { folder, plan, finished, name, saved_at, is_stopped })
    }

    /// Returns whether generations are left to evolve.
    pub fn is_stopped(&self) -> bool {
        self.is_stopped
    }

    /// Describes the finished generations in words: "3 of 40 generations".
    pub fn generations_in_words(&self) -> String {
        self.plan.generations_in_words(self.finished, !self.is_stopped)
    }
}

/// Returns the time of the last change of the log in a run's folder since 1970; zero if it is unknown.
pub fn saved_at(folder: &Path) -> Duration {
    fs::metadata(folder.join("log.jsonl")).map_or(Duration::ZERO, |log| modified(&log))
}

/// Returns the name of the file of a generation's champion; the first generation is 1.
pub fn champion_file_name(generation: u32) -> String {
    format!("generation-{generation}.ron")
}

/// Reads the champions in a run's folder with the numbers of their generations, in order.
///
/// # Errors
/// Fails if the folder cannot be read, has no champion, or has a damaged champion.
pub fn load_run(folder: &Path) -> Result<Vec<(u32, LoadedChampion)>, SaveError> {
    let mut generations = numbered(folder, "generation-")?;
    generations.sort_unstable();
    if generations.is_empty() {
        let missing = "it contains no generation-1.ron or later; give a run's folder";
        let source = std::io::Error::other(missing);
        return Err(SaveError::Unreadable { path: folder.to_owned(), source });
    }
    let load = |number| Ok((number, load_generation(folder, number)?));
    generations.into_iter().map(load).collect()
}

/// Reads the champion of one generation from a run's folder; the first generation is 1.
///
/// # Errors
/// Fails if the generation has no champion, or if the champion is damaged.
pub fn load_generation(folder: &Path, generation: u32) -> Result<LoadedChampion, SaveError> {
    let path = folder.join(champion_file_name(generation));
    refuse_link(&path).map_err(SaveError::unreadable(&path))?;
    load_champion(&path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f5_a_damaged_run_is_listed_with_its_reason() {
        use crate::save::library::fixtures::{run_in, saves};
        let (_folder, saves) = saves();
        let [good, bad] = [1, 2].map(|seed| run_in(&saves, seed).path().expect("one").to_owned());
        for (file, reason) in [
            ("changes.jsonl", "changes.jsonl: damaged or incomplete at line 1"),
            ("run.ron", "run.ron: damaged or incomplete at line 1"),
        ] {
            fs::write(bad.join(file), "(\n").expect("written");
            let runs = saves.all_runs();
            let reasons: Vec<String> =
                runs.iter().filter_map(|(_, run)| Some(run.as_ref().err()?.to_string())).collect();
            assert!(reasons.len() == 1 && reasons[0].contains(reason), "{reasons:?}");
            let folders: Vec<&PathBuf> = runs.iter().map(|(folder, _)| folder).collect();
            assert!(folders.len() == 2 && folders.contains(&&bad), "{folders:?}");
            let readable: Vec<PathBuf> = saves.runs().into_iter().map(|run| run.folder).collect();
            assert_eq!(readable, std::slice::from_ref(&good));
        }
    }

    #[test]
    fn files_that_are_added_at_the_same_time_neither_replace_each_other_nor_inherit_notes() {
        use std::collections::BTreeSet;
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        fs::write(folder.path().join("a-3.about"), "notes of a removed file").expect("written");
        let add = |text: String| saves.add_file("a", "ron", text.as_bytes()).expect("written");
        let mut paths: Vec<PathBuf> = std::thread::scope(|scope| {
            let added: Vec<_> = (0..8).map(|n| scope.spawn(move || add(n.to_string()))).collect();
            added.into_iter().map(|one| one.join().expect("added")).collect()
        });
        paths.sort();
        assert_eq!(
            paths,
            [1, 2, 4, 5, 6, 7, 8, 9].map(|n| folder.path().join(format!("a-{n}.ron")))
        );
        let texts = paths.iter().map(|path| fs::read_to_string(path).expect("there"));
        assert_eq!(texts.collect::<BTreeSet<_>>(), (0..8).map(|n| n.to_string()).collect());
    }

    #[cfg(unix)]
    #[test]
    fn links_in_a_runs_folder_are_not_followed() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a folder");
        let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/../../saves/first-climber.ron");
        symlink(shipped, folder.path().join("generation-1.ron")).expect("linked");
        let error = load_run(folder.path()).expect_err("refused").to_string();
        assert!(error.contains("generation-1.ron: cannot be read: it is a link"), "{error}");
        symlink("/tmp", folder.path().join("figures")).expect("linked");
        let error = within_run(folder.path(), "figures").expect_err("refused");
        assert!(error.to_string().contains("figures: cannot be written: it is a link"), "{error}");
        assert!(within_run(folder.path(), "other").is_ok());
    }
}
