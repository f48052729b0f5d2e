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
    /// Name of the preset from which the settings started.
    pub preset: String,
    /// Seed of all random numbers of the run.
    pub seed: u64,
    /// Settings of the run, which must have passed their check. They include all changes made during the run.
    pub settings: Settings,
    /// Founder from which the first generation descends. None if the first generation is drawn at random.
    pub founder: Option<Arc<Founder>>,
    /// Changes of settings since the run began.
    pub changes: SettingChanges,
}

impl RunPlan {
    /// Makes a plan without a founder and without changes.
    pub fn new(preset: &str, seed: u64, settings: Settings) -> Self {
        let (founder, changes) = (None, SettingChanges::default());
        Self { preset: preset.to_owned(), seed, settings, founder, changes }
    }

    /// Returns the origin of an individual of this run. Generations count from 1, individuals from 0.
    pub fn origin(&self, generation: u32, individual: usize) -> Origin {
        let individual = individual as u32;
        Origin { preset: self.preset.clone(), seed: self.seed, generation, individual }
    }

    /// Returns the trial of the settings, with the perturbations that all individuals of a generation have in common.
    pub fn trial_in(&self, generation: u32) -> Trial {
        let trial = &self.settings.trial;
        Trial { repeats: trial.repeats.in_generation(self.seed, generation), ..trial.clone() }
    }

    /// Returns this plan with a founder.
    ///
    /// # Errors
    /// Fails if the founder does not fit the trial or the space of genomes; the error names the gene or setting.
    pub fn starting_from(self, mut founder: Founder) -> Result<Self, Invalid> {
        founder.genome = self.settings.genome.with_all_genes(founder.genome);
        let plan = Self { founder: Some(Arc::new(founder)), ..self };
        plan.check_founder()?;
        Ok(plan)
    }

    /// Checks that the founder, if there is one, fits the settings.
    ///
    /// # Errors
    /// Names the first gene or setting that does not fit, with the prefix `founder`.
    pub fn check_founder(&self) -> Result<(), Invalid> {
        let Some(founder) = &self.founder else { return Ok(()) };
        self.check_genome(&founder.genome).map_err(|error| error.inside("founder"))
    }

    /// Checks that a genome fits the settings.
    ///
    /// # Errors
    /// Names the first gene or setting that does not fit.
    pub fn check_genome(&self, genome: &Genome) -> Result<(), Invalid> {
        let trial = &self.settings.trial;
        self.settings.genome.check_genome(genome, trial.genome_shape())?;
        trial.check_genome(genome)
    }
}
