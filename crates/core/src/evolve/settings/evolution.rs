//! The settings of the search: the strategy, its length, and the settings of all strategies.

use super::cma_es::LEARNED;
use super::{
    BodyGaSettings, BodyMapElitesSettings, CmaEsSettings, CreatureGaSettings, ExplorationSettings,
    GaSettings, HalvingSettings, IslandSettings, LARGEST_POPULATION, LadderSettings,
    MapElitesSettings, MccSettings, NeatSettings, NoveltySettings, PoetSettings, QLearningSettings,
    StrategyKind, XcsRunSettings, ZcsRunSettings,
};
use crate::schema::{
    Section, SettingGroup, Walk, choice, is_default, setting_group, settings, whole,
};

setting_group! {
    /// The search: the strategy, its length, and the settings of all strategies.
    pub struct EvolutionSettings {
        /// Strategy of the search.
        strategy: StrategyKind = StrategyKind::Halving;
        /// Number of individuals per generation. The report simulated 500 to 1000. CMA-ES with restarts begins with this size and has
        /// larger generations later.
        population: u32 = 500;
        /// Number of generations in a run. The report has six. Population times generations is the budget of evaluations, so a strategy
        /// with larger generations has fewer of them.
        generations: u32 = 6;
        /// Settings of the report's method.
        halving: HalvingSettings = HalvingSettings::default();
        /// Settings of the genetic algorithm, which also makes the children of novelty search.
        ga: GaSettings = GaSettings::default();
        /// Settings of CMA-ES.
        cma_es: CmaEsSettings = CmaEsSettings::default();
        /// Settings of MAP-Elites.
        map_elites: MapElitesSettings = MapElitesSettings::default();
        /// Settings of novelty search.
        novelty: NoveltySettings = NoveltySettings::default();
        /// Settings of Q-learning.
        #[serde(default, skip_serializing_if = "is_default")]
        q_learning: QLearningSettings = QLearningSettings::default();
        /// Settings of XCS.
        #[serde(default, skip_serializing_if = "is_default")]
        xcs: XcsRunSettings = XcsRunSettings::default();
        /// Settings of ZCS.
        #[serde(default, skip_serializing_if = "is_default")]
        zcs: ZcsRunSettings = ZcsRunSettings::default();
        /// Settings of NEAT.
        #[serde(default, skip_serializing_if = "is_default")]
        neat: NeatSettings = NeatSettings::default();
        /// Settings of the genetic algorithm over bodies.
        #[serde(default, skip_serializing_if = "is_default")]
        body_ga: BodyGaSettings = BodyGaSettings::default();
        /// Settings of MAP-Elites over bodies.
        #[serde(default, skip_serializing_if = "is_default")]
        body_map_elites: BodyMapElitesSettings = BodyMapElitesSettings::default();
        /// Settings of the strategy of islands.
        #[serde(default, skip_serializing_if = "is_default")]
        islands: IslandSettings = IslandSettings::default();
        /// Settings of the genetic algorithm over creatures.
        #[serde(default, skip_serializing_if = "is_default")]
        creature_ga: CreatureGaSettings = CreatureGaSettings::default();
        /// Settings of POET.
        #[serde(default, skip_serializing_if = "is_default")]
        poet: PoetSettings = PoetSettings::default();
        /// Settings of minimal criterion coevolution.
        #[serde(default, skip_serializing_if = "is_default")]
        mcc: MccSettings = MccSettings::default();
        /// Settings of the ladder of stairs.
        #[serde(default, skip_serializing_if = "is_default")]
        ladder: LadderSettings = LadderSettings::default();
        /// Settings of exploration, common to all learners.
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
            population: if is_learned { sizes.fixed(LEARNED) } else { sizes };
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
    /// Section of the size and the length of a run.
    pub const RUN: Section = Section { title: "Run", about: "Size and length of a run." };
    /// Section of the strategy.
    pub const STRATEGY: Section = Section {
        title: "Strategy",
        about: "How each generation is created from the previous one.",
    };

    /// Returns the least share of the way at which a snake counts as having climbed its stairs, where stairs evolve.
    pub fn climbed_from(&self) -> f32 {
        match self.strategy {
            StrategyKind::Mcc => self.mcc.criterion,
            _ => self.poet.solved_from,
        }
    }

    /// Returns the number of evaluations that a run may spend.
    pub fn budget(&self) -> u64 {
        u64::from(self.population) * u64::from(self.generations)
    }
}
