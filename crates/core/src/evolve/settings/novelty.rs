//! Settings of novelty search.

use super::size::{GenomeSize, LARGEST_STATE_GENES};
use crate::check::{Invalid, within};
use crate::evolve::archives::{Descriptor, FIXED_LAYOUT};
use crate::schema::{choice, number, setting_group, whole};

setting_group! {
    /// Settings of novelty search. Children are made by the genetic algorithm, or by the genetic algorithm over bodies.
    pub struct NoveltySettings in "Novelty search":
        "Rewards new behaviour. Children are created with the settings of the genetic algorithm."
    {
        /// Weight of novelty: 1 is pure novelty search, 0 uses the fitness only.
        weight: f32 = 0.5,
            number("Novelty weight", 0.0..=1.0)
                .hint("1 is pure novelty search, 0 uses fitness only")
                .slider(0.0, 1.0);

        /// Number of nearest neighbours whose mean distance is the novelty.
        neighbours: u32 = 15,
            whole("Neighbours", 1..=1000)
                .hint("Novelty is the mean distance to this many of the most similar snakes")
                .slider(1.0, 50.0);

        /// Number of individuals of each generation, chosen at random, that enter the archive.
        remembered: u32 = 6,
            whole("Memory per generation", 0..=1000).advanced()
                .hint("Number of random snakes per generation kept for comparison with later ones")
                .slider(0.0, 50.0);

        /// Maximum size of the archive. When it is full, new behaviours replace random others.
        archive_limit: u32 = 2000,
            // The size is limited because each individual is compared with all members of the archive.
            whole("Memory size", 1..=20_000).advanced()
                .hint("Maximum number of snakes kept for comparison; beyond it, new ones replace others")
                .slider(100.0, 20_000.0)
                .logarithmic_from(100.0);

        /// First descriptor that distinguishes behaviours, in addition to the final position.
        first: Descriptor = Descriptor::BodyHeight,
            choice("First behaviour")
                .hint("Behaviour that distinguishes snakes, in addition to their final position")
                .fixed(FIXED_LAYOUT);

        /// Second descriptor that distinguishes behaviours.
        second: Descriptor = Descriptor::ContactDuty,
            choice("Second behaviour").hint("A second behaviour that distinguishes snakes").fixed(FIXED_LAYOUT);
    }
}

impl NoveltySettings {
    /// Checks that a generation fits into memory, and is small enough to be compared with itself and the archive.
    pub(super) fn check_size(population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        size.check_population(population, LARGEST_STATE_GENES)?;
        // The time grows with the square of the population, because each individual is compared with all others.
        within("evolution.population", population, 1..=10_000)
    }
}
