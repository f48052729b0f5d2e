//! The list of strategies, with the facts about each that are known without a search.

use serde::{Deserialize, Serialize};

use super::halving::HalvingSettings;
use super::learning::check_learners;
use super::size::{LARGEST_GENERATION_GENES, LARGEST_STATE_GENES};
use super::{
    CmaEsSettings, CreatureGaSettings, EvolutionSettings, GenomeSize, NeatSettings, NoveltySettings,
};
use crate::check::Invalid;
use crate::genome::ControllerKind;
use crate::schema::named_by_info;

/// Facts about a strategy that are the same for all its runs.
#[derive(Debug, Clone, Copy)]
pub struct StrategyInfo {
    /// Name in files and flags; flags may write - for _.
    pub name: &'static str,
    /// Name at the head of a list or a chart.
    pub title: &'static str,
    /// Sentence about how the strategy searches.
    pub words: &'static str,
    /// Colour of the strategy's curves: red, green and blue. The first five strategies have colours of Okabe and Ito, which remain distinct
    /// for colour-blind people.
    pub color: [u8; 3],
    /// Groups of settings below `evolution` that the strategy uses, its own group first.
    pub settings: &'static [&'static str],
    /// Whether the strategy chooses the size of each generation itself. The population is then the size of the first generation, or only
    /// counts for the budget. The run ends when the budget of population times generations is spent.
    pub is_budget_driven: bool,
    /// Whether the population must stay constant during a run.
    pub has_fixed_population: bool,
    /// Kinds of controllers that only this strategy, or another learner or search of structure, improves. Empty for strategies that evolve
    /// genes of other kinds.
    pub only_controllers: &'static [ControllerKind],
    /// Whether the strategy keeps an archive of elites over two axes.
    pub has_archive: bool,
    /// Whether the strategy varies bodies.
    pub varies_bodies: bool,
    /// Whether the strategy's individuals belong to species.
    pub has_species: bool,
    /// Whether the strategy evolves stairs, so that individuals have stairs of their own.
    pub evolves_stairs: bool,
    /// Number of generations in a comparison, if more generations would not continue the search. None: any number.
    pub compared_generations: Option<u32>,
    /// Checks that the strategy's generations and its state fit into memory.
    pub check_size: fn(&EvolutionSettings, &GenomeSize<'_>) -> Result<(), Invalid>,
}

impl StrategyInfo {
    /// Default row, of a strategy of points whose state is no larger than a generation.
    const PLAIN: Self = Self {
        name: "",
        title: "",
        words: "",
        color: [0; 3],
        settings: &[],
        is_budget_driven: false,
        has_fixed_population: false,
        only_controllers: &[],
        has_archive: false,
        varies_bodies: false,
        has_species: false,
        evolves_stairs: false,
        compared_generations: None,
        check_size: |evolution, size| {
            size.check_population(evolution.population, LARGEST_GENERATION_GENES)
        },
    };
}

/// Declares [`StrategyKind`] from one row for each strategy, in the order of lists.
macro_rules! strategy_kinds {
    ($($(#[$meta:meta])* $kind:ident = $info:expr;)*) => {
        /// The strategies. Files store their names.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum StrategyKind { $($(#[$meta])* $kind,)* }

        impl StrategyKind {
            /// All strategies, the report's method first.
            pub const ALL: [Self; [$(Self::$kind),*].len()] = [$(Self::$kind),*];

            /// Returns the facts about the strategy.
            pub fn info(self) -> &'static StrategyInfo {
                match self { $(Self::$kind => const { &$info },)* }
            }
        }
    };
}

strategy_kinds! {
    /// The report's method: children of the best few individuals, within a mutation range that halves with each generation.
    #[default]
    Halving = StrategyInfo {
        name: "halving",
        title: "Halving (the report's)",
        words: "The best few become parents; children vary at random within a range that halves each generation.",
        color: [0xd5, 0x5e, 0x00],
        settings: &["halving"],
        compared_generations: Some(HalvingSettings::REPORT_GENERATIONS),
        check_size: |evolution, size| evolution.halving.check_size(evolution.population, size),
        ..StrategyInfo::PLAIN
    };
    /// A genetic algorithm over real-valued genes, with self-adapted mutation steps.
    Ga = StrategyInfo {
        name: "ga",
        title: "Genetic algorithm",
        words: "Parents are selected, crossed and mutated; the mutation step evolves as well.",
        color: [0x00, 0x9e, 0x73],
        settings: &["ga"],
        check_size: |evolution, size| {
            size.check_population(evolution.population, LARGEST_STATE_GENES)
        },
        ..StrategyInfo::PLAIN
    };
    /// CMA-ES: covariance matrix adaptation evolution strategy.
    CmaEs = StrategyInfo {
        name: "cma_es",
        title: "CMA-ES",
        words: "Covariance matrix adaptation: learns in which directions variation pays off.",
        color: [0x00, 0x72, 0xb2],
        settings: &["cma_es"],
        is_budget_driven: true,
        check_size: |evolution, size| CmaEsSettings::check_size(evolution.population, size),
        ..StrategyInfo::PLAIN
    };
    /// MAP-Elites: an archive of the best individual of each kind of behaviour.
    MapElites = StrategyInfo {
        name: "map_elites",
        title: "MAP-Elites",
        words: "Keeps the best snake for each kind of behaviour and breeds from all of them.",
        color: [0xcc, 0x79, 0xa7],
        settings: &["map_elites"],
        has_archive: true,
        check_size: |evolution, size| evolution.map_elites.check_size(evolution.population, size),
        ..StrategyInfo::PLAIN
    };
    /// Novelty search, whose children the genetic algorithm makes.
    Novelty = StrategyInfo {
        name: "novelty",
        title: "Novelty search",
        words: "Rewards new behaviour, mixed with fitness in any proportion.",
        color: [0xe6, 0x9f, 0x00],
        settings: &["novelty", "ga"],
        check_size: |evolution, size| NoveltySettings::check_size(evolution.population, size),
        ..StrategyInfo::PLAIN
    };
    /// Random search, the baseline for every other strategy.
    Random = StrategyInfo {
        name: "random",
        title: "Random",
        words: "Draws every genome at random: the baseline for every other strategy.",
        color: [0x80, 0x80, 0x80],
        ..StrategyInfo::PLAIN
    };
    /// NEAT: evolution of networks that grow.
    Neat = StrategyInfo {
        name: "neat",
        title: "NEAT",
        words: "Grows networks from nothing but links; species protect what is new.",
        color: [0xe0, 0x00, 0xe0],
        settings: &["neat"],
        has_fixed_population: true,
        only_controllers: &[ControllerKind::Grown],
        has_species: true,
        check_size: |evolution, _| NeatSettings::check_size(evolution.population),
        ..StrategyInfo::PLAIN
    };
    /// Tabular Q-learning with one table, from which all episodes act and learn.
    QLearning = StrategyInfo {
        name: "q_learning",
        title: "Q-learning",
        words: "Learns by trial and error what each posture is worth in each situation.",
        color: [0x20, 0x80, 0x00],
        settings: &["q_learning", "exploration"],
        only_controllers: &[ControllerKind::Decisions],
        check_size: |evolution, _| check_learners(evolution.population),
        ..StrategyInfo::PLAIN
    };
    /// XCS with one population of rules, from which all episodes act and learn.
    Xcs = StrategyInfo {
        name: "xcs",
        title: "XCS",
        words: "Learns rules that predict accurately what a posture is worth, and breeds from them.",
        color: [0x60, 0x20, 0xe0],
        settings: &["xcs", "exploration"],
        only_controllers: &[ControllerKind::Decisions, ControllerKind::JointDecisions],
        check_size: |evolution, _| check_learners(evolution.population),
        ..StrategyInfo::PLAIN
    };
    /// ZCS with one population of rules, from which all episodes act and learn.
    Zcs = StrategyInfo {
        name: "zcs",
        title: "ZCS",
        words: "Learns rules that grow stronger with what they earn, and breeds from the strong.",
        color: [0x80, 0xe0, 0x40],
        settings: &["zcs", "exploration"],
        only_controllers: &[ControllerKind::Decisions],
        check_size: |evolution, _| check_learners(evolution.population),
        ..StrategyInfo::PLAIN
    };
    /// A genetic algorithm over bodies and their controllers.
    BodyGa = StrategyInfo {
        name: "body_ga",
        title: "Genetic algorithm of bodies",
        words: "Blocks come, go, divide and merge; new bodies are protected while they learn to move.",
        color: [0x50, 0xc0, 0xe0],
        settings: &["body_ga"],
        varies_bodies: true,
        check_size: |evolution, size| {
            size.check_population(evolution.population, LARGEST_STATE_GENES)
        },
        ..StrategyInfo::PLAIN
    };
    /// Novelty search over behaviours and bodies, whose children the genetic algorithm over bodies makes.
    BodyNovelty = StrategyInfo {
        name: "body_novelty",
        title: "Novelty search of bodies",
        words: "Rewards new behaviour, numbers of blocks and lengths, mixed with fitness in any proportion.",
        color: [0x40, 0x70, 0xf0],
        settings: &["novelty", "body_ga"],
        varies_bodies: true,
        check_size: |evolution, size| NoveltySettings::check_size(evolution.population, size),
        ..StrategyInfo::PLAIN
    };
    /// MAP-Elites over the number of blocks and the length of a body.
    BodyMapElites = StrategyInfo {
        name: "body_map_elites",
        title: "MAP-Elites of bodies",
        words: "Keeps the best snake of each number of blocks and each length, and breeds from all of them.",
        color: [0x20, 0x60, 0x70],
        settings: &["body_map_elites"],
        has_archive: true,
        varies_bodies: true,
        check_size: |evolution, size| {
            evolution.body_map_elites.check_size(evolution.population, size)
        },
        ..StrategyInfo::PLAIN
    };
    /// Islands: a CMA-ES for each number of blocks.
    Islands = StrategyInfo {
        name: "islands",
        title: "Islands",
        words: "A CMA-ES for each number of blocks; the best of them get the evaluations.",
        color: [0xf0, 0x40, 0x50],
        settings: &["islands"],
        is_budget_driven: true,
        varies_bodies: true,
        check_size: |evolution, size| {
            let EvolutionSettings { population, generations, .. } = *evolution;
            evolution.islands.check_size([population, generations], size)
        },
        ..StrategyInfo::PLAIN
    };
    /// POET: pairs of stairs and snakes.
    Poet = StrategyInfo {
        name: "poet",
        title: "POET",
        words: "The stairs evolve, too: each has a snake that learns to climb it, and snakes move to stairs that they climb better.",
        color: [0x30, 0x40, 0xb0],
        settings: &["poet"],
        is_budget_driven: true,
        evolves_stairs: true,
        check_size: |evolution, size| evolution.poet.check_size(size),
        ..StrategyInfo::PLAIN
    };
    /// POET with pairs of stairs and snakes whose bodies evolve.
    BodyPoet = StrategyInfo {
        name: "body_poet",
        title: "POET with bodies",
        words: "POET whose snakes also change their bodies; the genetic algorithm over bodies makes their children.",
        color: [0xf0, 0x20, 0x90],
        settings: &["poet", "body_ga"],
        is_budget_driven: true,
        evolves_stairs: true,
        varies_bodies: true,
        check_size: |evolution, size| evolution.poet.check_size(size),
        ..StrategyInfo::PLAIN
    };
    /// Minimal criterion coevolution, with a queue of snakes and a queue of stairs.
    Mcc = StrategyInfo {
        name: "mcc",
        title: "Minimal criterion coevolution",
        words: "Stairs and snakes evolve without fitness: a snake has children if it climbs some stairs, and stairs have mutants if a snake climbs them.",
        color: [0xc0, 0x50, 0xd0],
        settings: &["mcc"],
        is_budget_driven: true,
        evolves_stairs: true,
        check_size: |evolution, size| evolution.mcc.check_size(size),
        ..StrategyInfo::PLAIN
    };
    /// A genetic algorithm over graphs that grow into creatures with branching bodies.
    CreatureGa = StrategyInfo {
        name: "creature_ga",
        title: "Genetic algorithm of creatures",
        words: "Breeds graphs that grow into branching bodies with neurons in each part, after Karl Sims.",
        color: [0x80, 0x40, 0x00],
        settings: &["creature_ga"],
        only_controllers: &[ControllerKind::PartNeurons],
        varies_bodies: true,
        check_size: |evolution, size| {
            let (population, genes) = (evolution.population, CreatureGaSettings::MOST_GENES);
            size.check_count("evolution.population", population, genes, LARGEST_STATE_GENES)
        },
        ..StrategyInfo::PLAIN
    };
}

named_by_info!(StrategyKind);
