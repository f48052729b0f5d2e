//! Settings of the learners.

use super::size::GenomeSize;
use crate::check::{Invalid, within};
use crate::learn::q_table::{ExplorationLadder, QRule};
use crate::schema::{number, setting_group};

setting_group! {
    /// How boldly the snakes of a generation of learners explore.
    pub struct ExplorationSettings in "Exploration": "How often the learning snakes take a random posture." {
        /// Share of random postures of the boldest snake in the first generation.
        first: f32 = 0.6,
            number("Random postures at first", 0.0..=1.0)
                .hint("Share of random postures that the boldest snake of the first generation takes")
                .slider(0.0, 1.0);

        /// Factor of that share from each generation to the next.
        decay: f32 = 0.985,
            number("Factor per generation", 0.5..=1.0).advanced()
                .hint("The share of random postures is multiplied by this value after each generation")
                .slider(0.9, 1.0);

        /// Least share of random postures of the boldest snake.
        least: f32 = 0.1,
            number("Random postures at least", 0.0..=1.0).advanced()
                .hint("Share of random postures below which the boldest snake never falls")
                .slider(0.0, 1.0);
    }
}

impl ExplorationSettings {
    /// The ladder from the boldest snake of a generation to the most careful one.
    pub fn ladder(&self) -> ExplorationLadder {
        let Self { first, decay, least } = *self;
        ExplorationLadder { first, decay, least_of_boldest: least, ..ExplorationLadder::default() }
    }
}

setting_group! {
    /// Settings of Q-learning.
    pub struct QLearningSettings in "Q-learning": "Learns what each posture is worth in each situation." {
        /// Power by which the learning rate falls with the visits of a pair of situation and posture.
        rate_power: f32 = 0.8,
            number("Fall of the learning rate", 0.0..=1.0).advanced()
                .hint("The learning rate is 1 over the number of visits to this power. At 0 it stays at 1")
                .slider(0.0, 1.0);

        /// Least learning rate.
        rate_floor: f32 = 0.05,
            number("Least learning rate", 0.0..=1.0)
                .hint("Below this value the learning rate does not fall: what is new always counts a little")
                .slider(0.0, 0.5);
    }
}

impl QLearningSettings {
    /// The rule of the updates.
    pub fn rule(&self) -> QRule {
        let Self { rate_power, rate_floor } = *self;
        QRule { rate_power, rate_floor, ..QRule::default() }
    }

    /// Checks that a generation of tables fits into memory.
    pub(super) fn check_size(population: u32, _: &GenomeSize<'_>) -> Result<(), Invalid> {
        within("evolution.population", population, 2..=MOST_LEARNERS)
    }
}

/// The most individuals of a generation of learners: each holds the experience of its episode, and its own copy of a table
/// while it learns.
const MOST_LEARNERS: u32 = 10_000;
