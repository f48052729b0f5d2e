//! Several trials per evaluation, each a little otherwise: who does well in all of them has learned more.

use serde::{Deserialize, Serialize};

use super::PerturbationRange;
use crate::check::{Invalid, within};

/// How many trials make an evaluation, and how they differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repeats {
    /// Trials per evaluation. The first is as it should be, the others are off.
    pub trials: u32,
    /// What of their fitnesses counts.
    pub counts: Counts,
    /// How far the others may be off.
    pub off: PerturbationRange,
}

/// What of several fitnesses counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Counts {
    /// Their mean.
    #[default]
    Mean,
    /// The least of them.
    Worst,
}

impl Default for Repeats {
    fn default() -> Self {
        Self { trials: 1, counts: Counts::Mean, off: PerturbationRange::default() }
    }
}

impl Repeats {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        // A hundred trials of 15 s are a second and a half.
        within("trials", self.trials, 1..=100)?;
        self.off.check().map_err(|error| error.inside("off"))
    }
}

impl Counts {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Mean, Self::Worst];

    /// The name in flags and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Worst => "worst",
        }
    }

    /// What counts of these fitnesses.
    pub(super) fn of(self, fitnesses: &[f32]) -> f32 {
        match self {
            Self::Mean => {
                let sum: f64 = fitnesses.iter().copied().map(f64::from).sum();
                (sum / fitnesses.len().max(1) as f64) as f32
            }
            Self::Worst => fitnesses.iter().copied().fold(f32::MAX, f32::min),
        }
    }
}
