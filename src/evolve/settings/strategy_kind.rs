//! A row of the list of strategies: the facts about a strategy that need no search.

use super::size::LARGEST_GENERATION_GENES;
use super::{EvolutionSettings, GenomeSize};
use crate::check::Invalid;
use crate::genome::ControllerKind;

/// The facts about a strategy that are the same for all its runs.
#[derive(Debug, Clone, Copy)]
pub struct StrategyInfo {
    /// The name in files and flags; flags may write - for _.
    pub name: &'static str,
    /// The name at the head of a list or a chart.
    pub title: &'static str,
    /// A sentence about how it searches.
    pub words: &'static str,
    /// The colour of its curves: red, green and blue. The six colours of the first six strategies are those of
    /// Okabe and Ito, which remain distinct for colour-blind people.
    pub color: [u8; 3],
    /// The groups of settings below `evolution` that it uses, its own first.
    pub settings: &'static [&'static str],
    /// Whether it chooses the size of each generation itself. The population is then the size of the first, or
    /// only counts for the budget, and the run ends when the evaluations are spent that population and generations allow.
    pub is_budget_driven: bool,
    /// Whether its population stays the same during a run.
    pub has_fixed_population: bool,
    /// The only kinds of controllers that it improves, which no strategy of genes does; empty for all others.
    pub only_controllers: &'static [ControllerKind],
    /// Whether it keeps an archive of elites over two descriptors.
    pub has_archive: bool,
    /// Whether it varies bodies, which no other strategy can.
    pub varies_bodies: bool,
    /// Whether its individuals belong to species.
    pub has_species: bool,
    /// Number of generations in a comparison, where more would not continue the search; none for any number.
    pub compared_generations: Option<u32>,
    /// Checks that its generations and its state fit into memory.
    pub check_size: fn(&EvolutionSettings, &GenomeSize<'_>) -> Result<(), Invalid>,
}

impl StrategyInfo {
    /// The row of a strategy of points that keeps no more than its generation.
    pub(super) const PLAIN: Self = Self {
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
        compared_generations: None,
        check_size: |evolution, size| {
            size.check_population(evolution.population, LARGEST_GENERATION_GENES)
        },
    };
}

/// Makes [`StrategyKind`](super::StrategyKind) from one row for each strategy, in the order of lists.
macro_rules! strategy_kinds {
    ($($(#[$meta:meta])* $kind:ident = $info:expr;)*) => {
        /// The strategies. Files store the name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum StrategyKind { $($(#[$meta])* $kind,)* }

        impl StrategyKind {
            /// All of them, the report's first.
            pub const ALL: [Self; [$(Self::$kind),*].len()] = [$(Self::$kind),*];

            /// Its row of the list.
            pub fn info(self) -> &'static StrategyInfo {
                match self { $(Self::$kind => const { &$info },)* }
            }
        }
    };
}
pub(super) use strategy_kinds;
