//! The finished runs of a study, as RON: `body-study.ron`, `creature-study.ron`.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_bytes, store_ron, text_of};
use crate::check::{Invalid, name, within};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::schema::is_default;

const FORMAT: u32 = 1;

/// Maximum number of runs in a file; each takes about 1 kB.
pub const MAX_STUDY_RUNS: usize = 10_000;
/// Maximum size of a file that is read, in MiB.
const LARGEST_MIB: u64 = 64;

/// The measurements of a run of a study.
pub trait StudiedRun: Serialize + DeserializeOwned {
    /// What files of the study say that they are.
    const KIND: &'static str;

    /// Its seed.
    fn seed(&self) -> u64;

    /// Checks every value.
    ///
    /// # Errors
    /// The first that is not allowed.
    fn check(&self) -> Result<(), Invalid>;
}

/// The runs of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyRuns<R> {
    kind: String,
    format: u32,
    engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    processors: Processors,
    /// Fingerprint of the settings that all runs have in common; the study continues only with the same settings.
    pub settings: String,
    /// Maximum number of evaluations of each run.
    pub evaluations: u32,
    /// The finished runs, each with the name of its arm, in the order of arms and seeds.
    runs: Vec<(String, R)>,
}

impl<R: StudiedRun> StudyRuns<R> {
    /// A study without runs.
    pub fn new(settings: String, evaluations: u32) -> Self {
        Self {
            kind: R::KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            settings,
            evaluations,
            runs: Vec::new(),
        }
    }

    /// The runs of an arm, in the order of their seeds.
    pub fn of_arm(&self, arm: &str) -> Vec<&R> {
        self.runs.iter().filter(|(name, _)| name == arm).map(|(_, run)| run).collect()
    }

    /// Adds a run, in place of an earlier one of the same arm and seed.
    pub fn add(&mut self, arm: &str, run: R) {
        self.runs.retain(|(name, earlier)| name != arm || earlier.seed() != run.seed());
        self.runs.push((arm.to_owned(), run));
        self.runs.sort_by(|(a, run), (b, other)| a.cmp(b).then(run.seed().cmp(&other.seed())));
    }

    fn check(&self) -> Result<(), Invalid> {
        Engine { version: self.engine, processors: self.processors }.check_this()?;
        within("evaluations", self.evaluations, 1..=u32::MAX)?;
        within("runs", self.runs.len(), 0..=MAX_STUDY_RUNS)?;
        self.runs.iter().try_for_each(|(arm, run)| {
            name("arm", arm)?;
            run.check()
        })
    }
}

/// Reads the runs of a study.
///
/// # Errors
/// The file is unreadable, damaged, of another kind, format or engine, or has a value out of range.
pub fn load_study<R: StudiedRun>(path: &Path) -> Result<StudyRuns<R>, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::check(path, &text, R::KIND, FORMAT)?;
    let runs: StudyRuns<R> = parse(path, &text)?;
    runs.check().map_err(SaveError::invalid(path))?;
    Ok(runs)
}

/// Writes the runs of a study atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_study<R: StudiedRun>(path: &Path, runs: &StudyRuns<R>) -> Result<(), SaveError> {
    store_ron(path, runs)
}
