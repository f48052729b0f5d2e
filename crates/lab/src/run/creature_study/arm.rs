//! The arms of the study, and their runs.

use crate::run::evaluator::Evaluator;
use crate::run::experiment::Experiment;
use crate::run::run_control::{Cancelled, RunControl};
use crate::run::study::{StudyArm, budgeted};
use snakes_core::check::Invalid;
use snakes_core::evolve::{Champion, RunPlan, Settings};
use snakes_core::genome::{NeuronSet, joint_tree};
use snakes_core::save::CreatureStudyRun;
use snakes_core::schema::choices;
use snakes_core::score::Fitness;

choices! {
    /// The task of the creatures of a run.
    pub enum CreatureArm {
        Flat = "flat", "Flat ground", "Move as far as possible on flat ground. A run ends with the first generation that reaches the goal.";
        Stairs = "stairs", "Low stairs", "Climb stairs of 0.25 m. A run ends with the first generation that reaches the goal.";
        Standard = "standard", "Standard neurons", "Climb the same stairs, with all evaluations.";
        Sims = "sims", "Neurons of Sims", "The same with the 23 functions of Sims.";
    }
}

/// Way on flat ground that a creature must make, in metres.
pub const GOAL_WAY_M: f32 = 5.0;
/// Steps that a creature must climb.
pub const GOAL_STEPS: u32 = 3;
impl CreatureArm {
    /// Evaluations that a run may spend, given those of the runs that compare neurons.
    pub fn evaluations(self, compared: u32) -> u32 {
        match self {
            Self::Flat => 20_000,
            Self::Stairs => 60_000,
            Self::Standard | Self::Sims => compared,
        }
    }

    /// Whether a creature has done what the arm is about.
    fn is_reached(self, champion: &Champion) -> bool {
        match self {
            Self::Flat => way_m(champion) >= GOAL_WAY_M,
            Self::Stairs | Self::Standard | Self::Sims => steps(champion) >= GOAL_STEPS,
        }
    }

    fn stops_at_goal(self) -> bool {
        matches!(self, Self::Flat | Self::Stairs)
    }
}

/// Way of the middle of a creature towards the stairs, in metres.
fn way_m(champion: &Champion) -> f32 {
    champion.evaluation.centre_y_m - champion.trial.middle_start_y_m(&champion.genome)
}

fn steps(champion: &Champion) -> u32 {
    champion.evaluation.behaviour.map_or(0, |behaviour| behaviour.steps_climbed)
}

impl StudyArm for CreatureArm {
    type Run = CreatureStudyRun;

    /// The plan of a run; `evaluations` are those of the runs that compare neurons.
    fn plan(self, settings: &Settings, seed: u64, evaluations: u32) -> Result<RunPlan, Invalid> {
        let mut settings = settings.clone();
        match self {
            Self::Flat => {
                settings.trial.stairs.steps = 0;
                settings.trial.fitness = Fitness::CentreOfMass;
            }
            Self::Sims => settings.genome.creatures.neurons = NeuronSet::Sims,
            Self::Stairs | Self::Standard => {}
        }
        // All arms refuse a number that does not suffice for those that it is about.
        budgeted("creatures", settings.clone(), seed, evaluations)?;
        budgeted("creatures", settings, seed, self.evaluations(evaluations))
    }

    fn measured(
        self,
        plan: &RunPlan,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        spent: &(dyn Fn(u64) + Sync),
    ) -> Result<CreatureStudyRun, Cancelled> {
        let mut experiment = Experiment::new(plan.clone());
        let mut reached_after = None;
        while !experiment.is_over() {
            let report = experiment.run_generation(evaluator, control)?;
            let evaluations = report.evaluations.into();
            let is_reached =
                report.champion.as_ref().is_some_and(|champion| self.is_reached(champion));
            spent(evaluations);
            if is_reached && reached_after.is_none() {
                reached_after = u32::try_from(experiment.evaluated()).ok();
                if self.stops_at_goal() {
                    spent(plan.budget().saturating_sub(experiment.evaluated()));
                    break;
                }
            }
        }
        let best = experiment.best();
        Ok(CreatureStudyRun {
            seed: plan.seed,
            evaluations: u32::try_from(experiment.evaluated()).unwrap_or(u32::MAX),
            reached_after,
            fitness: best.map(|best| best.evaluation.fitness),
            way_m: best.map_or(0.0, way_m),
            steps: best.map_or(0, steps),
            parts: best.map_or(0, |best| best.genome.body.block_count() as u32),
            tree: best.map_or(String::new(), |best| joint_tree(&best.genome.body.nodes)),
            run_hash: format!("{:016x}", experiment.run_hash()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::LocalPool;
    use crate::run::study::{PlannedArm, train_arms};
    use snakes_core::save::load_preset;

    #[test]
    fn each_arm_has_its_own_world_and_a_run_ends_where_it_reaches_the_goal() {
        let mut settings = load_preset("creatures").expect("shipped").settings;
        settings.evolution.population = 20;
        settings.trial.duration_s = 8.0;
        let plan = |arm: CreatureArm| arm.plan(&settings, 1, 40).expect("allowed");
        assert_eq!(plan(CreatureArm::Flat).budget(), 20_000);
        assert_eq!(plan(CreatureArm::Stairs).budget(), 60_000);
        assert_eq!(plan(CreatureArm::Sims).budget(), 40);
        assert_ne!(plan(CreatureArm::Sims).settings, plan(CreatureArm::Standard).settings);
        assert!(CreatureArm::Flat.plan(&settings, 1, 10).is_err());
        let arm = CreatureArm::Flat;
        let planned = [PlannedArm { arm, plan: plan(arm) }];
        let mut finished = Vec::new();
        let pool = LocalPool::new(1).expect("threads");
        let control = RunControl::default();
        let done = |_, run| {
            finished.push(run);
            Ok(())
        };
        train_arms(&planned, &pool, &control, |_| {}, done).expect("made");
        let run: &CreatureStudyRun = &finished[0];
        assert_eq!(run.reached_after, Some(run.evaluations), "{run:?}");
        assert!(run.way_m >= GOAL_WAY_M && run.evaluations < 20_000, "{run:?}");
        assert!(run.tree.starts_with("O(") && run.parts >= 2, "{run:?}");
    }
}
