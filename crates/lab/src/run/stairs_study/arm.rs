//! The arms of the study, and their runs.

use crate::run::evaluator::Evaluator;
use crate::run::exam::examine;
use crate::run::experiment::Experiment;
use crate::run::run_control::{Cancelled, RunControl};
use crate::run::study::{StudyArm, budgeted_with_champions};
use snakes_core::check::Invalid;
use snakes_core::evolve::{Champion, RunPlan, Settings};
use snakes_core::save::StairsStudyRun;
use snakes_core::schema::choices;
use snakes_core::score::{ExamSuite, StairsVariation};

choices! {
    /// The stairs on which the snakes of a run learn.
    pub enum StairsArm {
        Generalist = "generalist", "Generalist", "Learns on its own stairs and on eight others, which change in each generation.";
        Specialist = "specialist", "Specialist", "Learns on its own stairs alone, with as many simulated trials.";
    }
}

impl StudyArm for StairsArm {
    type Run = StairsStudyRun;

    /// The plan of a run; `evaluations` are those of the generalist.
    fn plan(self, settings: &Settings, seed: u64, evaluations: u32) -> Result<RunPlan, Invalid> {
        let mut settings = settings.clone();
        let trials = settings.trial.repeats.trials;
        let mut evaluations = evaluations;
        if self == Self::Specialist {
            let repeats = &mut settings.trial.repeats;
            (repeats.trials, repeats.off.stairs) = (1, StairsVariation::Own);
            evaluations = evaluations.saturating_mul(trials);
            // It has as many times more generations, each of which chooses a champion.
            repeats.champion_trials = (repeats.champion_trials / trials).max(1);
        }
        // Both choose their champions with care, each on variations of what it has learned.
        budgeted_with_champions("generalist", settings, seed, evaluations)
    }

    fn measured(
        self,
        plan: &RunPlan,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        spent: &(dyn Fn(u64) + Sync),
    ) -> Result<StairsStudyRun, Cancelled> {
        let mut experiment = Experiment::new(plan.clone());
        while !experiment.is_over() {
            let report = experiment.run_generation(evaluator, control)?;
            spent(report.evaluations.into());
        }
        let best = experiment.best();
        let classes = match best {
            Some(best) => climbed(best, evaluator, control)?,
            None => Vec::new(),
        };
        let all = plan.settings.trial.repeats.trials;
        Ok(StairsStudyRun {
            seed: plan.seed,
            evaluations: u32::try_from(experiment.evaluated()).unwrap_or(u32::MAX),
            trials: u32::try_from(experiment.evaluated() * u64::from(all)).unwrap_or(u32::MAX),
            fitness: best.map(|best| best.evaluation.fitness),
            climbed: classes,
            run_hash: format!("{:016x}", experiment.run_hash()),
        })
    }
}

/// The number of held-out stairs of each class that a champion climbs.
fn climbed(
    champion: &Champion,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<u32>, Cancelled> {
    let results = examine(champion, &[ExamSuite::HeldOut], evaluator, control)?;
    let classes = results.iter().flat_map(|result| result.classes());
    Ok(classes.map(|(_, climbed, _)| climbed).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::LocalPool;
    use snakes_core::save::load_preset;

    #[test]
    fn both_arms_simulate_as_many_trials_and_are_examined_on_the_held_out_stairs() {
        let mut settings = load_preset("generalist").expect("shipped").settings;
        let evolution = &mut settings.evolution;
        (evolution.population, evolution.cma_es.newborns) = (4, 0);
        settings.trial.duration_s = 1.0;
        settings.trial.repeats.champion_trials = 1;
        let pool = LocalPool::new(2).expect("threads");
        let runs = [StairsArm::Generalist, StairsArm::Specialist].map(|arm| {
            let plan = arm.plan(&settings, 1, 8).expect("allowed");
            let control = RunControl::default();
            let run = arm.measured(&plan, &pool, &control, &|_| {}).expect("not cancelled");
            assert_eq!(run.climbed.len(), 4, "{run:?}");
            run
        });
        assert_eq!(runs.each_ref().map(|run| run.evaluations), [8, 72]);
        assert_eq!(runs.each_ref().map(|run| run.trials), [72, 72]);
    }
}
