//! Classes of stairs, from which the held-out stairs of the exam and the moving stairs of runs are drawn.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::genes::{NOISE_SEEDS, StairsGenome};
use crate::rng::{Purpose, drawn, stream};
use crate::schema::{Choices, choices};

choices! {
    /// A class of stairs.
    pub enum StairsClass {
        Equal = "equal", "Equal steps", "All steps have the same rise and tread.";
        Irregular = "irregular", "Irregular steps", "Rises and treads deviate from the mean by up to 20 to 40 %.";
        House = "house", "House stairs", "The rise is half to four fifths of the tread, as in houses.";
        Nosing = "nosing", "Steps with nosing", "Each tread overhangs its riser by 0.1 to 0.3 m.";
    }
}

/// Number of held-out staircases of each class.
pub const HELD_OUT_PER_CLASS: u32 = 15;
/// Seed of the held-out stairs.
const HELD_OUT_SEED: u64 = 60;

/// Returns the held-out staircase number `number` of a class, from 0 to `HELD_OUT_PER_CLASS - 1`. It comes from a stream of its own, so
/// that no run learns on it.
pub fn held_out(class: StairsClass, number: u32) -> StairsGenome {
    class.draw(&mut stream(HELD_OUT_SEED, class as u32, number, Purpose::HeldOutStairs))
}

impl StairsGenome {
    /// Draws a class, and a staircase of this class.
    pub fn random(rng: &mut ChaCha8Rng) -> Self {
        drawn(StairsClass::OPTIONS, rng).draw(rng)
    }
}

impl StairsClass {
    /// Returns the staircase of this class that belongs to a seed. None of these staircases is held out.
    pub fn of_seed(self, seed: u32) -> StairsGenome {
        self.draw(&mut stream(seed.into(), self as u32, 0, Purpose::StairsDice))
    }

    /// Draws a staircase of this class.
    fn draw(self, rng: &mut ChaCha8Rng) -> StairsGenome {
        let mut genome = StairsGenome {
            steps: rng.random_range(6..=12),
            rise_m: rng.random_range(0.2..=0.8),
            tread_m: rng.random_range(1.0..=3.0),
            noise_seed: rng.random_range(NOISE_SEEDS),
            ..StairsGenome::default()
        };
        let mut between = |from: f32, to: f32| rng.random_range(from..=to);
        match self {
            Self::Equal => {}
            Self::Irregular => {
                genome.rise_noise = between(0.2, 0.4);
                genome.tread_noise = between(0.2, 0.4);
            }
            Self::House => {
                genome.tread_m = between(0.6, 1.0);
                genome.rise_m = genome.tread_m * between(0.5, 0.8);
            }
            Self::Nosing => genome.nosing_m = between(0.1, 0.3),
        }
        genome
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::check;
    use crate::world::Stairs;

    fn all_held_out() -> impl Iterator<Item = (StairsClass, StairsGenome)> {
        StairsClass::OPTIONS.iter().flat_map(|&class| {
            (0..HELD_OUT_PER_CLASS).map(move |number| (class, held_out(class, number)))
        })
    }

    #[test]
    fn the_sixty_held_out_staircases_are_allowed_and_differ() {
        let mut seen: Vec<Stairs> = Vec::new();
        for (class, genome) in all_held_out() {
            check(&genome).expect("within the ranges");
            let stairs = genome.stairs();
            check(&stairs).expect("can be built");
            let steepness = genome.rise_m / genome.tread_m;
            assert!(class != StairsClass::House || (0.5..=0.8).contains(&steepness));
            assert!(!seen.contains(&stairs));
            seen.push(stairs);
        }
        assert_eq!(seen.len(), 60);
    }

    #[test]
    fn a_seed_gives_the_same_stairs_again_and_none_is_held_out() {
        let mut seen: Vec<Stairs> = all_held_out().map(|(_, genome)| genome.stairs()).collect();
        for &class in StairsClass::OPTIONS {
            for seed in 0..200 {
                let genome = class.of_seed(seed);
                check(&genome).expect("within the ranges");
                let stairs = genome.stairs();
                check(&stairs).expect("can be built");
                assert!(!seen.contains(&stairs), "{class:?} {seed}");
                assert_eq!(class.of_seed(seed), genome);
                seen.push(stairs);
            }
        }
    }

    #[test]
    fn drawn_stairs_are_of_all_classes_and_none_is_held_out() {
        let held_out: Vec<Stairs> = all_held_out().map(|(_, genome)| genome.stairs()).collect();
        let (mut house, mut irregular, mut nosing) = (0, 0, 0);
        for number in 0..2000 {
            let genome = StairsGenome::random(&mut stream(60, 0, number, Purpose::Stairs));
            check(&genome).expect("within the ranges");
            assert!(!held_out.contains(&genome.stairs()), "{genome:?}");
            house += u32::from(genome.tread_m < 1.0);
            irregular += u32::from(genome.rise_noise > 0.0);
            nosing += u32::from(genome.nosing_m > 0.0);
        }
        for count in [house, irregular, nosing] {
            assert!((400..=600).contains(&count), "{house}, {irregular}, {nosing}");
        }
    }
}
