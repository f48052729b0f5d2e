//! The kinds of charts: their names, and their texts while they are empty.

use snakes_core::evolve::StrategyKind;

/// A kind of chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum ChartKind {
    #[default]
    Fitness,
    Spread,
    Species,
    Blocks,
    Bodies,
    Stairs,
    Ancestors,
    Torques,
    Parents,
    Front,
    Archive,
    Runs,
    Methods,
}

/// All kinds of charts, in the order of their buttons, with the label of the button and its tooltip.
pub(super) const CHART_KINDS: [(ChartKind, &str, &str); 13] = [
    (ChartKind::Fitness, "Fitness", "Best, mean and median fitness of each generation"),
    (ChartKind::Spread, "Spread", "Distribution of the fitness in the latest generation"),
    (ChartKind::Species, "Species", "Snakes in each species of networks (NEAT)"),
    (ChartKind::Blocks, "Blocks", "Snakes with each number of blocks, where bodies evolve"),
    (
        ChartKind::Bodies,
        "Bodies",
        "Ancestry of the best body, a picture at every change of its structure",
    ),
    (
        ChartKind::Stairs,
        "Stairs",
        "Tree of the stairs that evolve, and transfers of snakes between them (POET)",
    ),
    (ChartKind::Ancestors, "Ancestors", "Ancestors of the best snake"),
    (
        ChartKind::Torques,
        "Torques",
        "Joint torques of the snake on the stage and of its parent; of several, of the selected one",
    ),
    (ChartKind::Parents, "Parents", "Gene values of the parents of the next generation"),
    (ChartKind::Front, "Effort", "Best trade-offs between distance and energy"),
    (ChartKind::Archive, "Kinds", "Best snake for each kind of behaviour (MAP-Elites)"),
    (ChartKind::Runs, "Runs", "Compare this run with other runs"),
    (ChartKind::Methods, "Compare methods", "Compare search methods over many runs"),
];

impl ChartKind {
    /// Returns whether runs of this strategy have data for a chart of this kind. `has_study` tells whether a study of
    /// methods is open.
    pub fn is_offered(self, strategy: StrategyKind, has_study: bool) -> bool {
        match self {
            Self::Methods => has_study,
            Self::Archive => strategy.info().has_archive,
            Self::Parents if [StrategyKind::Random, StrategyKind::CmaEs].contains(&strategy) => {
                false
            }
            Self::Species => strategy.info().has_species,
            Self::Blocks | Self::Bodies => strategy.info().varies_bodies,
            Self::Stairs => strategy.info().evolves_stairs,
            // Where stairs evolve, distances on different stairs cannot be compared, and parents are not recorded.
            Self::Front | Self::Ancestors | Self::Parents => !strategy.info().evolves_stairs,
            _ => true,
        }
    }

    /// Returns the label of the button.
    pub fn name(self) -> &'static str {
        CHART_KINDS[self as usize].1
    }

    /// Returns the text that is shown while there is no data.
    pub fn empty_text(self) -> String {
        let first = " after the first generation";
        let (what, when) = match self {
            Self::Fitness => ("fitness of each generation", first),
            Self::Spread => {
                ("distribution of the fitness", " when this session finishes a generation")
            }
            Self::Species => (
                "species of each generation",
                " after the first generation. Runs of earlier versions of the program have none in their logs",
            ),
            Self::Blocks => ("numbers of blocks of each generation", first),
            Self::Bodies => ("ancestry of the best body", first),
            Self::Stairs => ("stairs that evolve", first),
            Self::Ancestors => ("ancestors of the best snake", first),
            Self::Torques => return "Computing torques…".to_owned(),
            Self::Parents => (
                "gene values of the parents",
                " when this session finishes a generation. Random search and CMA-ES have no parents",
            ),
            Self::Front => ("best trade-offs between distance and energy", ""),
            Self::Archive => ("best snake for each kind of behaviour", ""),
            Self::Runs => ("curves of this run", first),
            Self::Methods => return "This study has no finished runs.".to_owned(),
        };
        format!("The {what} will appear here{when}.")
    }
}
