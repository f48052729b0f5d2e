//! The settings of an experiment.

mod bodies;
mod body_search;
mod by_name;
mod cma_es;
mod creatures;
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
mod strategy_kind;

pub use body_search::{BodyGaSettings, BodyMapElitesSettings, BodyProtection, IslandSettings};
pub use by_name::{
    changed_values, check_effects, fields, with_field, with_fields, with_fields_and_engine,
    with_value,
};
pub use cma_es::{CmaEsSettings, RestartKind};
pub use creatures::CreatureGaSettings;
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
use crate::schema::{
    self, Section, SettingGroup, Walk, choice, is_default, setting_group, settings, whole,
};
use crate::score::{AgentSettings, Trial};
use crate::world::Stairs;

/// The settings of an experiment. Equal settings and an equal seed give equal bits.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The conditions under which genomes are scored.
    pub trial: Trial,
    /// The space of genomes.
    pub genome: GenomeSpace,
    /// The search.
    pub evolution: EvolutionSettings,
}

setting_group! {
    /// The search: the strategy, its length, and the settings of all strategies.
    pub struct EvolutionSettings {
        /// The strategy.
        strategy: StrategyKind = StrategyKind::Halving;
        /// Individuals per generation. The report simulated 500 to 1000. CMA-ES with restarts
        /// begins with this size and has larger generations later.
        population: u32 = 500;
        /// Generations in a run. The report has six. Population times generations is the
        /// budget of evaluations; a strategy with larger generations has fewer of them.
        generations: u32 = 6;
        /// The report's method.
        halving: HalvingSettings = HalvingSettings::default();
        /// The genetic algorithm, which also makes the children of novelty search.
        ga: GaSettings = GaSettings::default();
        /// CMA-ES.
        cma_es: CmaEsSettings = CmaEsSettings::default();
        /// MAP-Elites.
        map_elites: MapElitesSettings = MapElitesSettings::default();
        /// Novelty search.
        novelty: NoveltySettings = NoveltySettings::default();
        /// Q-learning.
        #[serde(default, skip_serializing_if = "is_default")]
        q_learning: QLearningSettings = QLearningSettings::default();
        /// XCS.
        #[serde(default, skip_serializing_if = "is_default")]
        xcs: XcsRunSettings = XcsRunSettings::default();
        /// ZCS.
        #[serde(default, skip_serializing_if = "is_default")]
        zcs: ZcsRunSettings = ZcsRunSettings::default();
        /// NEAT.
        #[serde(default, skip_serializing_if = "is_default")]
        neat: NeatSettings = NeatSettings::default();
        /// The genetic algorithm over bodies.
        #[serde(default, skip_serializing_if = "is_default")]
        body_ga: BodyGaSettings = BodyGaSettings::default();
        /// MAP-Elites over bodies.
        #[serde(default, skip_serializing_if = "is_default")]
        body_map_elites: BodyMapElitesSettings = BodyMapElitesSettings::default();
        /// Islands.
        #[serde(default, skip_serializing_if = "is_default")]
        islands: IslandSettings = IslandSettings::default();
        /// The genetic algorithm over creatures.
        #[serde(default, skip_serializing_if = "is_default")]
        creature_ga: CreatureGaSettings = CreatureGaSettings::default();
        /// POET.
        #[serde(default, skip_serializing_if = "is_default")]
        poet: PoetSettings = PoetSettings::default();
        /// Minimal criterion coevolution.
        #[serde(default, skip_serializing_if = "is_default")]
        mcc: MccSettings = MccSettings::default();
        /// The ladder of stairs.
        #[serde(default, skip_serializing_if = "is_default")]
        ladder: LadderSettings = LadderSettings::default();
        /// Exploration of all learners.
        #[serde(default, skip_serializing_if = "is_default")]
        exploration: ExplorationSettings = ExplorationSettings::default();
    }
}

impl SettingGroup for EvolutionSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self {
            strategy,
            population,
            generations,
            halving,
            ga,
            cma_es,
            map_elites,
            novelty,
            q_learning,
            xcs,
            zcs,
            neat,
            body_ga,
            body_map_elites,
            islands,
            creature_ga,
            poet,
            mcc,
            ladder,
            exploration,
        } = self;
        walk.section(Self::RUN);
        let sizes = whole("Population", 1..=LARGEST_POPULATION)
            .hint("Number of snakes in a generation. More find better solutions, but take longer");
        let is_learned = strategy.info().is_budget_driven || strategy.info().has_fixed_population;
        settings! { walk,
            population: if is_learned { sizes.fixed(cma_es::LEARNED) } else { sizes };
            generations: whole("Generations", 1..=10_000)
                .hint("Number of generations in a run. A run evaluates at most population × generations snakes");
        }
        walk.section(Self::STRATEGY);
        settings! { walk,
            strategy: choice("Strategy")
                .hint("Search algorithm")
                .fixed("Takes effect with the next run, because another strategy cannot use the current state.");
        }
        let used = strategy.info().settings;
        let groups: [(&str, &mut dyn SettingGroup); 16] = [
            ("halving", halving),
            ("ga", ga),
            ("cma_es", cma_es),
            ("map_elites", map_elites),
            ("novelty", novelty),
            ("q_learning", q_learning),
            ("xcs", xcs),
            ("zcs", zcs),
            ("neat", neat),
            ("body_ga", body_ga),
            ("body_map_elites", body_map_elites),
            ("islands", islands),
            ("creature_ga", creature_ga),
            ("poet", poet),
            ("mcc", mcc),
            ("exploration", exploration),
        ];
        for (name, group) in groups {
            walk.used_if(used.contains(&name));
            walk.group(name, group);
        }
        walk.used_if(true);
        walk.group("ladder", ladder);
    }
}

impl EvolutionSettings {
    /// The section of a run's size and length.
    pub const RUN: Section = Section { title: "Run", about: "Size and length of a run." };
    /// The section of the method.
    pub const STRATEGY: Section = Section {
        title: "Strategy",
        about: "How each generation is created from the previous one.",
    };

    /// The share of the way from which on a snake has climbed its stairs, where stairs evolve.
    pub fn climbed_from(&self) -> f32 {
        match self.strategy {
            StrategyKind::Mcc => self.mcc.criterion,
            _ => self.poet.solved_from,
        }
    }

    /// Number of evaluations that a run may cost.
    pub fn budget(&self) -> u64 {
        u64::from(self.population) * u64::from(self.generations)
    }
}

impl Settings {
    /// Checks every field against its range, and that a generation fits into memory.
    ///
    /// # Errors
    /// The first that is not allowed.
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
        walk.meet(AgentSettings::SENSING, genome.controller.senses_surroundings());
        walk.meet(AgentSettings::GIVEN_BODY, !genome.bodies.vary);
        walk.meet(AgentSettings::OWN_BODIES, genome.bodies.vary);
        walk.meet(AgentSettings::SOFT_LIMBS, bodies::are_limbs_soft(&genome.bodies, &trial.agent));
        walk.meet(Stairs::GIVEN, !strategy.info().evolves_stairs);
        walk.fixed(
            "Takes effect with the next run, because the fitness of earlier generations could not be compared.",
        );
        walk.group("trial", trial);
    }

    /// Checks that a generation, and what the strategy keeps, fit into memory.
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
            // The largest genomes have the most blocks.
            shape.joints = self.genome.bodies.limbs_max as usize - 1;
        }
        let size = GenomeSize { space: &self.genome, shape, torque_points };
        (self.evolution.strategy.info().check_size)(&self.evolution, &size)
    }
}

#[cfg(test)]
mod tests;
