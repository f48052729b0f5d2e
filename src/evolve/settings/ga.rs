//! Settings of the genetic algorithm.

use serde::{Deserialize, Serialize};

use super::size::{GenomeSize, LARGEST_POPULATION, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::schema::{Choice, Choices, Section, SettingGroup, Walk, choice, number, whole};

/// Settings of the genetic algorithm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaSettings {
    /// How parents are chosen.
    pub selection: ParentSelection,
    /// Number of candidates in a tournament.
    pub tournament: u32,
    /// How two parents make one child.
    pub crossover: Crossover,
    /// Share of the children that have two parents; the others are copies of one before they mutate.
    pub crossover_share: f32,
    /// How a child's genes differ from what it inherited.
    pub mutation: Mutation,
    /// Step of mutation of the first generation's children, as a share of each gene's range. Later it is
    /// inherited and mutates itself.
    pub step: f32,
    /// Factor of all steps with each generation, in addition to their evolution. Below 1 the search converges, as in
    /// the report's method.
    pub cooling: f32,
    /// Number of the best that are copied unchanged. They are evaluated again and count.
    pub elites: u32,
}

/// How parents are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ParentSelection {
    /// The best of a few random candidates.
    Tournament,
    /// In proportion to rank: the best twice as often as the middle one, the worst hardly ever.
    Rank,
}

/// How two parents make one child.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Crossover {
    /// Each gene comes from either parent.
    Uniform,
    /// The genes before a random point come from one parent, those after it from the other.
    OnePoint,
}

/// How genes mutate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mutation {
    /// By a normally distributed step.
    Gaussian,
    /// By a uniformly distributed step of the same standard deviation.
    Uniform,
}

impl Default for GaSettings {
    fn default() -> Self {
        Self {
            selection: ParentSelection::Tournament,
            tournament: 3,
            crossover: Crossover::Uniform,
            crossover_share: 0.5,
            mutation: Mutation::Gaussian,
            step: 0.1,
            cooling: 1.0,
            elites: 2,
        }
    }
}

impl GaSettings {
    /// The section of these settings.
    pub const SECTION: Section = Section {
        title: "Genetic algorithm",
        about: "Parents are selected, crossed and mutated. Novelty search uses these settings too.",
    };

    /// Checks that a generation and what is known of the one before fit into memory.
    pub(super) fn check_size(population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        let genes = size.coordinates();
        size.check_generation(population, genes)?;
        size.check_count("evolution.population", population, genes, LARGEST_STATE_GENES)
    }
}

impl SettingGroup for GaSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self {
            selection,
            tournament,
            crossover,
            crossover_share,
            mutation,
            step,
            cooling,
            elites,
        } = self;
        walk.section(Self::SECTION);
        walk.setting(choice("selection", "Selection").hint("How parents are selected"), selection);
        walk.setting(
            whole("tournament", "Tournament", 1..=1000)
                .hint("Number of snakes drawn at random, the best of which becomes a parent. Large values converge quickly")
                .slider(1.0, 20.0),
            tournament,
        );
        walk.setting(
            choice("crossover", "Crossover").hint("How the genes of two parents are combined"),
            crossover,
        );
        walk.setting(
            number("crossover_share", "Share with two parents", 0.0..=1.0)
                .hint("Share of children with two parents. The others are mutated copies of one parent")
                .slider(0.0, 1.0),
            crossover_share,
        );
        walk.setting(
            choice("mutation", "Mutation").hint("Distribution of the changes of inherited genes"),
            mutation,
        );
        walk.setting(
            number("step", "Initial mutation size", 1.0e-4..=0.5)
                .hint("As a share of each gene's range. Later generations inherit the step, which mutates as well")
                .slider(0.001, 0.5)
                .logarithmic_from(0.001)
                .fixed("Takes effect with the next run, because later generations inherit the value of the first."),
            step,
        );
        walk.setting(
            number("cooling", "Cooling", 0.5..=1.0)
                .hint("Factor by which mutation steps change per generation. Below 1, the search converges")
                .slider(0.5, 1.0),
            cooling,
        );
        walk.setting(
            whole("elites", "Elites", 0..=LARGEST_POPULATION)
                .hint("Number of best snakes copied unchanged into the next generation")
                .slider(0.0, 20.0),
            elites,
        );
    }
}

impl Choices for ParentSelection {
    const OPTIONS: &'static [Self] = &[Self::Tournament, Self::Rank];

    fn choice(self) -> Choice {
        match self {
            Self::Tournament => {
                Choice::new("tournament", "Tournament", "The best of a few snakes drawn at random.")
            }
            Self::Rank => {
                let about = "Any snake; better ranks are more likely.";
                Choice::new("rank", "Rank", about)
            }
        }
    }
}

impl Choices for Crossover {
    const OPTIONS: &'static [Self] = &[Self::Uniform, Self::OnePoint];

    fn choice(self) -> Choice {
        match self {
            Self::Uniform => {
                Choice::new("uniform", "Uniform", "Each gene comes from either parent at random.")
            }
            Self::OnePoint => {
                let about = "Genes before a random point come from one parent, those after it from the other.";
                Choice::new("one_point", "One point", about)
            }
        }
    }
}

impl Choices for Mutation {
    const OPTIONS: &'static [Self] = &[Self::Gaussian, Self::Uniform];

    fn choice(self) -> Choice {
        match self {
            Self::Gaussian => {
                Choice::new("gaussian", "Gaussian", "Mostly small steps, occasionally a large one.")
            }
            Self::Uniform => {
                let about = "Steps of any length up to a limit, all equally likely.";
                Choice::new("uniform", "Uniform", about)
            }
        }
    }
}
