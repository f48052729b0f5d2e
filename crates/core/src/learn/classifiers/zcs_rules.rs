//! The parameters and rules of ZCS, and checks of those that come from outside.

use serde::{Deserialize, Serialize};

use super::condition::Condition;
use super::limits::{MOST_REWARD, MOST_RULES};
use crate::check::{Invalid, within};

/// Largest strength of a rule, in units of reward. A small action set that is paid by a large one can exceed the
/// largest reward by far.
pub const MOST_STRENGTH: f32 = 1.0e12;

/// The parameters of [`Zcs`](super::Zcs). The Greek letters are those of Wilson (1994).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZcsSettings {
    /// N: number of rules, 2 to 100,000.
    pub population: u32,
    /// P#: probability that a bit does not matter in a random rule, and in one made for a new situation, 0 to 1.
    pub wildcard_share: f32,
    /// S₀: strength of the first rules, in units of reward.
    pub initial_strength: f32,
    /// β: share of its strength that a rule pays when its action is taken, and with which a reward counts, 0 to 1.
    pub learning_rate: f32,
    /// γ: share of that payment which reaches the rules of the action before, 0 to 0.999.
    pub discount: f32,
    /// τ: share of its strength that a matching rule loses when another action is taken, 0 to 1.
    pub tax: f32,
    /// χ: probability of crossover, 0 to 1.
    pub crossover_share: f32,
    /// μ: probability that a symbol, or the action, mutates, 0 to 1.
    pub mutation_share: f32,
    /// ρ: probability that the genetic algorithm runs after a decision, 0 to 1.
    pub ga_rate: f32,
    /// φ: share of the mean strength below which the matching rules together count as none, 0 to 1.
    pub covering_share: f32,
}

impl Default for ZcsSettings {
    /// The values of Wilson (1994), for a food reward of 1000.
    fn default() -> Self {
        Self {
            population: 400,
            wildcard_share: 0.33,
            initial_strength: 20.0,
            learning_rate: 0.2,
            discount: 0.71,
            tax: 0.1,
            crossover_share: 0.5,
            mutation_share: 0.002,
            ga_rate: 0.25,
            covering_share: 0.5,
        }
    }
}

impl ZcsSettings {
    /// Checks every value.
    ///
    /// # Errors
    /// A value outside the range that its description gives.
    pub fn check(&self) -> Result<(), Invalid> {
        within("population", self.population, 2..=MOST_RULES)?;
        within("wildcard_share", self.wildcard_share, 0.0..=1.0)?;
        within("initial_strength", self.initial_strength, 1.0e-6..=MOST_REWARD)?;
        within("learning_rate", self.learning_rate, 0.001..=1.0)?;
        within("discount", self.discount, 0.0..=0.999)?;
        within("tax", self.tax, 0.0..=1.0)?;
        within("crossover_share", self.crossover_share, 0.0..=1.0)?;
        within("mutation_share", self.mutation_share, 0.0..=1.0)?;
        within("ga_rate", self.ga_rate, 0.0..=1.0)?;
        within("covering_share", self.covering_share, 0.0..=1.0)
    }
}

/// A rule of ZCS.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZcsRule {
    /// The situations that the rule is about.
    pub condition: Condition,
    /// The action that it advises.
    pub action: u16,
    /// S: its share of the payoff of the actions that it advised, in units of reward.
    pub strength: f32,
}

impl ZcsRule {
    /// Checks the rule for a learner of `length` bits and `actions` actions.
    ///
    /// # Errors
    /// A condition of another length, an unknown action, or a strength that is not a number from 0 to 1e12.
    pub fn check(&self, length: usize, actions: usize) -> Result<(), Invalid> {
        self.condition.check_length(length)?;
        within("action", usize::from(self.action), 0..=actions.saturating_sub(1))?;
        within("strength", self.strength, 0.0..=MOST_STRENGTH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_outside_their_range_are_refused() {
        assert_eq!(ZcsSettings::default().check(), Ok(()));
        let usual = ZcsSettings::default;
        for (field, settings) in [
            ("population", ZcsSettings { population: 1, ..usual() }),
            ("wildcard_share", ZcsSettings { wildcard_share: f32::NAN, ..usual() }),
            ("initial_strength", ZcsSettings { initial_strength: 0.0, ..usual() }),
            ("learning_rate", ZcsSettings { learning_rate: 2.0, ..usual() }),
            ("discount", ZcsSettings { discount: 1.0, ..usual() }),
            ("tax", ZcsSettings { tax: -0.1, ..usual() }),
            ("crossover_share", ZcsSettings { crossover_share: 1.1, ..usual() }),
            ("mutation_share", ZcsSettings { mutation_share: 1.1, ..usual() }),
            ("ga_rate", ZcsSettings { ga_rate: 1.1, ..usual() }),
            ("covering_share", ZcsSettings { covering_share: 1.1, ..usual() }),
        ] {
            assert_eq!(settings.check().unwrap_err().field, field);
        }
    }
}
