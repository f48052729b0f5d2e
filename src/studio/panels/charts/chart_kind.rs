//! The kinds of charts: their names, and their texts while they are empty.

use crate::studio::commands::hinted::hinted_values;
use snakes_core::evolve::StrategyKind;

hinted_values! {
    /// A kind of chart, in the order of the buttons. Its name is the label of its button.
    #[derive(Default)]
    pub enum ChartKind {
        #[default]
        Fitness = "Fitness", "Best, mean and median fitness of each generation";
        Spread = "Spread", "Distribution of the fitness in the latest generation";
        Endings = "Endings", "How the trials of each generation ended: landed, fell off the side, stuck and so on";
        Species = "Species", "Snakes in each species of networks (NEAT)";
        Blocks = "Blocks", "Snakes with each number of blocks, where bodies evolve";
        Bodies = "Bodies", "Ancestry of the best body, a picture at every change of its structure";
        Stairs = "Stairs", "Tree of the stairs that evolve, and transfers of snakes between them (POET)";
        Ancestors = "Ancestors", "Ancestors of the best snake";
        Torques = "Torques",
            "Joint torques of the snake on the stage and of its parent; of several, of the selected one";
        Parents = "Parents", "Gene values of the parents of the next generation";
        Front = "Effort", "Best trade-offs between distance and energy";
        Archive = "Kinds", "Best snake for each kind of behaviour (MAP-Elites)";
        Runs = "Runs", "Compare this run with other runs";
        Methods = "Compare methods", "Compare search methods over many runs";
    }
}

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

    /// Returns the text that is shown while there is no data.
    pub fn empty_text(self) -> String {
        let first = " after the first generation";
        let logged = " after the first generation. Runs of earlier versions of the program have none in their logs";
        let (what, when) = match self {
            Self::Fitness => ("fitness of each generation", first),
            Self::Spread => {
                ("distribution of the fitness", " when this session finishes a generation")
            }
            Self::Endings => ("ways in which the trials of each generation ended", logged),
            Self::Species => ("species of each generation", logged),
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
