//! The source of all random numbers of the program.
//!
//! A stream is identified by run seed, generation, individual and purpose, never by the time of the
//! request. The numbers of an individual therefore do not depend on the number of threads, on the order
//! of evaluation, or on an open window.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Purpose of a random stream. New purposes may be added, but the discriminant of a purpose never changes, because it is part of the
/// stream's key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Drawing a random genome.
    Birth = 1,
    /// Varying a parent into a child.
    Mutation = 2,
    /// Drawing the points of `snakes verify`.
    Calibration = 3,
    /// Perturbing a trial to measure the robustness of a champion.
    Perturbation = 4,
    /// Perturbing the repeated trials of an evaluation.
    Repeat = 5,
    /// Drawing a point of a search distribution.
    Sample = 6,
    /// Drawing the start of a restarted search.
    Restart = 7,
    /// Choosing among the members of an archive.
    Archive = 8,
    /// Drawing the shoves of an exam.
    Shove = 9,
    /// Drawing the trials that all individuals of a generation have in common.
    Stairs = 10,
    /// Exploring actions in an episode.
    Explore = 11,
    /// Learning from the episodes of a generation.
    Learn = 12,
    /// Choosing the genes that a study or a tuning changes.
    Study = 13,
    /// Drawing the irregularities of a staircase.
    StairNoise = 14,
    /// Drawing the held-out staircases of the exam, which no run may use.
    HeldOutStairs = 15,
    /// Drawing mutants of stairs.
    StairsMutation = 16,
    /// Drawing the seed of a search within a strategy that evolves stairs.
    Pair = 17,
    /// Drawing a staircase from a seed in the editor.
    StairsDice = 18,
    /// Drawing the faults of a snake's drives, and pushes from the side.
    Drives = 19,
}

/// Returns the stream of random numbers for one purpose of one individual of one generation.
///
/// The four numbers form the ChaCha8 key itself, so two streams are equal only if all four numbers are equal.
pub fn stream(run_seed: u64, generation: u32, individual: u32, purpose: Purpose) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[0..8].copy_from_slice(&run_seed.to_le_bytes());
    key[8..16].copy_from_slice(&u64::from(generation).to_le_bytes());
    key[16..24].copy_from_slice(&u64::from(individual).to_le_bytes());
    key[24..32].copy_from_slice(&(purpose as u64).to_le_bytes());
    ChaCha8Rng::from_seed(key)
}

/// Draws a uniformly distributed number from 0 to less than 1.
pub fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    rng.random_range(0.0..1.0)
}

/// Draws an element of a list that is not empty, all equally likely.
pub fn drawn<T: Copy>(all: &[T], rng: &mut ChaCha8Rng) -> T {
    all[rng.random_range(0..all.len())]
}

/// Draws a normally distributed number of mean 0 and variance 1, by the method of Box and Muller (1958).
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    // The difference lies in (0, 1], where the logarithm is finite.
    let first = 1.0 - uniform(rng);
    let second = uniform(rng);
    (-2.0 * libm::log(first)).sqrt() * libm::cos(std::f64::consts::TAU * second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    #[test]
    fn each_part_of_a_streams_key_changes_its_numbers() {
        let first = |seed, generation, individual, purpose| {
            stream(seed, generation, individual, purpose).next_u64()
        };
        let reference = first(1, 2, 3, Purpose::Birth);
        assert_eq!(reference, first(1, 2, 3, Purpose::Birth));
        assert_ne!(reference, first(2, 2, 3, Purpose::Birth));
        assert_ne!(reference, first(1, 3, 3, Purpose::Birth));
        assert_ne!(reference, first(1, 2, 4, Purpose::Birth));
        assert_ne!(reference, first(1, 2, 3, Purpose::Mutation));
    }
}
