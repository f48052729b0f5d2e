//! Random choices: with a probability, in proportion to weights, among the largest values.
//!
//! Each function draws exactly one random number, whatever the weights are. A change in the last bit of a weight therefore cannot shift
//! the numbers that later choices draw.

use rand::Rng;
use rand::RngExt;

/// Returns true with this probability.
pub fn happens(probability: f32, rng: &mut impl Rng) -> bool {
    rng.random_range(0.0..1.0) < f64::from(probability)
}

/// Draws an index in proportion to its weight. Weights that are not positive count as zero.
///
/// If rounding leads beyond the last weight, the last positive weight is drawn; if no weight is positive, index 0.
pub fn roulette(weights: &[f64], rng: &mut impl Rng) -> usize {
    let mut left = rng.random_range(0.0..1.0) * sum(weights);
    landing(weights, &mut left)
}

/// A roulette for many draws from many weights, of which few change between two draws.
#[derive(Debug)]
pub struct Wheel {
    weights: Vec<f64>,
    /// Sum of the weights of each block.
    blocks: Vec<f64>,
}

/// Number of weights per block: about the square root of the usual number of weights, so that a draw reads few blocks and few weights.
const BLOCK: usize = 64;

impl Wheel {
    /// Creates a wheel with these weights, which must not be negative.
    pub fn new(weights: Vec<f64>) -> Self {
        let blocks = weights.chunks(BLOCK).map(sum).collect();
        Self { weights, blocks }
    }

    /// Draws an index in proportion to its weight; if no weight is positive, index 0.
    pub fn draw(&self, rng: &mut impl Rng) -> usize {
        let mut left = rng.random_range(0.0..1.0) * sum(&self.blocks);
        let block = landing(&self.blocks, &mut left);
        let start = block * BLOCK;
        let end = self.weights.len().min(start + BLOCK);
        start + landing(&self.weights[start.min(end)..end], &mut left)
    }

    /// Multiplies a weight by a factor.
    pub fn scale(&mut self, index: usize, factor: f64) {
        self.weights[index] *= factor;
        let start = index / BLOCK * BLOCK;
        let end = self.weights.len().min(start + BLOCK);
        self.blocks[index / BLOCK] = sum(&self.weights[start..end]);
    }
}

fn sum(weights: &[f64]) -> f64 {
    weights.iter().fold(0.0, |sum, weight| sum + weight.max(0.0))
}

/// Returns the index of the weight at which the cumulative sum exceeds `left`, and reduces `left` by the weights before it. Beyond the
/// end, it is the last positive weight, or index 0.
fn landing(weights: &[f64], left: &mut f64) -> usize {
    let mut last = 0;
    for (index, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        if *left < weight {
            return index;
        }
        *left -= weight;
        last = index;
    }
    last
}

/// Returns the lowest index of the largest value; `None` if there is no value.
pub fn first_largest(values: &[Option<f32>]) -> Option<usize> {
    two_largest(values)[0]
}

/// Returns the largest of all values except the one at index `except`; 0 if there is none.
pub fn largest_beside(values: &[Option<f32>], except: Option<usize>) -> f32 {
    let others = values.iter().enumerate().filter(|(index, _)| Some(*index) != except);
    others.filter_map(|(_, value)| *value).reduce(f32::max).unwrap_or(0.0)
}

/// Returns the indices of the largest and of the second largest value, the lowest among equal ones; `None` where there is no value.
pub fn two_largest(values: &[Option<f32>]) -> [Option<usize>; 2] {
    let mut largest: [Option<(usize, f32)>; 2] = [None; 2];
    for (index, value) in values.iter().enumerate() {
        let Some(value) = *value else { continue };
        let is_larger = |than: Option<(usize, f32)>| than.is_none_or(|(_, known)| value > known);
        if is_larger(largest[0]) {
            largest = [Some((index, value)), largest[0]];
        } else if is_larger(largest[1]) {
            largest[1] = Some((index, value));
        }
    }
    largest.map(|found| found.map(|(index, _)| index))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    #[test]
    fn the_roulette_draws_in_proportion_to_weight() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut counts = [0; 4];
        for _ in 0..10_000 {
            counts[roulette(&[1.0, 0.0, 3.0, -5.0], &mut rng)] += 1;
        }
        assert_eq!((counts[1], counts[3]), (0, 0));
        assert!((2_350..=2_650).contains(&counts[0]), "{counts:?}");
    }

    #[test]
    fn a_wheel_draws_in_proportion_to_weights_that_change() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut weights = vec![0.0; 200];
        (weights[3], weights[70], weights[199]) = (1.0, 2.0, 3.0);
        let mut wheel = Wheel::new(weights);
        let mut draw = |wheel: &Wheel| {
            let mut counts = vec![0; 200];
            (0..6_000).for_each(|_| counts[wheel.draw(&mut rng)] += 1);
            let [a, b, c] = [3, 70, 199].map(|index: usize| counts[index]);
            assert_eq!(a + b + c, 6_000, "weights of zero are never drawn");
            [a, b, c]
        };
        let [a, b, _] = draw(&wheel);
        assert!((880..1_120).contains(&a) && (1_850..2_150).contains(&b), "{a}, {b}");
        wheel.scale(199, 0.0);
        wheel.scale(70, 0.5);
        let [a, _, c] = draw(&wheel);
        assert!(c == 0 && (2_850..3_150).contains(&a), "{a}, {c}");
        wheel.scale(3, 0.0);
        wheel.scale(70, 0.0);
        assert_eq!(wheel.draw(&mut rng), 0);
    }

    #[test]
    fn a_roulette_without_weights_draws_the_first() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        assert_eq!(roulette(&[0.0, 0.0], &mut rng), 0);
        assert_eq!(roulette(&[], &mut rng), 0);
    }

    #[test]
    fn of_equal_values_the_first_is_the_largest() {
        let values = [None, Some(2.0), Some(1.0), Some(2.0)];
        assert_eq!(first_largest(&values), Some(1));
        assert_eq!(first_largest(&[None]), None);
        assert_eq!(two_largest(&values), [Some(1), Some(3)]);
        assert_eq!((largest_beside(&values, Some(1)), largest_beside(&[None], None)), (2.0, 0.0));
    }

    #[test]
    fn a_roulette_draws_one_number() {
        let after = |choose: &dyn Fn(&mut rand_chacha::ChaCha8Rng)| {
            let mut rng = stream(1, 0, 0, Purpose::Birth);
            choose(&mut rng);
            rng.next_u64()
        };
        let one = after(&|rng| _ = roulette(&[1.0, 1.0], rng));
        assert_eq!(one, after(&|rng| _ = roulette(&[], rng)));
    }
}
