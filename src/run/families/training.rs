//! Training: whole runs in parallel, of which each finished one can be stored at once.

use super::champion::observed;
use super::family::Family;
use crate::evolve::{Champion, RunPlan};
use crate::run::evaluator::Evaluator;
use crate::run::experiment::Experiment;
use crate::run::headless::HeadlessError;
use crate::run::run_control::{Cancelled, RunControl};
use crate::run::whole_runs::whole_runs;
use crate::save::{FamilyProtocol, FamilyRun, FamilyRuns, settings_fingerprint};

/// One run that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedFamilyRun {
    /// The family.
    pub family: Family,
    /// Its plan.
    pub plan: RunPlan,
}

/// A run that is finished.
#[derive(Debug, Clone, PartialEq)]
pub struct FinishedRun {
    /// What decided it, apart from its seed.
    pub protocol: FamilyProtocol,
    /// The family.
    pub family: Family,
    /// Its result.
    pub run: FamilyRun,
    /// Its champion; none if all were disqualified.
    pub champion: Option<Champion>,
}

impl PlannedFamilyRun {
    /// What decides the run, apart from its seed.
    pub fn protocol(&self) -> FamilyProtocol {
        let info = self.family.info();
        FamilyProtocol {
            family: self.family.name().to_owned(),
            settings: settings_fingerprint(&self.plan),
            stops_at_landing: info.stops_at_landing,
        }
    }

    /// Its result, if it is among the finished runs of the same protocol.
    pub fn result<'a>(&self, finished: &'a FamilyRuns) -> Option<&'a FamilyRun> {
        let trained = finished.family(self.family.name())?;
        let is_same = trained.protocol == self.protocol();
        trained.runs.iter().find(|run| is_same && run.seed == self.plan.seed)
    }

    /// Number of simulations that it may spend in its generations.
    pub fn simulations(&self) -> u64 {
        u64::from(self.plan.settings.trial.repeats.trials.max(1)) * self.plan.budget()
    }

    /// Makes the run. Calls `spent` with numbers of simulations, in total those of [`Self::simulations`].
    fn run(
        &self,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        spent: &(dyn Fn(u64) + Sync),
    ) -> Result<FinishedRun, Cancelled> {
        let each = u64::from(self.plan.settings.trial.repeats.trials.max(1));
        let stops_at_landing = self.family.info().stops_at_landing;
        let mut experiment = Experiment::new(self.plan.clone());
        let mut first_landing = None;
        while !experiment.is_over() && !(stops_at_landing && first_landing.is_some()) {
            let before = u32::try_from(experiment.evaluated()).unwrap_or(u32::MAX);
            let report = experiment.run_generation(evaluator, control)?;
            let number = |index: u32| before.saturating_add(index + 1);
            first_landing = first_landing.or(report.first_on_landing.map(number));
            spent(each * u64::from(report.evaluations));
        }
        spent(self.simulations().saturating_sub(each * experiment.evaluated()));
        let champion = experiment.best().cloned();
        let run = FamilyRun {
            seed: self.plan.seed,
            evaluations: u32::try_from(experiment.evaluated()).unwrap_or(u32::MAX),
            first_landing,
            champion: champion.as_ref().map(observed),
            run_hash: format!("{:016x}", experiment.run_hash()),
        };
        Ok(FinishedRun { protocol: self.protocol(), family: self.family, run, champion })
    }
}

/// The planned runs that are not among the finished ones, or whose champion's file is missing: see `has_file`.
pub fn missing(
    planned: &[PlannedFamilyRun],
    finished: &FamilyRuns,
    has_file: impl Fn(Family, u64) -> bool,
) -> Vec<PlannedFamilyRun> {
    let is_done = |planned: &&PlannedFamilyRun| {
        planned.result(finished).is_some_and(|run| {
            run.champion.is_none() || has_file(planned.family, planned.plan.seed)
        })
    };
    planned.iter().filter(|planned| !is_done(planned)).cloned().collect()
}

/// Makes all planned runs, as many at the same time as `evaluator` has workers. Calls `done` with each finished run, one
/// at a time, and `spent` with numbers of simulations.
///
/// # Errors
/// `control` was cancelled, workers could not be started, or `done` failed.
pub fn train(
    planned: &[PlannedFamilyRun],
    evaluator: &dyn Evaluator,
    control: &RunControl,
    spent: impl Fn(u64) + Sync,
    done: impl FnMut(FinishedRun) -> Result<(), HeadlessError> + Send,
) -> Result<(), HeadlessError> {
    let work = |index: usize, single: &dyn Evaluator| planned[index].run(single, control, &spent);
    whole_runs(planned.len(), evaluator, control, work, done)
}
