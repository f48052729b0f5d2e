//! Settings of the genetic algorithm over creatures.

use super::body_search::step_of_mutation;
use crate::schema::{number, setting_group};

setting_group! {
    /// Settings of the genetic algorithm over creatures, after Sims (1994).
    pub struct CreatureGaSettings in "Genetic algorithm of creatures":
        "Graphs of parts and neurons are mutated, crossed and grafted."
    {
        /// Share of a generation that survives and breeds. In Sims (1994) it is a fifth.
        survivors: f32 = 0.2,
            number("Survivors", 0.01..=0.9)
                .hint("Share of best creatures that pass unchanged into the next generation and breed")
                .slider(0.02, 0.5);

        /// Standard deviation of a gene's mutation, as a share of the gene's range.
        mutation_step: f32 = 0.1,
            step_of_mutation();
    }
}

impl CreatureGaSettings {
    /// Number of genes of a creature with the most nodes and neurons that are allowed, rounded up.
    pub(super) const MOST_GENES: usize = 2000;
}
