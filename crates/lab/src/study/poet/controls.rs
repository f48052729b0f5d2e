//! Direct searches on the hardest stairs, as a control of POET.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use crate::run::Evaluator;
use crate::run::Experiment;
use crate::run::headless::HeadlessError;
use crate::run::whole_runs;
use crate::run::{Cancelled, RunControl};
use snakes_core::evolve::{RestartKind, RunPlan, StrategyKind};
use snakes_core::save::{ControlRun, PoetStudy};

/// Number of individuals in a generation of a direct search.
const POPULATION: u32 = 12;
/// Number of direct searches on each of the hardest stairs.
pub(super) const SEEDS: u64 = 10;
/// Share of the way that all direct searches must miss on stairs that only POET solves.
const DIRECT: f32 = 0.55;

/// A direct search that is still to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedControl {
    /// Index of the stairs in the tree of POET's run.
    pub node: u32,
    /// Plan of the direct search.
    pub plan: RunPlan,
}

/// Returns the direct searches that a study lacks: for each seed, one on each of the hardest stairs. Stairs on which a search has
/// already come far enough need no others.
pub fn planned_controls(study: &PoetStudy, poet: &RunPlan) -> Vec<PlannedControl> {
    let mut planned = Vec::new();
    for number in 1..=SEEDS {
        for hard in &study.hardest {
            let seed = poet.seed.wrapping_add(number);
            let mut of_node = study.controls.iter().filter(|run| run.node == hard.node);
            if of_node.any(|run| run.seed == seed || is_enough(run)) {
                continue;
            }
            let mut settings = poet.settings.clone();
            settings.trial = poet.settings.trial.on_stairs(hard.stairs.stairs());
            let evolution = &mut settings.evolution;
            evolution.strategy = StrategyKind::CmaEs;
            evolution.population = POPULATION;
            let generations = hard.trials.div_ceil(POPULATION.into());
            evolution.generations = u32::try_from(generations).unwrap_or(u32::MAX).max(1);
            evolution.cma_es.restarts = RestartKind::Bipop;
            planned.push(PlannedControl {
                node: hard.node,
                plan: RunPlan::new("poet", seed, settings),
            });
        }
    }
    planned
}

/// Returns whether a direct search has come so far that POET is not the only one to solve its stairs.
pub fn is_enough(run: &ControlRun) -> bool {
    run.share.is_some_and(|share| share >= DIRECT)
}

/// Makes direct searches, as many at the same time as `evaluator` has workers. Once a search has come far enough, it ends, and so
/// do the other searches on its stairs. Calls `spent` with numbers of trials, and `done` with each finished search, one at a time.
///
/// # Errors
/// `control` was cancelled, workers could not be started, or `done` failed.
pub fn run_controls(
    planned: &[PlannedControl],
    evaluator: &dyn Evaluator,
    control: &RunControl,
    spent: impl Fn(u64) + Sync,
    mut done: impl FnMut(ControlRun) -> Result<(), HeadlessError> + Send,
) -> Result<(), HeadlessError> {
    let settled: Mutex<BTreeSet<u32>> = Mutex::default();
    let is_settled =
        |node: u32| settled.lock().unwrap_or_else(PoisonError::into_inner).contains(&node);
    let work = |index: usize, single: &dyn Evaluator| -> Result<Option<ControlRun>, Cancelled> {
        let PlannedControl { node, plan } = &planned[index];
        let mut experiment = Experiment::new(plan.clone());
        while !experiment.is_over() {
            if is_settled(*node) {
                return Ok(None);
            }
            let report = experiment.run_generation(single, control)?;
            spent(report.evaluations.into());
            let best = experiment.best();
            if best.is_some_and(|best| best.evaluation.fitness >= DIRECT) {
                settled.lock().unwrap_or_else(PoisonError::into_inner).insert(*node);
                break;
            }
        }
        let share = experiment.best().map(|best| best.evaluation.fitness);
        let evaluations = experiment.evaluated();
        Ok(Some(ControlRun { node: *node, seed: plan.seed, evaluations, share }))
    };
    let done = |run: Option<ControlRun>| run.map_or(Ok(()), &mut done);
    whole_runs(planned.len(), evaluator, control, work, done)
}
