//! Settings of the report's method.

use super::size::{GenomeSize, LARGEST_GENERATION_GENES, LARGEST_POPULATION, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::schema::{number, setting_group, whole};

setting_group! {
    /// Settings of the report's method.
    pub struct HalvingSettings in "Halving (the report's)":
        "The best few become parents; children vary at random within a range that shrinks each generation."
    {
        /// Number of best individuals that become parents. The report has four.
        parents: u32 = 4,
            whole("Parents", 1..=LARGEST_POPULATION)
                .hint("Number of best snakes that become parents. Few converge quickly, many keep more variety")
                .slider(1.0, 50.0);

        /// Mutation range of the second generation, in N·m. The report has 100.
        mutation_range_nm: f32 = 100.0,
            number("Mutation range", 0.0..=1.0e6)
                .unit("N·m")
                .hint("Maximum difference between parents and the children of the second generation")
                .slider(0.0, 1000.0);

        /// Factor by which the mutation range changes with each further generation. The report has 0.5.
        mutation_decay: f32 = 0.5,
            number("Mutation decay", 0.0..=1.0)
                .hint("Factor by which the range changes per generation: 0.5 halves it, 1 keeps it")
                .slider(0.0, 1.0);
    }
}

impl HalvingSettings {
    /// Number of generations of the report's run. The mutation range halves with each, so that later generations would hardly differ.
    pub const REPORT_GENERATIONS: u32 = 6;

    /// Checks that a generation and its parents fit into memory.
    pub(super) fn check_size(&self, population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        let genes = size.genes();
        size.check_count("evolution.population", population, genes, LARGEST_GENERATION_GENES)?;
        let parents = self.parents.min(population);
        size.check_count("evolution.halving.parents", parents, genes, LARGEST_STATE_GENES)
    }
}
