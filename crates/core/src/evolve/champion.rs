//! An individual worth keeping, with its origin.

use serde::{Deserialize, Serialize};

use crate::genome::Genome;
use crate::score::{Evaluation, Fitness, Trial};
use crate::world::BodyPlan;

/// An individual worth keeping, with everything that a replay needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Champion {
    /// The individual.
    pub genome: Genome,
    /// The conditions under which it was scored.
    pub trial: Trial,
    /// Its evaluation.
    pub evaluation: Evaluation,
    /// Its fitness over the varied trials on which its run chose it; none if its run chose by the evaluation alone.
    pub chosen_by: Option<f32>,
    /// The run that found it, and its place there.
    pub origin: Origin,
}

impl Champion {
    /// Way of its middle towards the stairs, in m.
    pub fn way_m(&self) -> f32 {
        self.evaluation.centre_y_m - self.trial.middle_start_y_m(&self.genome)
    }

    /// Steps that its middle limb had climbed at the end.
    pub fn steps_climbed(&self) -> u32 {
        self.evaluation.behaviour.map_or(0, |behaviour| behaviour.steps_climbed)
    }

    /// The body that it has in its trial.
    pub fn body(&self) -> BodyPlan {
        self.trial.agent.body_plan(&self.genome)
    }

    /// The numbers by which a run compares its champions: the greater are the better one. Higher stairs, to which a ladder
    /// leads, come before greater fitness.
    pub fn rank(&self) -> [f32; 2] {
        [self.trial.stairs.highest_m(), self.chosen_by.unwrap_or(self.evaluation.fitness)]
    }

    /// The numbers of [`Self::rank`] in a run whose stairs evolve: higher stairs come first only once a snake covers this share
    /// of their way.
    pub fn rank_of_climbed(&self, solved: f32) -> [f32; 2] {
        let [highest_m, fitness] = self.rank();
        let is_climbed = self.evaluation.disqualified.is_none() && fitness >= solved;
        [if is_climbed { highest_m } else { 0.0 }, fitness]
    }

    /// A short description of its result: fitness, and where it ended.
    pub fn reached(&self) -> String {
        let score = self.score();
        match self.trial.fitness {
            Fitness::StepsClimbed => score,
            _ => format!("{score}, {}", self.trial.result_in_words(&self.genome, &self.evaluation)),
        }
    }

    /// Its fitness with the unit.
    pub fn score(&self) -> String {
        self.trial.fitness.text(self.evaluation.fitness)
    }
}

/// The run that found an individual, and its generation and index there.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Name of the preset.
    pub preset: String,
    /// Seed of the run.
    pub seed: u64,
    /// Generation; the first is 1.
    pub generation: u32,
    /// Index within the generation; the first is 0.
    pub individual: u32,
}
