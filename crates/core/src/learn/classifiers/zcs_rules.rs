//! The parameters and rules of ZCS, and checks of those that were read from files.

use serde::{Deserialize, Serialize};

use super::condition::Condition;
use super::limits::{MOST_REWARD, MOST_RULES};
use crate::check::{Invalid, within};
use crate::learn::parameters::parameters;

/// Largest strength of a rule, in units of reward. A small action set that a large one pays can exceed the largest reward by far.
pub const MOST_STRENGTH: f32 = 1.0e12;

parameters! {
    /// The parameters of [`Zcs`](super::Zcs). The Greek letters are those of Wilson (1994). So are the defaults, for a food reward of
    /// 1000.
    pub struct ZcsSettings {
        /// N: greatest number of rules.
        population: u32 = 400, 2..=MOST_RULES;
        /// P#: probability that a bit does not matter in a random rule, and in a rule made for a new situation.
        wildcard_share: f32 = 0.33, 0.0..=1.0;
        /// S₀: strength of the rules at the start, in units of reward.
        initial_strength: f32 = 20.0, 1.0e-6..=MOST_REWARD;
        /// β: share of its strength that a rule pays when its action is taken. It is also the factor with which a reward counts.
        learning_rate: f32 = 0.2, 0.001..=1.0;
        /// γ: share of a payment that reaches the rules of the action before.
        discount: f32 = 0.71, 0.0..=0.999;
        /// τ: share of its strength that a matching rule loses when another action is taken.
        tax: f32 = 0.1, 0.0..=1.0;
        /// χ: probability of crossover.
        crossover_share: f32 = 0.5, 0.0..=1.0;
        /// μ: probability that a symbol, or the action, mutates.
        mutation_share: f32 = 0.002, 0.0..=1.0;
        /// ρ: probability that the genetic algorithm runs after a decision.
        ga_rate: f32 = 0.25, 0.0..=1.0;
        /// φ: share of the mean strength of all rules. If the matching rules together are weaker than this share, they count as none.
        covering_share: f32 = 0.5, 0.0..=1.0;
    }
}

/// A rule of ZCS: in these situations, take this action.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZcsRule {
    /// Condition on the situations to which the rule applies.
    pub condition: Condition,
    /// Action that the rule advises.
    pub action: u16,
    /// S: share of the rule in the payoff of the actions that it advised, in units of reward.
    pub strength: f32,
}

impl ZcsRule {
    /// Checks the rule for a learner of `length` bits and `actions` actions.
    ///
    /// # Errors
    /// Returns an error for a condition of another length, an unknown action, or a strength that is not a number from 0 to 1e12.
    pub fn check(&self, length: usize, actions: usize) -> Result<(), Invalid> {
        self.condition.check_length(length)?;
        within("action", usize::from(self.action), 0..=actions.saturating_sub(1))?;
        within("strength", self.strength, 0.0..=MOST_STRENGTH)
    }
}
