//! An individual worth keeping, and where it comes from.

use crate::genome::Genome;
use crate::score::{Evaluation, Fitness, Trial};

/// An individual worth keeping, with all that is needed to see it again.
#[derive(Debug, Clone, PartialEq)]
pub struct Champion {
    /// The individual.
    pub genome: Genome,
    /// The conditions under which it was scored.
    pub trial: Trial,
    /// What it reached.
    pub evaluation: Evaluation,
    /// Where it comes from.
    pub origin: Origin,
}

impl Champion {
    /// What it reached, in a few words: fitness, and what the place of its centre means.
    pub fn reached(&self) -> String {
        let score = self.score();
        match self.trial.fitness {
            Fitness::StepsClimbed => score,
            _ => format!("{score}, {}", self.trial.meaning(f64::from(self.evaluation.centre_y_m))),
        }
    }

    /// Its fitness with the unit.
    pub fn score(&self) -> String {
        let fitness = self.evaluation.fitness;
        match self.trial.fitness {
            Fitness::StepsClimbed => format!("{fitness:.0} steps"),
            kind => format!("{fitness:.2}{}", kind.unit()),
        }
    }
}

/// The place of an individual in the run that found it.
#[derive(Debug, Clone, PartialEq, Eq)]
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
