//! The result of `snakes compare`, as RON: `compare-*.ron`.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_bytes, store_ron, text_of};
use crate::check::{Invalid, within};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::evolve::StrategyKind;
use crate::genome::ControllerKind;
use crate::schema::is_default;
use crate::score::{FITNESS_RANGE, Fitness};

const KIND: &str = "snakes-and-stairs comparison";
const FORMAT: u32 = 1;

/// Maximum number of runs of a comparison; each takes about 2 kB in the file.
pub const MAX_COMPARED_RUNS: usize = 10_000;
/// Maximum size of a comparison's file that is read, in MiB.
const LARGEST_MIB: u64 = 64;

/// Number of points of a learning curve: the budget is divided into this number of equal parts.
pub const CURVE_POINTS: usize = 100;

/// Runs of several strategies and controllers under equal budgets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    kind: String,
    format: u32,
    engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    processors: Processors,
    /// Name of the preset of all runs.
    pub preset: String,
    /// Fingerprint of its settings; a comparison continues only with the same settings.
    pub settings: String,
    /// Maximum number of evaluations of each run.
    pub evaluations: u32,
    /// The fitness that was maximised.
    pub fitness: Fitness,
    /// The finished runs, in the order of strategies, controllers and seeds.
    pub runs: Vec<ComparedRun>,
}

/// One run of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComparedRun {
    /// The search strategy.
    pub strategy: StrategyKind,
    /// The controller of the joints.
    pub controller: ControllerKind,
    /// The seed.
    pub seed: u64,
    /// Number of evaluations that it spent.
    pub evaluations: u32,
    /// The best individual; none if all were disqualified.
    pub best: Option<ComparedBest>,
    /// The number of the first evaluation, counted from 1, that ended on the landing.
    pub first_on_landing: Option<u32>,
    /// Mean fitness of the last generation.
    pub last_mean: Option<f64>,
    /// Best fitness so far after each hundredth of the budget.
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
    /// Steps that its middle limb had climbed at the end.
    pub steps_climbed: u32,
    /// Energy per metre of progress, in J/m; none without progress.
    pub energy_j_per_m: Option<f64>,
    /// Energy per weight and way; none without a way. Engine 2 did not measure it.
    #[serde(default)]
    pub cost_of_transport: Option<f32>,
    /// Share of the energy that lifted the snake; none without energy. Engine 2 did not measure it.
    #[serde(default)]
    pub climbing_efficiency: Option<f32>,
}

impl Comparison {
    /// A comparison without runs.
    pub fn new(preset: &str, settings: String, evaluations: u32, fitness: Fitness) -> Self {
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            preset: preset.to_owned(),
            settings,
            evaluations,
            fitness,
            runs: Vec::new(),
        }
    }

    /// Inserts a run in the order of strategy, controller and seed.
    pub fn add(&mut self, run: ComparedRun) {
        self.runs.push(run);
        let position = |run: &ComparedRun| {
            let strategy = StrategyKind::ALL.iter().position(|kind| *kind == run.strategy);
            let controller = ControllerKind::ALL.iter().position(|kind| *kind == run.controller);
            (strategy, controller, run.seed)
        };
        self.runs.sort_by_key(position);
    }

    fn check(&self) -> Result<(), Invalid> {
        Engine { version: self.engine, processors: self.processors }.check_this()?;
        within("evaluations", self.evaluations, 1..=u32::MAX)?;
        within("runs", self.runs.len(), 0..=MAX_COMPARED_RUNS)?;
        for run in &self.runs {
            within("curve", run.curve.len(), CURVE_POINTS..=CURVE_POINTS)?;
            let values =
                run.curve.iter().flatten().chain(run.best.iter().map(|best| &best.fitness));
            values.into_iter().try_for_each(|&x| within("fitness", x, FITNESS_RANGE))?;
            within("last_mean", run.last_mean.unwrap_or(0.0), -1.0e15..=1.0e15)?;
            if let Some(energy) = run.best.and_then(|best| best.energy_j_per_m) {
                within("energy_j_per_m", energy, 0.0..=1.0e15)?;
            }
            let cost = run.best.and_then(|best| best.cost_of_transport);
            within("cost_of_transport", cost.unwrap_or(0.0), 0.0..=1.0e15)?;
            let efficiency = run.best.and_then(|best| best.climbing_efficiency);
            within("climbing_efficiency", efficiency.unwrap_or(0.0), 0.0..=1.0e15)?;
        }
        Ok(())
    }
}

/// Reads a comparison.
///
/// # Errors
/// The file is unreadable, damaged, of another kind, format or engine, or has a value out of range.
pub fn load_comparison(path: &Path) -> Result<Comparison, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::check(path, &text, KIND, FORMAT)?;
    let comparison: Comparison = parse(path, &text)?;
    comparison.check().map_err(SaveError::invalid(path))?;
    Ok(comparison)
}

/// Writes a comparison atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_comparison(path: &Path, comparison: &Comparison) -> Result<(), SaveError> {
    store_ron(path, comparison)
}
