//! The finished runs of `snakes body-study`, as RON: `body-study.ron`.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_bytes, store_ron, text_of};
use crate::check::{Invalid, name, within};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::schema::is_default;
use crate::score::FITNESS_RANGE;

const KIND: &str = "snakes-and-stairs body study";
const FORMAT: u32 = 1;

/// Maximum number of runs in the file; each takes about 1 kB.
pub const MAX_BODY_STUDY_RUNS: usize = 10_000;
/// Maximum size of a file that is read, in MiB.
const LARGEST_MIB: u64 = 64;
/// Maximum number of changed snakes of a run.
const MOST_CHANGES: usize = 1000;

/// The runs of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyStudyRuns {
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
    runs: Vec<(String, BodyStudyRun)>,
}

/// The measurements of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyStudyRun {
    /// The seed.
    pub seed: u64,
    /// Number of evaluations that its generations spent.
    pub evaluations: u32,
    /// Best share; none if all were disqualified.
    pub share: Option<f32>,
    /// Number of blocks of the best.
    pub blocks: u32,
    /// Changes of structure in the line of descent of the best.
    pub changes: u32,
    /// Those of them in the second half of the generations.
    pub late_changes: u32,
    /// Filled cells of an archive of all that was evaluated.
    pub cells: u32,
    /// Quality-diversity score of this archive.
    pub qd_score: f64,
    /// Changes of the share of the best of the last generation by a split at a random place.
    pub split_changes: Vec<f32>,
    /// The same by an insertion.
    pub insertion_changes: Vec<f32>,
    /// Hash over the run.
    pub run_hash: String,
}

impl BodyStudyRuns {
    /// A study without runs.
    pub fn new(settings: String, evaluations: u32) -> Self {
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            settings,
            evaluations,
            runs: Vec::new(),
        }
    }

    /// The runs of an arm, in the order of their seeds.
    pub fn of_arm(&self, arm: &str) -> Vec<&BodyStudyRun> {
        self.runs.iter().filter(|(name, _)| name == arm).map(|(_, run)| run).collect()
    }

    /// Adds a run, in place of an earlier one of the same arm and seed.
    pub fn add(&mut self, arm: &str, run: BodyStudyRun) {
        self.runs.retain(|(name, earlier)| name != arm || earlier.seed != run.seed);
        self.runs.push((arm.to_owned(), run));
        self.runs.sort_by(|(a, run), (b, other)| a.cmp(b).then(run.seed.cmp(&other.seed)));
    }

    fn check(&self) -> Result<(), Invalid> {
        Engine { version: self.engine, processors: self.processors }.check_this()?;
        within("evaluations", self.evaluations, 1..=u32::MAX)?;
        within("runs", self.runs.len(), 0..=MAX_BODY_STUDY_RUNS)?;
        for (arm, run) in &self.runs {
            name("arm", arm)?;
            within("share", run.share.unwrap_or(0.0), FITNESS_RANGE)?;
            within("qd_score", run.qd_score, 0.0..=1.0e15)?;
            for changes in [&run.split_changes, &run.insertion_changes] {
                within("changes", changes.len(), 0..=MOST_CHANGES)?;
                changes.iter().try_for_each(|&change| within("change", change, FITNESS_RANGE))?;
            }
        }
        Ok(())
    }
}

/// Reads the runs of a study.
///
/// # Errors
/// The file is unreadable, damaged, of another kind, format or engine, or has a value out of range.
pub fn load_body_study(path: &Path) -> Result<BodyStudyRuns, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::check(path, &text, KIND, FORMAT)?;
    let runs: BodyStudyRuns = parse(path, &text)?;
    runs.check().map_err(SaveError::invalid(path))?;
    Ok(runs)
}

/// Writes the runs of a study atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_body_study(path: &Path, runs: &BodyStudyRuns) -> Result<(), SaveError> {
    store_ron(path, runs)
}
