//! The runs of the study of the two physics engines.

use serde::{Deserialize, Serialize};

use super::study::StudiedRun;
use crate::check::{Invalid, within};
use crate::score::FITNESS_RANGE;

/// The measurements of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EngineStudyRun {
    /// The seed.
    pub seed: u64,
    /// Number of evaluations that its generations spent.
    pub evaluations: u32,
    /// The number of the first evaluation, counted from 1, that ended on the landing.
    pub first_on_landing: Option<u32>,
    /// Mean fitness of the last generation.
    pub last_mean: Option<f64>,
    /// Fitness of its champion; none if all were disqualified.
    pub fitness: Option<f32>,
    /// Share of its way that a champion of lanes keeps in rapier.
    pub kept: Option<f32>,
    /// Hash over the run.
    pub run_hash: String,
}

impl StudiedRun for EngineStudyRun {
    const KIND: &'static str = "snakes-and-stairs engine study";

    fn seed(&self) -> u64 {
        self.seed
    }

    fn check(&self) -> Result<(), Invalid> {
        within("fitness", self.fitness.unwrap_or(0.0), FITNESS_RANGE)?;
        within("kept", self.kept.unwrap_or(0.0), 0.0..=1.0e6)
    }
}
