//! Training: whole runs in parallel, of which each finished one can be stored at once.

use super::champion::observed;
use super::family::Family;
use crate::run::evaluator::Evaluator;
use crate::run::experiment::Experiment;
use crate::run::headless::HeadlessError;
use crate::run::run_control::{Cancelled, RunControl};
use crate::run::whole_runs::whole_runs;
use snakes_core::evolve::{Champion, RunPlan};
use snakes_core::save::{FamilyProtocol, FamilyRun, FamilyRuns, settings_fingerprint};

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
        while !experiment.is_over() && (first_landing.is_none() || !stops_at_landing) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::LocalPool;
    use snakes_core::save::load_preset;

    /// Short runs in trials of 0.5 s.
    fn planned(family: Family, seeds: &[u64]) -> Vec<PlannedFamilyRun> {
        let preset = load_preset(family.info().preset).expect("shipped").settings;
        let plan = |seed| family.plan(&preset, seed, 160, Some(0.5)).expect("allowed");
        seeds.iter().map(|seed| PlannedFamilyRun { family, plan: plan(*seed) }).collect()
    }

    fn trained(planned: &[PlannedFamilyRun], threads: usize) -> (FamilyRuns, u64) {
        let mut runs = FamilyRuns::new();
        let spent = std::sync::atomic::AtomicU64::new(0);
        let count = |count| {
            spent.fetch_add(count, std::sync::atomic::Ordering::Relaxed);
        };
        let done = |done: FinishedRun| {
            assert_eq!(done.champion.is_some(), done.run.champion.is_some());
            runs.add(&done.protocol, done.run);
            Ok(())
        };
        let pool = LocalPool::new(threads).expect("threads");
        train(planned, &pool, &RunControl::default(), count, done).expect("not cancelled");
        (runs, spent.into_inner())
    }

    #[test]
    fn training_has_the_same_result_for_any_number_of_threads_and_continues_with_what_is_missing() {
        let all = [planned(Family::Xcs, &[1, 2]), planned(Family::Rules, &[1])].concat();
        let (mut runs, spent) = trained(&all[..1], 1);
        assert_eq!(spent, all[0].simulations());
        let is_there = |_, _| true;
        let left = missing(&all, &runs, is_there);
        assert_eq!(left, all[1..]);
        assert_eq!(missing(&all, &runs, |_, _| false), all, "a champion's file is missing");
        let (others, _) = trained(&left, 3);
        for family in others.families {
            family.runs.into_iter().for_each(|run| runs.add(&family.protocol, run));
        }
        assert_eq!(missing(&all, &runs, is_there), []);
        assert_eq!(runs, trained(&all, 2).0);
        let xcs = all[0].result(&runs).expect("finished").champion.clone().expect("a champion");
        let rules = xcs.rules.expect("rules");
        assert!(rules.count > 0 && rules.share_of_twenty > 0.0, "{rules:?}");
        let waves = all[2].result(&runs).expect("finished").champion.clone().expect("a champion");
        let sum: f32 = waves.wave_shares.iter().sum();
        assert!((sum - 1.0).abs() < 1e-5 && waves.rules.is_none(), "{waves:?}");
    }

    #[test]
    fn a_run_of_other_settings_is_not_finished() {
        let all = planned(Family::Rules, &[1]);
        let (runs, _) = trained(&all, 1);
        let mut changed = all.clone();
        changed[0].plan.settings.evolution.ga.step = 0.06;
        assert_eq!(missing(&changed, &runs, |_, _| true), changed);
    }

    #[test]
    fn a_run_that_stops_ends_with_the_generation_that_first_lands() {
        // The snake begins with its middle on the landing, a centimetre high: many are still there half a second later.
        let mut landed = planned(Family::Reflex, &[1]);
        let trial = &mut landed[0].plan.settings.trial;
        trial.stairs.steps = 1;
        trial.stairs.rise_m = 0.01.into();
        trial.start_y_m = trial.stairs.first_riser_y_m + 0.5;
        trial.repeats.champion_trials = 0;
        let mut goes_on = landed.clone();
        goes_on[0].family = Family::Gait;
        let run = |planned: &[PlannedFamilyRun]| {
            let (runs, spent) = trained(planned, 1);
            assert_eq!(spent, planned[0].simulations(), "the rest counts as done");
            runs.families[0].runs[0].clone()
        };
        let (stopped, other) = (run(&landed), run(&goes_on));
        assert!(stopped.first_landing.is_some());
        assert_eq!(stopped.first_landing, other.first_landing);
        assert!(stopped.evaluations < other.evaluations, "{stopped:?} {other:?}");
    }
}
