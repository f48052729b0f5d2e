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

/// A run of POET, and the control runs on its hardest stairs.
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
    /// Its seed.
    pub seed: u64,
    /// Rounds after which it was measured.
    pub rounds: u32,
    /// Evaluations up to there.
    pub evaluations: u64,
    /// Wall-clock time of these, in seconds.
    pub elapsed_s: f64,
    /// Number of stairs.
    pub stairs: u32,
    /// Number of solved stairs.
    pub solved: u32,
    /// After each round, the number of new challenges that were solved (ANNECS).
    pub challenges: Vec<u32>,
    /// Hash over its generations.
    pub run_hash: String,
    /// The hardest of its solved stairs, the hardest first.
    pub hardest: Vec<HardStairs>,
    /// The control runs, in the order in which they were finished.
    pub controls: Vec<ControlRun>,
}

/// Stairs that POET has solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HardStairs {
    /// Their index in the run.
    pub node: u32,
    /// The stairs.
    pub stairs: StairsGenome,
    /// Mean share of the way that the agents of all stairs of the run cover on them.
    pub mean_share: f32,
    /// Perturbed trials in which their own agent covered the share that counts as a success.
    pub successes: u32,
    /// Trials that POET spent on them and on all their ancestors.
    pub trials: u64,
}

/// A direct search on hard stairs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlRun {
    /// The index of the stairs in the run of POET.
    pub node: u32,
    /// Its seed.
    pub seed: u64,
    /// Evaluations that it spent.
    pub evaluations: u64,
    /// Its best share; none if all were disqualified.
    pub share: Option<f32>,
}

impl PoetStudy {
    /// The study of a run of which nothing is known yet.
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

/// Reads a study.
///
/// # Errors
/// The file is unreadable, damaged, of another kind, format or engine, or has a value out of range.
pub fn load_poet_study(path: &Path) -> Result<PoetStudy, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::check(path, &text, KIND, FORMAT)?;
    let study: PoetStudy = parse(path, &text)?;
    study.check().map_err(SaveError::invalid(path))?;
    Ok(study)
}

/// Writes a study atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_poet_study(path: &Path, study: &PoetStudy) -> Result<(), SaveError> {
    store_ron(path, study)
}
