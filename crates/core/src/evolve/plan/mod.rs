//! The plan of a run: everything that determines its bits, and its name.

mod end;
mod founder;
mod live_changes;

pub use founder::Founder;
pub use live_changes::{MOST_CHANGES, SettingChange, SettingChanges, may_change_during_run};

use std::sync::Arc;

use super::champion::Origin;
use super::settings::Settings;
use crate::check::Invalid;
use crate::genome::Genome;
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

    /// The origin of an individual of this run. The first generation is 1, the first individual 0.
    pub fn origin(&self, generation: u32, individual: usize) -> Origin {
        let individual = individual as u32;
        Origin { preset: self.preset.clone(), seed: self.seed, generation, individual }
    }

    /// The trial of a generation: that of the settings, with the perturbations that the generation has in common.
    pub fn trial_in(&self, generation: u32) -> Trial {
        let trial = &self.settings.trial;
        Trial { repeats: trial.repeats.in_generation(self.seed, generation), ..trial.clone() }
    }

    /// This run, starting from a founder.
    ///
    /// # Errors
    /// It does not fit the trial or the space of genomes; the message names the gene or setting.
    pub fn starting_from(self, mut founder: Founder) -> Result<Self, Invalid> {
        founder.genome = self.settings.genome.with_all_genes(founder.genome);
        let plan = Self { founder: Some(Arc::new(founder)), ..self };
        plan.check_founder()?;
        Ok(plan)
    }

    /// Checks that the founder, if there is one, fits the settings.
    ///
    /// # Errors
    /// The first gene or setting that does not fit, inside `founder`.
    pub fn check_founder(&self) -> Result<(), Invalid> {
        let Some(founder) = &self.founder else { return Ok(()) };
        self.check_genome(&founder.genome).map_err(|error| error.inside("founder"))
    }

    /// Checks that a genome fits the settings.
    ///
    /// # Errors
    /// The first gene or setting that does not fit.
    pub fn check_genome(&self, genome: &Genome) -> Result<(), Invalid> {
        let trial = &self.settings.trial;
        self.settings.genome.check_genome(genome, trial.genome_shape())?;
        trial.check_genome(genome)
    }
}
