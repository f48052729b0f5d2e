//! How the learners of the published texts choose their actions. The published tasks need it.

use rand::Rng;
use rand::RngExt;

use super::chance::first_largest;

/// The way in which a learner chooses its action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ActionChoice {
    /// The action was chosen elsewhere; the learner only learns from it.
    Given(usize),
    /// The learner explores as in its text: XCS draws any action, all equally likely; ZCS draws by roulette on strength.
    Explore,
    /// The learner takes the best known action, a random one among equal ones. XCS still corrects its rules, but breeds no new ones.
    Exploit,
}

/// Draws an index uniformly from those of the largest value; `None` if there is no value.
pub fn random_largest(values: &[Option<f32>], rng: &mut impl Rng) -> Option<usize> {
    let draw: u32 = rng.random_range(0..u32::MAX);
    let largest = values[first_largest(values)?];
    let mut ties = (0..values.len()).filter(|&index| values[index] == largest);
    let count = ties.clone().count();
    ties.nth(draw as usize % count.max(1))
}
