//! The plan of a run: everything that determines its bits, and its name.

mod founder;
mod live_changes;

pub use founder::Founder;
pub use live_changes::{MOST_CHANGES, SettingChange, SettingChanges, may_change_during_run};

use std::sync::Arc;

use super::settings::Settings;
use crate::score::Trial;

/// Everything that determines the bits of a run, and its name.
#[derive(Debug, Clone, PartialEq)]
pub struct RunPlan {
    /// Name of the preset that the settings started from.
    pub preset: String,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The settings, which must have passed their check. After changes during the run they are the latest.
    pub settings: Settings,
    /// The founder that the first generation descends from; none if it is drawn at random.
    pub founder: Option<Arc<Founder>>,
    /// The changes since the run began.
    pub changes: SettingChanges,
}

impl RunPlan {
    /// A plan without a founder and changes.
    pub fn new(preset: &str, seed: u64, settings: Settings) -> Self {
        let (founder, changes) = (None, SettingChanges::default());
        Self { preset: preset.to_owned(), seed, settings, founder, changes }
    }

    /// The trial of a generation: that of the settings, with the perturbations that the generation has in common.
    pub fn trial_in(&self, generation: u32) -> Trial {
        let trial = &self.settings.trial;
        Trial { repeats: trial.repeats.in_generation(self.seed, generation), ..trial.clone() }
    }
}
