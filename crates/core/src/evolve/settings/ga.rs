//! Settings of the genetic algorithm.

use super::size::LARGEST_POPULATION;
use crate::schema::{Need, choice, choices, number, setting_group, whole};

setting_group! {
    /// Settings of the genetic algorithm.
    pub struct GaSettings in "Genetic algorithm":
        "Parents are selected, crossed and mutated. Novelty search uses these settings too."
    {
        /// Selection of parents.
        selection: ParentSelection = ParentSelection::Tournament,
            choice("Selection").hint("How parents are selected");

        /// Number of candidates in a tournament.
        tournament: u32 = 3,
            whole("Tournament size", 1..=1000)
                .hint("Number of snakes drawn at random, the best of which becomes a parent. Large values converge quickly")
                .slider(1.0, 20.0);

        /// Method by which the genes of two parents form a child.
        crossover: Crossover = Crossover::Uniform,
            choice("Crossover").advanced().hint("How the genes of two parents are combined");

        /// Share of the children that have two parents. The other children are mutated copies of one parent.
        crossover_share: f32 = 0.5,
            number("Share with two parents", 0.0..=1.0).advanced()
                .hint("Share of children with two parents. The others are mutated copies of one parent")
                .slider(0.0, 1.0);

        /// Distribution of the changes of inherited genes.
        mutation: Mutation = Mutation::Gaussian,
            choice("Mutation").advanced()
                .hint("Distribution of the changes of inherited genes");

        /// Mutation step of the first generation's children, as a share of each gene's range. Later generations inherit the step, which
        /// mutates as well.
        step: f32 = 0.1,
            number("Initial mutation step", 1.0e-4..=0.5)
                .hint("As a share of each gene's range. Later generations inherit the step, which mutates as well")
                .slider(0.001, 0.5)
                .logarithmic_from(0.001)
                .fixed("Takes effect with the next run, because later generations inherit the value of the first.");

        /// Factor by which all mutation steps change per generation, in addition to their own mutation. Below 1 the search converges, as in
        /// the report's method.
        cooling: f32 = 1.0,
            number("Cooling", 0.5..=1.0).advanced()
                .hint("Factor by which mutation steps change per generation. Below 1, the search converges")
                .slider(0.5, 1.0);

        /// Number of best individuals copied unchanged into the next generation. They are evaluated again, and these evaluations count.
        elites: u32 = 2,
            whole("Elites", 0..=LARGEST_POPULATION)
                .hint("Number of best snakes copied unchanged into the next generation")
                .slider(0.0, 20.0);

        /// Probability that a child of rules replaces its least used wave by a wave of one of the best individuals. It has no effect on
        /// other controllers, nor in novelty search.
        #[serde(default = "usual_takeover", skip_serializing_if = "is_usual_takeover")]
        wave_takeover: f32 = USUAL_TAKEOVER,
            number("Wave takeover", 0.0..=1.0).advanced().needs(GaSettings::TAKEOVER)
                .hint(
                    "For the controller rules: share of children that replace their parent's least used wave by the most \
                     used one of another of the best four",
                )
                .slider(0.0, 1.0);
    }
}

impl GaSettings {
    /// The need of wave takeover. Novelty search shares all other settings of the genetic algorithm.
    pub(super) const TAKEOVER: Need = Need("children that take over waves");
}

/// Wave takeover of settings whose file does not state it.
const USUAL_TAKEOVER: f32 = 0.2;

fn usual_takeover() -> f32 {
    USUAL_TAKEOVER
}

fn is_usual_takeover(share: &f32) -> bool {
    *share == USUAL_TAKEOVER
}

choices! {
    /// Selection of parents.
    pub enum ParentSelection {
        Tournament = "tournament", "Tournament", "The best of a few snakes drawn at random.";
        /// The probability decreases linearly with the rank: the best is drawn twice as often as the median.
        Rank = "rank", "Rank", "Any snake; better ranks are more likely.";
    }
}

choices! {
    /// Method by which the genes of two parents form a child.
    pub enum Crossover {
        Uniform = "uniform", "Uniform", "Each gene comes from either parent at random.";
        OnePoint = "one_point", "One point", "Genes before a random point come from one parent, those after it from the other.";
    }
}

choices! {
    /// Distribution of the changes of inherited genes.
    pub enum Mutation {
        Gaussian = "gaussian", "Gaussian", "Mostly small steps, occasionally a large one.";
        /// The standard deviation is equal to that of Gaussian mutation.
        Uniform = "uniform", "Uniform", "Steps of any length up to a limit, all equally likely.";
    }
}
