//! The arms of the study, and their runs.

use crate::check::{Invalid, within};
use crate::evolve::{BodyProtection, RunPlan, Settings, StrategyKind};
use crate::run::evaluator::Evaluator;
use crate::run::experiment::Experiment;
use crate::run::headless::HeadlessError;
use crate::run::run_control::{Cancelled, RunControl};
use crate::run::whole_runs::whole_runs;
use crate::save::BodyStudyRun;
use crate::schema::{Choices, choices};

use super::measure::measured;

choices! {
    /// The strategy of a run of the study.
    pub enum Arm {
        Protected = "protected", "GA, new bodies protected", "A genetic algorithm that protects new bodies by their age.";
        Unprotected = "unprotected", "GA without protection", "The same genetic algorithm, selecting by fitness alone.";
        Archive = "archive", "MAP-Elites", "MAP-Elites over the number of blocks and the length.";
    }
}

/// Maximum number of evaluations of a run.
const MAX_EVALUATIONS: u32 = 1_000_000;

impl Arm {
    /// Its name in files.
    pub fn name(self) -> &'static str {
        self.choice().name
    }

    /// The plan of a run.
    ///
    /// # Errors
    /// The budget is too small for one generation, or the trial's duration is out of range.
    pub fn plan(
        self,
        settings: &Settings,
        seed: u64,
        evaluations: u32,
    ) -> Result<RunPlan, Invalid> {
        let mut settings = settings.clone();
        let evolution = &mut settings.evolution;
        evolution.strategy = match self {
            Self::Protected | Self::Unprotected => StrategyKind::BodyGa,
            Self::Archive => StrategyKind::BodyMapElites,
        };
        if self == Self::Unprotected {
            evolution.body_ga.protection = BodyProtection::None;
        }
        within("evaluations", evaluations, evolution.population..=MAX_EVALUATIONS)?;
        evolution.generations = evaluations / evolution.population;
        // The budget counts every simulation.
        settings.trial.repeats.champion_trials = 0;
        settings.check()?;
        Ok(RunPlan::new("bodies", seed, settings))
    }
}

/// A run that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedArm {
    /// Its arm.
    pub arm: Arm,
    /// Its plan.
    pub plan: RunPlan,
}

/// A run that was made.
#[derive(Debug, Clone, PartialEq)]
pub struct FinishedArm {
    /// Its arm.
    pub arm: Arm,
    /// Its measurements.
    pub run: BodyStudyRun,
}

/// Makes all runs, as many at the same time as `evaluator` has workers. Calls `spent` with the numbers of evaluations, and
/// `done` with each finished run, one at a time.
///
/// # Errors
/// `control` was cancelled, workers could not be started, or `done` failed.
pub fn train_arms(
    planned: &[PlannedArm],
    evaluator: &dyn Evaluator,
    control: &RunControl,
    spent: impl Fn(u64) + Sync,
    done: impl FnMut(FinishedArm) -> Result<(), HeadlessError> + Send,
) -> Result<(), HeadlessError> {
    let work = |index: usize, single: &dyn Evaluator| -> Result<FinishedArm, Cancelled> {
        let PlannedArm { arm, plan } = &planned[index];
        let mut experiment = Experiment::new(plan.clone());
        let run = measured(&mut experiment, plan, single, control, &spent)?;
        Ok(FinishedArm { arm: *arm, run })
    };
    whole_runs(planned.len(), evaluator, control, work, done)
}
