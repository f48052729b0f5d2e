//! The study of POET, as RON: `poet-study.ron`.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_bytes, store_ron, text_of};
use crate::check::{Invalid, within};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::genome::StairsGenome;
use crate::schema::{check, is_default};
use crate::score::FITNESS_RANGE;

const KIND: &str = "snakes-and-stairs study of POET";
const FORMAT: u32 = 1;
/// Maximum size of a file that is read, in MiB.
const LARGEST_MIB: u64 = 16;
/// Maximum number of rounds of a run.
const MOST_ROUNDS: usize = 100_000;

/// A run of POET, with control runs on its hardest stairs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoetStudy {
    kind: String,
    format: u32,
    engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    processors: Processors,
    /// Fingerprint of the plan of the run of POET.
    pub plan: String,
    /// Seed of the run of POET.
    pub seed: u64,
    /// Number of rounds after which the run was measured.
    pub rounds: u32,
    /// Number of evaluations up to the measurement.
    pub evaluations: u64,
    /// Wall-clock time of the evaluations, in seconds.
    pub elapsed_s: f64,
    /// Number of stairs in the run.
    pub stairs: u32,
    /// Number of solved stairs.
    pub solved: u32,
    /// Number of new challenges solved so far (ANNECS), after each round.
    pub challenges: Vec<u32>,
    /// Hash over the generations of the run.
    pub run_hash: String,
    /// The hardest solved stairs of the run, the hardest first.
    pub hardest: Vec<HardStairs>,
    /// Control runs, in the order in which they finished.
    pub controls: Vec<ControlRun>,
}

/// A staircase that POET has solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HardStairs {
    /// Index of the staircase in the run.
    pub node: u32,
    /// Genes of the staircase.
    pub stairs: StairsGenome,
    /// Mean share of the way that the agents of all stairs of the run cover on this staircase.
    pub mean_share: f32,
    /// Number of perturbed trials in which the staircase's own agent covered the share that counts as a success.
    pub successes: u32,
    /// Number of trials that POET spent on the staircase and on all its ancestors.
    pub trials: u64,
}

/// A direct search for a snake that climbs a hard staircase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlRun {
    /// Index of the staircase in the run of POET.
    pub node: u32,
    /// Seed of the search.
    pub seed: u64,
    /// Number of evaluations of the search.
    pub evaluations: u64,
    /// Best share of the way. None if all individuals were disqualified.
    pub share: Option<f32>,
}

impl PoetStudy {
    /// Makes an empty study of the run with a plan's fingerprint and a seed.
    pub fn new(plan: String, seed: u64) -> Self {
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            plan,
            seed,
            rounds: 0,
            evaluations: 0,
            elapsed_s: 0.0,
            stairs: 0,
            solved: 0,
            challenges: Vec::new(),
            run_hash: String::new(),
            hardest: Vec::new(),
            controls: Vec::new(),
        }
    }

    fn check(&self) -> Result<(), Invalid> {
        Engine { version: self.engine, processors: self.processors }.check_this()?;
        within("elapsed_s", self.elapsed_s, 0.0..=1.0e9)?;
        within("challenges", self.challenges.len(), 0..=MOST_ROUNDS)?;
        within("hardest", self.hardest.len(), 0..=100)?;
        for hard in &self.hardest {
            check(&hard.stairs)?;
            within("mean_share", hard.mean_share, 0.0..=10.0)?;
        }
        within("controls", self.controls.len(), 0..=10_000)?;
        let mut controls = self.controls.iter();
        controls.try_for_each(|run| within("share", run.share.unwrap_or(0.0), FITNESS_RANGE))
    }
}

/// Reads a study of POET from its file.
///
/// # Errors
/// Fails if the file is unreadable, damaged, of another kind, format or engine, or has a value out of range.
pub fn load_poet_study(path: &Path) -> Result<PoetStudy, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::check(path, &text, KIND, FORMAT)?;
    let study: PoetStudy = parse(path, &text)?;
    study.check().map_err(SaveError::invalid(path))?;
    Ok(study)
}

/// Writes a study of POET atomically.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store_poet_study(path: &Path, study: &PoetStudy) -> Result<(), SaveError> {
    store_ron(path, study)
}
