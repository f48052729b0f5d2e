//! Settings of CMA-ES.

use super::size::{GenomeSize, LARGEST_POPULATION, LARGEST_SAMPLE};
use crate::check::{Invalid, within};
use crate::schema::{choice, choices, number, setting_group, switch, whole};

setting_group! {
    /// Settings of CMA-ES.
    pub struct CmaEsSettings in "CMA-ES": "Learns in which directions variation pays off." {
        /// Standard deviation of the first generation, as a share of each gene's range.
        step: f32 = 0.3,
            number("Initial step size", 1.0e-6..=10.0)
                .hint("Spread of the first generation, as a share of each gene's range. Small steps search nearby")
                .slider(0.01, 1.0)
                .logarithmic_from(0.01)
                .fixed(LEARNED);

        /// Whether bad individuals count too, by making their directions less likely.
        active: bool = true,
            switch("Also learn from poor snakes").advanced()
                .hint("Directions that lead to poor snakes become less likely (active CMA-ES)")
                .fixed(LEARNED);

        /// The reaction when a search has ended.
        restarts: RestartKind = RestartKind::Bipop,
            choice("Restarts")
                .hint("How the search continues after it has converged")
                .fixed(LEARNED);

        /// Number of random genomes in a first generation of their own, the best of which is the start of the search. 0:
        /// the search starts in the middle of all ranges.
        newborns: u32 = 0,
            // The random snakes are a generation of their own, beyond the budget.
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

/// Why a run keeps what its CMA-ES began with.
pub const LEARNED: &str =
    "Takes effect with the next run, because the state of CMA-ES depends on it.";

choices! {
    /// The reaction when a search has ended.
    pub enum RestartKind {
        None = "none", "None", "The search continues where it is.";
        /// At most 2⁹ times the first population.
        Ipop = "ipop", "Larger population", "A new search with twice the population (IPOP).";
        /// The next is of the kind that has used fewer evaluations. As in Hansen's pycma 4.5, the first search counts
        /// as small, and a small one ends after half of the evaluations that the large ones have used.
        Bipop = "bipop", "Larger or smaller population",
            "New searches, some with twice the population, some with a small one (BIPOP).";
    }
}
