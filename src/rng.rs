//! Where every random number of the program comes from.
//!
//! A stream is named by what it is for (run seed, generation, individual, purpose), never by when it
//! is asked for. So the numbers an individual gets do not depend on how many threads ran before it,
//! in which order, or whether a window was open.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// What a random stream is used for. The numbers are part of the determinism promise: they may be
/// added to, never changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Drawing an individual from nothing.
    Birth = 1,
    /// Varying a parent into a child.
    Mutation = 2,
    /// Drawing a candidate of the search for settings.
    Calibration = 3,
    /// Putting a trial off, to see how robust a champion is.
    Perturbation = 4,
    /// Putting the further trials of an evaluation off.
    Repeat = 5,
    /// Drawing a point of a search distribution.
    Sample = 6,
    /// Drawing where a search begins again.
    Restart = 7,
    /// Choosing what is kept in an archive.
    Archive = 8,
}

/// The stream of random numbers for one purpose of one individual of one generation.
///
/// The four numbers are the ChaCha8 key itself, so two streams are equal only if all four are.
pub fn stream(run_seed: u64, generation: u32, individual: u32, purpose: Purpose) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[0..8].copy_from_slice(&run_seed.to_le_bytes());
    key[8..16].copy_from_slice(&u64::from(generation).to_le_bytes());
    key[16..24].copy_from_slice(&u64::from(individual).to_le_bytes());
    key[24..32].copy_from_slice(&(purpose as u64).to_le_bytes());
    ChaCha8Rng::from_seed(key)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    #[test]
    fn every_part_of_a_streams_name_changes_its_numbers() {
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
