//! Champions: individuals worth keeping, with their origin.

use serde::{Deserialize, Serialize};

use crate::genome::Genome;
use crate::score::{Evaluation, Fitness, Trial};
use crate::world::BodyPlan;

/// An individual worth keeping, with everything that its replay needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Champion {
    /// Genome of the individual.
    pub genome: Genome,
    /// Conditions under which the individual was scored.
    pub trial: Trial,
    /// Evaluation of the individual in its trial.
    pub evaluation: Evaluation,
    /// Fitness over the varied trials on which the run chose the champion. None if the run chose it by the evaluation alone.
    pub chosen_by: Option<f32>,
    /// Run that found the champion, with its generation and index.
    pub origin: Origin,
}

impl Champion {
    /// Returns the displacement of the body's middle towards the stairs during the trial, in m.
    pub fn way_m(&self) -> f32 {
        self.evaluation.centre_y_m - self.trial.middle_start_y_m(&self.genome)
    }

    /// Returns the number of steps that the middle limb had climbed at the end; 0 if it was not measured.
    pub fn steps_climbed(&self) -> u32 {
        self.evaluation.behaviour.map_or(0, |behaviour| behaviour.steps_climbed)
    }

    /// Returns the body of the champion in its trial.
    pub fn body(&self) -> BodyPlan {
        self.trial.agent.body_plan(&self.genome)
    }

    /// Returns the numbers by which a run ranks its champions, the more important first; greater is better. Higher stairs, to which a
    /// ladder leads, come before greater fitness.
    pub fn rank(&self) -> [f32; 2] {
        [self.trial.stairs.highest_m(), self.chosen_by.unwrap_or(self.evaluation.fitness)]
    }

    /// Returns the rank in a run whose stairs evolve. The height of the stairs counts only if the champion was not disqualified and its
    /// fitness is at least `solved`; otherwise it is 0.
    pub fn rank_of_climbed(&self, solved: f32) -> [f32; 2] {
        let [highest_m, fitness] = self.rank();
        let is_climbed = self.evaluation.disqualified.is_none() && fitness >= solved;
        [if is_climbed { highest_m } else { 0.0 }, fitness]
    }

    /// Describes the result in a few words: the fitness and, unless that tells it, where the champion ended.
    pub fn reached(&self) -> String {
        let score = self.score();
        match self.trial.fitness {
            Fitness::StepsClimbed => score,
            _ => format!("{score}, {}", self.trial.result_in_words(&self.genome, &self.evaluation)),
        }
    }

    /// Returns the fitness with its unit.
    pub fn score(&self) -> String {
        self.trial.fitness.text(self.evaluation.fitness)
    }

    /// Describes the fitness in a few letters for tables: see [`Fitness::brief`](crate::score::Fitness::brief).
    pub fn brief(&self) -> String {
        self.trial.fitness.brief(self.evaluation.fitness)
    }
}

/// Run that found an individual, with the individual's generation and index.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Name of the preset from which the run's settings come.
    pub preset: String,
    /// Seed of the run.
    pub seed: u64,
    /// Generation of the individual; the first is 1.
    pub generation: u32,
    /// Index within the generation; the first is 0.
    pub individual: u32,
}
