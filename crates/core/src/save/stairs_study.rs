//! The runs of the study of snakes that learn on many stairs.

use serde::{Deserialize, Serialize};

use super::study::StudiedRun;
use crate::check::{Invalid, within};
use crate::genome::HELD_OUT_PER_CLASS;
use crate::score::FITNESS_RANGE;

/// The measurements of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StairsStudyRun {
    /// The seed.
    pub seed: u64,
    /// Number of evaluations that its generations spent.
    pub evaluations: u32,
    /// Number of trials in these.
    pub trials: u32,
    /// Fitness of its champion; none if all were disqualified.
    pub fitness: Option<f32>,
    /// Number of held-out stairs of each class that its champion climbs; empty without one.
    pub climbed: Vec<u32>,
    /// Hash over the run.
    pub run_hash: String,
}

impl StairsStudyRun {
    /// Number of held-out stairs that its champion climbs.
    pub fn climbed_in_all(&self) -> u32 {
        self.climbed.iter().sum()
    }
}

impl StudiedRun for StairsStudyRun {
    const KIND: &'static str = "snakes-and-stairs stairs study";

    fn seed(&self) -> u64 {
        self.seed
    }

    fn check(&self) -> Result<(), Invalid> {
        within("fitness", self.fitness.unwrap_or(0.0), FITNESS_RANGE)?;
        within("climbed", self.climbed.len(), 0..=4)?;
        let mut climbed = self.climbed.iter();
        climbed.try_for_each(|&climbed| within("climbed", climbed, 0..=HELD_OUT_PER_CLASS))
    }
}
