//! All that determines an experiment's bits.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

use super::cma::LARGEST_SAMPLE;
use super::{
    Changes, CmaEsSettings, Founder, GaSettings, HalvingSettings, MapElitesSettings,
    NoveltySettings,
};
use crate::check::{Invalid, within};
use crate::genome::{ControllerKind, GenomeSpace, LARGEST_GENOME_TORQUES};
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
    pub evolution: EvolutionSettings,
}

/// The search: which method, how long, and what each method is told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvolutionSettings {
    /// The method.
    pub strategy: StrategyKind,
    /// Individuals per generation. The report simulated 500 to 1000. CMA-ES with restarts begins with it
    /// and has larger generations later.
    pub population: u32,
    /// Generations in a run. The report has six. With the population they give the evaluations that a run
    /// may cost; a method with larger generations has fewer of them.
    pub generations: u32,
    /// The report's method.
    pub halving: HalvingSettings,
    /// The genetic algorithm, and how novelty search makes children.
    pub ga: GaSettings,
    /// CMA-ES.
    pub cma_es: CmaEsSettings,
    /// MAP-Elites.
    pub map_elites: MapElitesSettings,
    /// Novelty search.
    pub novelty: NoveltySettings,
}

/// The methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StrategyKind {
    /// The report's: children of the best few, within a range that halves.
    #[default]
    Halving,
    /// A genetic algorithm.
    Ga,
    /// Covariance matrix adaptation.
    CmaEs,
    /// An archive of the best of every kind.
    MapElites,
    /// Who does what nobody did.
    Novelty,
    /// Newborns only: what any method has to beat.
    Random,
}

impl StrategyKind {
    /// All of them, the report's first.
    pub const ALL: [Self; 6] =
        [Self::Halving, Self::Ga, Self::CmaEs, Self::MapElites, Self::Novelty, Self::Random];

    /// The name in files; flags may write - for _.
    pub fn name(self) -> &'static str {
        match self {
            Self::Halving => "halving",
            Self::Ga => "ga",
            Self::CmaEs => "cma_es",
            Self::MapElites => "map_elites",
            Self::Novelty => "novelty",
            Self::Random => "random",
        }
    }

    /// The name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Halving => "Halving (the report's)",
            Self::Ga => "Genetic algorithm",
            Self::CmaEs => "CMA-ES",
            Self::MapElites => "MAP-Elites",
            Self::Novelty => "Novelty search",
            Self::Random => "Random",
        }
    }

    /// What it does, in a few words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Halving => {
                "The best few have children, each shifted at random within a range that halves."
            }
            Self::Ga => {
                "Parents are chosen, crossed and mutated; the step of mutation evolves with them."
            }
            Self::CmaEs => {
                "Learns in which directions it pays to vary: covariance matrix adaptation."
            }
            Self::MapElites => {
                "Keeps the best of every kind of behaviour, and breeds from all of them."
            }
            Self::Novelty => {
                "Rewards what has not been seen before, and distance as much as it is told to."
            }
            Self::Random => "Draws every genome from nothing: what any method has to beat.",
        }
    }
}

impl fmt::Display for StrategyKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl Default for EvolutionSettings {
    fn default() -> Self {
        Self {
            strategy: StrategyKind::Halving,
            population: 500,
            generations: 6,
            halving: HalvingSettings::default(),
            ga: GaSettings::default(),
            cma_es: CmaEsSettings::default(),
            map_elites: MapElitesSettings::default(),
            novelty: NoveltySettings::default(),
        }
    }
}

/// The most individuals a generation may have: their genomes must fit into memory.
pub const LARGEST_POPULATION: u32 = 100_000;

impl EvolutionSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("population", self.population, 1..=LARGEST_POPULATION)?;
        within("generations", self.generations, 1..=10_000)?;
        self.halving.check().map_err(|error| error.inside("halving"))?;
        self.ga.check().map_err(|error| error.inside("ga"))?;
        self.cma_es.check().map_err(|error| error.inside("cma_es"))?;
        self.map_elites.check().map_err(|error| error.inside("map_elites"))?;
        self.novelty.check().map_err(|error| error.inside("novelty"))
    }

    /// How many evaluations a run may cost.
    pub fn budget(&self) -> u64 {
        u64::from(self.population) * u64::from(self.generations)
    }
}

impl Settings {
    /// Checks every field against its range, and that a generation fits into memory.
    pub fn check(&self) -> Result<(), Invalid> {
        self.trial.check().map_err(|error| error.inside("trial"))?;
        self.genome.check().map_err(|error| error.inside("genome"))?;
        self.evolution.check().map_err(|error| error.inside("evolution"))?;
        let points = self.genome.points(self.trial.duration_s);
        let signals = 2 * self.trial.agent.joints() * points;
        if signals > LARGEST_GENOME_TORQUES {
            let value = format!("{} ({signals} torque points in all)", self.genome.points_per_s);
            let allowed = format!("what makes at most {LARGEST_GENOME_TORQUES} torque points");
            return Err(Invalid::new("genome.points_per_s", value, allowed));
        }
        let EvolutionSettings { strategy, population, halving, map_elites, .. } = &self.evolution;
        // Only what is used has to fit.
        let is_signal = self.genome.controller == ControllerKind::Signal;
        let genes = if is_signal && *strategy == StrategyKind::Halving {
            signals
        } else {
            self.genome.dimension(self.trial.descent())
        };
        let fits = |field: &str, count: u32, genes_in_all: usize| {
            let most = genes_in_all / genes.max(1);
            if count as usize <= most {
                return Ok(());
            }
            let what = if is_signal { "torque points" } else { "genes" };
            Err(Invalid::new(field, count, format!("1 to {most} with {genes} {what} each")))
        };
        fits("evolution.population", *population, LARGEST_GENERATION_GENES)?;
        match strategy {
            StrategyKind::Halving => {
                let parents = halving.parents.min(*population);
                fits("evolution.halving.parents", parents, LARGEST_STATE_GENES)
            }
            StrategyKind::Ga => fits("evolution.population", *population, LARGEST_STATE_GENES),
            StrategyKind::Novelty => {
                fits("evolution.population", *population, LARGEST_STATE_GENES)?;
                // Everybody is compared with everybody, and with whom the archive remembers.
                within("evolution.population", *population, 1..=10_000)
            }
            StrategyKind::CmaEs => {
                within("evolution.population", *population, 2..=LARGEST_POPULATION)?;
                fits("evolution.population", *population, LARGEST_SAMPLE)
            }
            StrategyKind::MapElites => {
                fits("evolution.population", *population, LARGEST_SAMPLE)?;
                let cells = map_elites.cells * map_elites.cells;
                fits("evolution.map_elites.cells (squared)", cells, LARGEST_STATE_GENES)
            }
            StrategyKind::Random => Ok(()),
        }
    }
}

/// Genes in one generation: 25 million torque points take 100 MB.
const LARGEST_GENERATION_GENES: usize = 25_000_000;
/// Genes that a strategy knows: a checkpoint writes them down, in some 12 to 20 characters each.
const LARGEST_STATE_GENES: usize = 2_000_000;

/// A run: all that determines its bits, and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct RunPlan {
    /// Name of the preset that the settings started from.
    pub preset: String,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The settings; they must have passed their check. Of a run that was changed on its way they are those in
    /// force after `changes`.
    pub settings: Settings,
    /// From whom the first generation descends, if it is not drawn from nothing.
    pub founder: Option<Arc<Founder>>,
    /// What was changed since the run began.
    pub changes: Changes,
}

impl RunPlan {
    /// A plan of that name.
    pub fn new(preset: &str, seed: u64, settings: Settings) -> Self {
        let (founder, changes) = (None, Changes::default());
        Self { preset: preset.to_owned(), seed, settings, founder, changes }
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
        settings.evolution.halving.parents = 50;
        let error = settings.check().unwrap_err().to_string();
        assert!(error.starts_with("evolution.halving.parents is 50; allowed: 1 to 4"), "{error}");
        settings.genome.points_per_s = 1000.0;
        let error = settings.check().unwrap_err().to_string();
        assert!(error.starts_with("genome.points_per_s is 1000 (4800000 torque points"), "{error}");
    }
}
