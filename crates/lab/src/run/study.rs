//! Studies: runs of several arms over several seeds, each of which is measured.

use super::evaluator::Evaluator;
use super::headless::HeadlessError;
use super::run_control::{Cancelled, RunControl};
use super::whole_runs::whole_runs;
use snakes_core::check::{Invalid, within};
use snakes_core::evolve::{RunPlan, Settings};
use snakes_core::save::StudiedRun;
use snakes_core::schema::Choices;

/// An arm of a study: what its runs have in common.
pub trait StudyArm: Choices + Send + Sync {
    /// The measurements of a run.
    type Run: StudiedRun + Send;

    /// The plan of a run.
    ///
    /// # Errors
    /// The budget is too small for one generation, or the trial's duration is out of range.
    fn plan(self, settings: &Settings, seed: u64, evaluations: u32) -> Result<RunPlan, Invalid>;

    /// Makes a run to its end and measures it. Calls `spent` with the numbers of evaluations.
    ///
    /// # Errors
    /// `control` was cancelled.
    fn measured(
        self,
        plan: &RunPlan,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        spent: &(dyn Fn(u64) + Sync),
    ) -> Result<Self::Run, Cancelled>;

    /// Its name in files.
    fn name(self) -> &'static str {
        self.choice().name
    }
}

/// Maximum number of evaluations of a run.
const MAX_EVALUATIONS: u32 = 1_000_000;

/// The plan of a run of a study with this budget.
///
/// # Errors
/// The budget is too small for one generation, or the settings do not fit together.
pub(super) fn budgeted(
    preset: &str,
    mut settings: Settings,
    seed: u64,
    evaluations: u32,
) -> Result<RunPlan, Invalid> {
    let evolution = &mut settings.evolution;
    within("evaluations", evaluations, evolution.population..=MAX_EVALUATIONS)?;
    evolution.generations = evaluations / evolution.population;
    // The budget counts every simulation.
    settings.trial.repeats.champion_trials = 0;
    settings.check()?;
    Ok(RunPlan::new(preset, seed, settings))
}

/// The same, but with trials that choose the champion of each generation. The budget does not count them.
///
/// # Errors
/// Those of [`budgeted`].
pub(super) fn budgeted_with_champions(
    preset: &str,
    settings: Settings,
    seed: u64,
    evaluations: u32,
) -> Result<RunPlan, Invalid> {
    let champion_trials = settings.trial.repeats.champion_trials;
    let mut plan = budgeted(preset, settings, seed, evaluations)?;
    plan.settings.trial.repeats.champion_trials = champion_trials;
    plan.settings.check()?;
    Ok(plan)
}

/// A run that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedArm<A> {
    /// Its arm.
    pub arm: A,
    /// Its plan.
    pub plan: RunPlan,
}

/// Makes all runs, as many at the same time as `evaluator` has workers. Calls `spent` with the numbers of evaluations, and
/// `done` with each finished run, one at a time.
///
/// # Errors
/// `control` was cancelled, workers could not be started, or `done` failed.
pub fn train_arms<A: StudyArm>(
    planned: &[PlannedArm<A>],
    evaluator: &dyn Evaluator,
    control: &RunControl,
    spent: impl Fn(u64) + Sync,
    mut done: impl FnMut(A, A::Run) -> Result<(), HeadlessError> + Send,
) -> Result<(), HeadlessError> {
    let work = |index: usize, single: &dyn Evaluator| {
        let PlannedArm { arm, plan } = &planned[index];
        Ok((*arm, arm.measured(plan, single, control, &spent)?))
    };
    whole_runs(planned.len(), evaluator, control, work, |(arm, run)| done(arm, run))
}
