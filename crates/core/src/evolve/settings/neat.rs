//! Settings of NEAT.

use super::cma_es::LEARNED;
use crate::check::{Invalid, within};
use crate::learn::neat::{LARGEST_NEAT_POPULATION, NeatRules};
use crate::schema::{number, setting_group, whole};

setting_group! {
    /// Settings of NEAT.
    pub struct NeatSettings in "NEAT": "Grows networks node by node; similar ones form species." {
        /// Probability that a child's network has one more node than its parent's.
        add_node: f32 = 0.03,
            number("New nodes", 0.0..=1.0)
                .hint("Probability that a child's network has one more node")
                .slider(0.0, 0.3)
                .fixed(LEARNED);

        /// Probability that a child's network has one more link than its parent's.
        add_link: f32 = 0.05,
            number("New links", 0.0..=1.0)
                .hint("Probability that a child's network has one more link")
                .slider(0.0, 0.5)
                .fixed(LEARNED);

        /// Maximum change of a link's weight from parent to child.
        weight_step: f32 = 2.5,
            number("Weight step", 0.001..=100.0)
                .hint("Maximum change of a link's weight from parent to child")
                .slider(0.01, 5.0)
                .logarithmic_from(0.01)
                .fixed(LEARNED);

        /// Distance between two networks below which they belong to the same species, in the first generation.
        species_threshold: f32 = 3.0,
            number("Species threshold", 0.01..=100.0).advanced()
                .hint("Networks closer to each other than this belong to the same species")
                .slider(0.1, 10.0)
                .fixed(LEARNED);

        /// Number of species towards which the threshold is adjusted. With 0 the threshold stays constant.
        species: u32 = 10,
            whole("Species", 0..=1000).advanced()
                .hint("The threshold is adjusted towards this number of species; at 0 it stays")
                .slider(0.0, 30.0)
                .fixed(LEARNED);

        /// Number of generations without progress after which a species ends.
        stagnation: u32 = 15,
            whole("Generations without progress", 1..=10_000).advanced()
                .hint("A species ends after this many generations without a better network")
                .slider(1.0, 50.0)
                .fixed(LEARNED);
    }
}

impl NeatSettings {
    /// Returns the rules of the search.
    pub fn rules(&self) -> NeatRules {
        let Self { add_node, add_link, weight_step, species_threshold, species, stagnation } =
            *self;
        NeatRules {
            add_node: add_node.into(),
            add_link: add_link.into(),
            weight_step,
            species_threshold: species_threshold.into(),
            species_goal: species,
            stagnation_generations: stagnation,
            ..NeatRules::default()
        }
    }

    /// Checks that a generation fits into memory.
    pub(super) fn check_size(population: u32) -> Result<(), Invalid> {
        within("evolution.population", population, 2..=LARGEST_NEAT_POPULATION as u32)
    }
}
