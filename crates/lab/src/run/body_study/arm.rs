//! The arms of the study, and their runs.

use super::measure::measured;
use crate::run::evaluator::Evaluator;
use crate::run::experiment::Experiment;
use crate::run::run_control::{Cancelled, RunControl};
use crate::run::study::{StudyArm, budgeted};
use snakes_core::check::Invalid;
use snakes_core::evolve::{BodyProtection, RunPlan, Settings, StrategyKind};
use snakes_core::save::BodyStudyRun;
use snakes_core::schema::choices;

choices! {
    /// The strategy of a run of the study.
    pub enum Arm {
        Protected = "protected", "GA, new bodies protected", "A genetic algorithm that protects new bodies by their age.";
        Unprotected = "unprotected", "GA without protection", "The same genetic algorithm, selecting by fitness alone.";
        Archive = "archive", "MAP-Elites", "MAP-Elites over the number of blocks and the length.";
    }
}

impl StudyArm for Arm {
    type Run = BodyStudyRun;

    fn plan(self, settings: &Settings, seed: u64, evaluations: u32) -> Result<RunPlan, Invalid> {
        let mut settings = settings.clone();
        let evolution = &mut settings.evolution;
        evolution.strategy = match self {
            Self::Protected | Self::Unprotected => StrategyKind::BodyGa,
            Self::Archive => StrategyKind::BodyMapElites,
        };
        if self == Self::Unprotected {
            evolution.body_ga.protection = BodyProtection::None;
        }
        budgeted("bodies", settings, seed, evaluations)
    }

    fn measured(
        self,
        plan: &RunPlan,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        spent: &(dyn Fn(u64) + Sync),
    ) -> Result<BodyStudyRun, Cancelled> {
        measured(&mut Experiment::new(plan.clone()), plan, evaluator, control, spent)
    }
}
