//! All that determines an experiment's bits.

use serde::{Deserialize, Serialize};

use super::HalvingSettings;
use crate::check::Invalid;
use crate::genome::{GenomeSpace, LARGEST_GENOME_TORQUES};
use crate::score::Trial;

/// The settings of an experiment. Equal settings and an equal seed give equal bits.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Under which conditions genomes are scored.
    pub trial: Trial,
    /// What genomes may be.
    pub genome: GenomeSpace,
    /// How the search goes.
    pub evolution: HalvingSettings,
}

impl Settings {
    /// Checks every field against its range, and that a generation fits into memory.
    pub fn check(&self) -> Result<(), Invalid> {
        self.trial.check().map_err(|error| error.inside("trial"))?;
        self.genome.check().map_err(|error| error.inside("genome"))?;
        self.evolution.check().map_err(|error| error.inside("evolution"))?;
        let points = self.genome.points(self.trial.duration_s);
        let torques_each = 2 * self.trial.agent.joints() * points;
        if torques_each > LARGEST_GENOME_TORQUES {
            let value =
                format!("{} ({torques_each} torque points in all)", self.genome.points_per_s);
            let allowed = format!("what makes at most {LARGEST_GENOME_TORQUES} torque points");
            return Err(Invalid::new("genome.points_per_s", value, allowed));
        }
        let largest = LARGEST_GENERATION_TORQUES / torques_each.max(1);
        if self.evolution.population as usize > largest {
            let allowed = format!("1 to {largest} with {torques_each} torque points each");
            return Err(Invalid::new("evolution.population", self.evolution.population, allowed));
        }
        let parents = self.evolution.parents.min(self.evolution.population);
        let most = LARGEST_PARENTS_TORQUES / torques_each.max(1);
        if parents as usize > most {
            let allowed = format!("1 to {most} with {torques_each} torque points each");
            return Err(Invalid::new("evolution.parents", parents, allowed));
        }
        Ok(())
    }
}

/// Torque points in one generation: 25 million of them take 100 MB.
const LARGEST_GENERATION_TORQUES: usize = 25_000_000;
/// Torque points of all parents together: a checkpoint writes them down, in some 12 characters each.
const LARGEST_PARENTS_TORQUES: usize = 4_000_000;

/// A run: all that determines its bits, and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct RunPlan {
    /// Name of the preset that the settings started from.
    pub preset: String,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The settings; they must have passed their check.
    pub settings: Settings,
}

impl RunPlan {
    /// A plan of that name.
    pub fn new(preset: &str, seed: u64, settings: Settings) -> Self {
        Self { preset: preset.to_owned(), seed, settings }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed() {
        assert_eq!(Settings::default().check(), Ok(()));
    }

    #[test]
    fn a_generation_that_would_not_fit_into_memory_is_refused() {
        let mut settings = Settings::default();
        settings.trial.duration_s = 600.0;
        settings.genome.points_per_s = 100.0;
        settings.evolution.population = 10_000;
        let error = settings.check().unwrap_err().to_string();
        assert!(error.starts_with("evolution.population is 10000; allowed: 1 to 52"), "{error}");
        settings.evolution.population = 50;
        settings.evolution.parents = 50;
        let error = settings.check().unwrap_err().to_string();
        assert!(error.starts_with("evolution.parents is 50; allowed: 1 to 8"), "{error}");
        settings.genome.points_per_s = 1000.0;
        let error = settings.check().unwrap_err().to_string();
        assert!(error.starts_with("genome.points_per_s is 1000 (4800000 torque points"), "{error}");
    }
}
