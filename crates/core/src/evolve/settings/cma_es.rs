//! Settings of CMA-ES.

use super::size::{GenomeSize, LARGEST_POPULATION, LARGEST_SAMPLE};
use crate::check::{Invalid, within};
use crate::schema::{choice, choices, number, setting_group, switch, whole};

setting_group! {
    /// Settings of CMA-ES.
    pub struct CmaEsSettings in "CMA-ES": "Learns in which directions variation pays off." {
        /// Standard deviation of the first generation, as a share of each gene's range.
        step: f32 = 0.3,
            number("Size of first mutations", 1.0e-6..=10.0)
                .hint("How much the first children differ from the snake at which the search starts, as a share of each gene's range. Small values: children are much like it")
                .slider(0.01, 1.0)
                .logarithmic_from(0.01)
                .fixed(LEARNED);

        /// Whether poor individuals also count: their directions become less likely.
        active: bool = true,
            switch("Also learn from poor snakes").advanced()
                .hint("Directions that lead to poor snakes become less likely (active CMA-ES)")
                .fixed(LEARNED);

        /// Continuation of the search after it has converged.
        restarts: RestartKind = RestartKind::Bipop,
            choice("Restarts")
                .hint("How the search continues after it has converged")
                .fixed(LEARNED);

        /// Number of random genomes in an additional first generation, the best of which is the start of the search. With 0 the search
        /// starts in the middle of all ranges.
        newborns: u32 = 0,
            // The generation of random snakes is additional to the budget.
            whole("Random snakes first", 0..=10_000)
                .hint(
                    "The search starts at the best of this many random snakes; at 0, in the middle of all ranges",
                )
                .slider(0.0, 1000.0)
                .fixed(LEARNED);
    }
}

impl CmaEsSettings {
    /// Checks that a generation fits into memory.
    pub(super) fn check_size(population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        within("evolution.population", population, 2..=LARGEST_POPULATION)?;
        size.check_population(population, LARGEST_SAMPLE)
    }
}

/// Reason why a setting on which the state of CMA-ES depends cannot change during a run.
pub const LEARNED: &str =
    "Takes effect with the next run, because the state of CMA-ES depends on it.";

choices! {
    /// Continuation of CMA-ES after a search has converged.
    pub enum RestartKind {
        None = "none", "None", "The search continues where it is.";
        /// The population grows up to 2⁹ times the first population.
        Ipop = "ipop", "Larger population", "A new search with twice the population (IPOP).";
        /// The next search is of the kind, large or small, that has used fewer evaluations. As in Hansen's pycma 4.5, the first search
        /// counts as small, and a small search ends after half of the evaluations that the large searches have used.
        Bipop = "bipop", "Larger or smaller population",
            "New searches, some with twice the population, some with a small one (BIPOP).";
    }
}
