//! The result of a comparison of methods, as RON: `compare-*.ron`.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_bytes, store_ron, text_of};
use crate::ENGINE_VERSION;
use crate::check::{Invalid, within};
use crate::evolve::StrategyKind;
use crate::genome::ControllerKind;
use crate::score::{FITNESS_RANGE, Fitness};

const KIND: &str = "snakes-and-stairs comparison";
const FORMAT: u32 = 1;

/// The most runs of a comparison: each takes some 2 kB in its file.
pub const MOST_RUNS: usize = 10_000;
/// The largest file of a comparison that is read.
const LARGEST_MIB: u64 = 64;

/// Points of a learning curve: the budget is divided into as many equal parts.
pub const CURVE_POINTS: usize = 100;

/// Runs of several methods under equal budgets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    kind: String,
    format: u32,
    engine: u32,
    /// Name of the preset that all runs started from.
    pub preset: String,
    /// A hash over its settings: a comparison goes on only under the same.
    pub settings: String,
    /// Evaluations that each run could spend.
    pub evaluations: u32,
    /// What was rewarded.
    pub fitness: Fitness,
    /// The finished runs, in the order of strategies, controllers and seeds.
    pub runs: Vec<ComparedRun>,
}

/// One run of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComparedRun {
    /// The method.
    pub strategy: StrategyKind,
    /// What drove the joints.
    pub controller: ControllerKind,
    /// The seed.
    pub seed: u64,
    /// Evaluations that it spent.
    pub evaluations: u32,
    /// The best of the run; none if all agents were disqualified.
    pub best: Option<ComparedBest>,
    /// The number of the evaluation, counted from 1, whose agent was the first on the landing at its end.
    pub first_on_landing: Option<u32>,
    /// Mean fitness of the last generation.
    pub last_mean: Option<f64>,
    /// The best fitness so far after each hundredth of the budget.
    pub curve: Vec<Option<f32>>,
    /// Hash over the run.
    pub run_hash: String,
}

/// The best individual of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComparedBest {
    /// Its fitness.
    pub fitness: f32,
    /// Steps under its middle limb at the end.
    pub steps_climbed: u32,
    /// Energy per metre of progress, in J/m; none for who made none.
    pub energy_j_per_m: Option<f64>,
}

impl Comparison {
    /// A comparison without runs.
    pub fn new(preset: &str, settings: String, evaluations: u32, fitness: Fitness) -> Self {
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            preset: preset.to_owned(),
            settings,
            evaluations,
            fitness,
            runs: Vec::new(),
        }
    }

    /// Adds a run, in its place.
    pub fn add(&mut self, run: ComparedRun) {
        self.runs.push(run);
        let place = |run: &ComparedRun| {
            let strategy = StrategyKind::ALL.iter().position(|kind| *kind == run.strategy);
            let controller = ControllerKind::ALL.iter().position(|kind| *kind == run.controller);
            (strategy, controller, run.seed)
        };
        self.runs.sort_by_key(place);
    }

    fn check(&self) -> Result<(), Invalid> {
        within("engine", self.engine, ENGINE_VERSION..=ENGINE_VERSION)?;
        within("evaluations", self.evaluations, 1..=u32::MAX)?;
        within("runs", self.runs.len(), 0..=MOST_RUNS)?;
        for run in &self.runs {
            within("curve", run.curve.len(), CURVE_POINTS..=CURVE_POINTS)?;
            let values =
                run.curve.iter().flatten().chain(run.best.iter().map(|best| &best.fitness));
            values.into_iter().try_for_each(|&x| within("fitness", x, FITNESS_RANGE))?;
            within("last_mean", run.last_mean.unwrap_or(0.0), -1.0e15..=1.0e15)?;
            if let Some(energy) = run.best.and_then(|best| best.energy_j_per_m) {
                within("energy_j_per_m", energy, 0.0..=1.0e15)?;
            }
        }
        Ok(())
    }
}

/// Reads a comparison.
///
/// # Errors
/// The file is unreadable, damaged, of another kind or engine, or has a value out of range.
pub fn load_comparison(path: &Path) -> Result<Comparison, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::read(path, &text, KIND, FORMAT)?;
    let comparison: Comparison = parse(path, &text)?;
    let checked = comparison.check();
    checked.map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    Ok(comparison)
}

/// Writes a comparison, whole or not at all.
///
/// # Errors
/// The file cannot be written.
pub fn store_comparison(path: &Path, comparison: &Comparison) -> Result<(), SaveError> {
    store_ron(path, comparison)
}
