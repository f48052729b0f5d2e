//! The arms of the study, which are the engines, and their runs.

use crate::run::compare::run_one;
use crate::run::evaluator::Evaluator;
use crate::run::exam::examine;
use crate::run::experiment::Experiment;
use crate::run::run_control::{Cancelled, RunControl};
use crate::run::study::{StudyArm, budgeted_with_champions};
use snakes_core::check::Invalid;
use snakes_core::evolve::{Champion, RunPlan, Settings};
use snakes_core::save::EngineStudyRun;
use snakes_core::score::ExamSuite;
use snakes_core::world::PhysicsEngine;

impl StudyArm for PhysicsEngine {
    type Run = EngineStudyRun;

    fn plan(self, settings: &Settings, seed: u64, evaluations: u32) -> Result<RunPlan, Invalid> {
        let mut settings = settings.clone();
        settings.trial.physics.engine = self;
        budgeted_with_champions("climb", settings, seed, evaluations)
    }

    fn measured(
        self,
        plan: &RunPlan,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        spent: &(dyn Fn(u64) + Sync),
    ) -> Result<EngineStudyRun, Cancelled> {
        let mut experiment = Experiment::new(plan.clone());
        let run = run_one(&mut experiment, plan, |experiment| {
            let report = experiment.run_generation(evaluator, control)?;
            spent(report.evaluations.into());
            Ok(report)
        })?;
        let kept = match (self, experiment.best()) {
            (Self::Lanes, Some(best)) => kept_in_other(best, evaluator, control)?,
            // Rapier's champions are the built-in ones.
            _ => None,
        };
        Ok(EngineStudyRun {
            seed: plan.seed,
            evaluations: run.evaluations,
            first_on_landing: run.first_on_landing,
            last_mean: run.last_mean,
            fitness: run.best.map(|best| best.fitness),
            kept,
            run_hash: run.run_hash,
        })
    }
}

/// The share of its way that a champion keeps in the other engine; none if that cannot simulate it.
///
/// # Errors
/// [`Cancelled`], if `control` was.
pub fn kept_in_other(
    champion: &Champion,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Option<f32>, Cancelled> {
    let results = examine(champion, &[ExamSuite::Engine], evaluator, control)?;
    Ok(results.first().map(|result| result.kept))
}
