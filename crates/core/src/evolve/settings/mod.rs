//! The settings of an experiment.

mod bodies;
mod body_search;
mod by_name;
mod cma_es;
mod creatures;
mod evolution;
mod ga;
mod halving;
mod ladder;
mod learning;
mod map_elites;
mod mcc;
mod neat;
mod novelty;
mod partners;
mod poet;
mod size;
mod start;
mod strategy_kind;

pub use body_search::{BodyGaSettings, BodyMapElitesSettings, BodyProtection, IslandSettings};
pub use by_name::{changed_values, check_effects, fields, with_field, with_fields, with_value};
pub use cma_es::{CmaEsSettings, RestartKind};
pub use creatures::CreatureGaSettings;
pub use evolution::EvolutionSettings;
pub use ga::{Crossover, GaSettings, Mutation, ParentSelection};
pub use halving::HalvingSettings;
pub use ladder::LadderSettings;
pub use learning::{ExplorationSettings, QLearningSettings, XcsRunSettings, ZcsRunSettings};
pub use map_elites::MapElitesSettings;
pub use mcc::MccSettings;
pub use neat::NeatSettings;
pub use novelty::NoveltySettings;
pub use poet::PoetSettings;
pub use size::{GenomeSize, LARGEST_POPULATION, LARGEST_SAMPLE};
pub use strategy_kind::{StrategyInfo, StrategyKind};

use serde::{Deserialize, Serialize};

use crate::check::Invalid;
use crate::genome::{GenomeSpace, LARGEST_GENOME_TORQUES};
use crate::schema::{self, SettingGroup, Walk};
use crate::score::{AgentSettings, Trial};
use crate::world::Stairs;

/// The settings of an experiment. Equal settings and an equal seed give equal bits.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Conditions under which genomes are scored.
    pub trial: Trial,
    /// Space of the genomes.
    pub genome: GenomeSpace,
    /// Settings of the search.
    pub evolution: EvolutionSettings,
}

impl Settings {
    /// Checks every field against its range, fields that depend on each other, and that a generation fits into memory.
    ///
    /// # Errors
    /// Names the first field that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        schema::check(self)
    }
}

impl SettingGroup for Settings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { trial, genome, evolution } = self;
        let strategy = evolution.strategy;
        let has_waves = genome.controller.uses("network.library_waves");
        walk.meet(GaSettings::TAKEOVER, strategy == StrategyKind::Ga && has_waves);
        walk.meet(PoetSettings::POINTS, strategy != StrategyKind::BodyPoet);
        walk.group("evolution", evolution);
        walk.fixed(
            "Takes effect with the next run, because existing genomes would not fit new ones.",
        );
        walk.group("genome", genome);
        walk.meet(AgentSettings::SENSING, genome.senses_surroundings());
        walk.meet(AgentSettings::GIVEN_BODY, !genome.bodies.vary);
        walk.meet(AgentSettings::OWN_BODIES, genome.bodies.vary);
        let given_soft = trial.agent.youngs_modulus_pa.is_some();
        let are_soft = if genome.bodies.vary { genome.bodies.soft } else { given_soft };
        walk.meet(AgentSettings::SOFT_LIMBS, are_soft);
        walk.meet(Stairs::GIVEN, !strategy.info().evolves_stairs);
        walk.fixed(
            "Takes effect with the next run, because the fitness of earlier generations could not be compared.",
        );
        walk.group("trial", trial);
    }

    /// Checks settings that depend on each other, and that a generation and the strategy's state fit into memory.
    fn check_together(&self) -> Result<(), Invalid> {
        self.check_partners()?;
        self.check_bodies()?;
        self.check_trials_of_stairs()?;
        let rises_m = &self.trial.stairs.rise_m;
        let strategy = self.evolution.strategy;
        self.evolution.ladder.check_with(strategy.name(), strategy.climbs_ladders(), rises_m)?;
        let points = self.genome.points(self.trial.duration_s);
        let torque_points = 2 * self.trial.agent.joints() * points;
        if torque_points > LARGEST_GENOME_TORQUES {
            let value =
                format!("{} ({torque_points} torque points in all)", self.genome.points_per_s);
            let allowed = format!("values for at most {LARGEST_GENOME_TORQUES} torque points");
            return Err(Invalid::new("genome.points_per_s", value, allowed));
        }
        let mut shape = self.trial.genome_shape();
        if self.genome.bodies.vary {
            // The largest genomes are those of the bodies with the most blocks.
            shape.joints = self.genome.bodies.limbs_max as usize - 1;
        }
        let size = GenomeSize { space: &self.genome, shape, torque_points };
        (self.evolution.strategy.info().check_size)(&self.evolution, &size)
    }
}

#[cfg(test)]
mod tests;
