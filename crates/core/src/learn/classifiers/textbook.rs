//! How the learners of the texts choose their actions, which the published tasks need.

use rand::Rng;
use rand::RngExt;

use super::chance::first_largest;

/// How a learner chooses its action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ActionChoice {
    /// The action was chosen elsewhere and is learned from.
    Given(usize),
    /// As the textbook explores: XCS draws any action, all equally likely, ZCS by roulette on strength.
    Explore,
    /// The best known action, a random one among equals. XCS still corrects its rules, but breeds no new ones.
    Exploit,
}

/// An index drawn uniformly among those of the largest value; `None` if there is no value.
pub fn random_largest(values: &[Option<f32>], rng: &mut impl Rng) -> Option<usize> {
    let draw: u32 = rng.random_range(0..u32::MAX);
    let largest = values[first_largest(values)?];
    let mut ties = (0..values.len()).filter(|&index| values[index] == largest);
    let count = ties.clone().count();
    ties.nth(draw as usize % count.max(1))
}
