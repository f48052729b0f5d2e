//! The parameters of XCS, with the names and usual values of Butz and Wilson, "An algorithmic description of XCS"
//! (LNAI 1996, 2001).

use serde::{Deserialize, Serialize};

use super::limits::{MOST_REWARD, MOST_RULES};
use crate::check::{Invalid, within};

/// The parameters of [`Xcs`](super::Xcs). The Greek letters are those of Butz and Wilson (2001).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct XcsSettings {
    /// N: maximum sum of the rules' numerosities, 1 to 100,000 and at least one per action.
    pub population: u32,
    /// P#: probability that a bit does not matter in a rule made for a new situation, 0 to 1.
    pub wildcard_share: f32,
    /// β: learning rate of prediction, error, fitness and action set size, above 0 to 1.
    pub learning_rate: f32,
    /// α: accuracy of a rule whose error is just above the threshold, 0 to 1. An accurate rule has 1.
    pub accuracy_fall: f32,
    /// ε₀: error below which a rule counts as accurate, in units of reward; usually 1 % of the range of rewards.
    pub error_threshold: f32,
    /// ν: exponent with which accuracy falls as error rises, 0 to 20.
    pub accuracy_power: f32,
    /// γ: worth of the next situation's payoff, 0 to 0.999.
    pub discount: f32,
    /// θ_GA: mean number of decisions between two runs of the genetic algorithm in an action set.
    pub ga_interval: f32,
    /// χ: probability of crossover, 0 to 1.
    pub crossover_share: f32,
    /// μ: probability that a symbol, or the action, mutates, 0 to 1.
    pub mutation_share: f32,
    /// θ_del: experience above which an unfit rule is deleted more readily.
    pub deletion_experience: u32,
    /// δ: share of the mean fitness below which a rule is unfit, 0 to 1.
    pub deletion_fitness_share: f32,
    /// θ_sub: experience above which an accurate rule may subsume more special ones.
    pub subsumption_experience: u32,
    /// Whether a child is added to an accurate, more general parent instead of becoming a rule of its own.
    pub ga_subsumption: bool,
    /// Whether the most general accurate rule of an action set absorbs the more special ones. Leave it off where
    /// episodes have several decisions.
    pub action_set_subsumption: bool,
    /// Whether the prediction moves in proportion to the rule's share of the action set's fitness (Butz, Goldberg
    /// and Lanzi, IEEE Transactions on Evolutionary Computation 9(5), 2005), which helps long chains of decisions.
    pub gradient: bool,
    /// p of a new rule, in units of reward.
    pub initial_prediction: f32,
    /// ε of a new rule, in units of reward.
    pub initial_error: f32,
    /// F of a new rule, above 0 to 1.
    pub initial_fitness: f32,
}

impl Default for XcsSettings {
    /// The values that Butz and Wilson (2001) call commonly used, for rewards from 0 to 1000.
    fn default() -> Self {
        Self {
            population: 2_000,
            wildcard_share: 0.33,
            learning_rate: 0.2,
            accuracy_fall: 0.1,
            error_threshold: 10.0,
            accuracy_power: 5.0,
            discount: 0.71,
            ga_interval: 25.0,
            crossover_share: 0.8,
            mutation_share: 0.04,
            deletion_experience: 20,
            deletion_fitness_share: 0.1,
            subsumption_experience: 20,
            ga_subsumption: true,
            action_set_subsumption: false,
            gradient: false,
            initial_prediction: 0.01,
            initial_error: 0.01,
            initial_fitness: 0.01,
        }
    }
}

impl XcsSettings {
    /// Checks every value.
    ///
    /// # Errors
    /// A value outside the range that its description gives.
    pub fn check(&self) -> Result<(), Invalid> {
        within("population", self.population, 1..=MOST_RULES)?;
        within("wildcard_share", self.wildcard_share, 0.0..=1.0)?;
        within("learning_rate", self.learning_rate, 0.001..=1.0)?;
        within("accuracy_fall", self.accuracy_fall, 0.0..=1.0)?;
        within("error_threshold", self.error_threshold, 1.0e-6..=MOST_REWARD)?;
        within("accuracy_power", self.accuracy_power, 0.0..=20.0)?;
        within("discount", self.discount, 0.0..=0.999)?;
        within("ga_interval", self.ga_interval, 0.0..=1.0e9)?;
        within("crossover_share", self.crossover_share, 0.0..=1.0)?;
        within("mutation_share", self.mutation_share, 0.0..=1.0)?;
        within("deletion_fitness_share", self.deletion_fitness_share, 0.0..=1.0)?;
        within("initial_prediction", self.initial_prediction, -MOST_REWARD..=MOST_REWARD)?;
        within("initial_error", self.initial_error, 0.0..=MOST_REWARD)?;
        within("initial_fitness", self.initial_fitness, 1.0e-6..=1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_values_are_allowed_and_survive_the_round_trip() {
        let settings = XcsSettings::default();
        assert_eq!(settings.check(), Ok(()));
        let text = ron::to_string(&settings).unwrap();
        assert_eq!(ron::from_str::<XcsSettings>(&text).unwrap(), settings);
    }

    #[test]
    fn values_outside_their_range_are_refused() {
        let usual = XcsSettings::default;
        for (field, settings) in [
            ("population", XcsSettings { population: 0, ..usual() }),
            ("population", XcsSettings { population: 1_000_000_000, ..usual() }),
            ("wildcard_share", XcsSettings { wildcard_share: 1.5, ..usual() }),
            ("learning_rate", XcsSettings { learning_rate: 0.0, ..usual() }),
            ("accuracy_fall", XcsSettings { accuracy_fall: -0.1, ..usual() }),
            ("error_threshold", XcsSettings { error_threshold: 0.0, ..usual() }),
            ("accuracy_power", XcsSettings { accuracy_power: f32::INFINITY, ..usual() }),
            ("discount", XcsSettings { discount: 1.0, ..usual() }),
            ("ga_interval", XcsSettings { ga_interval: f32::NAN, ..usual() }),
            ("crossover_share", XcsSettings { crossover_share: f32::NAN, ..usual() }),
            ("mutation_share", XcsSettings { mutation_share: 2.0, ..usual() }),
            ("deletion_fitness_share", XcsSettings { deletion_fitness_share: 2.0, ..usual() }),
            ("initial_prediction", XcsSettings { initial_prediction: f32::NAN, ..usual() }),
            ("initial_error", XcsSettings { initial_error: -1.0, ..usual() }),
            ("initial_fitness", XcsSettings { initial_fitness: 0.0, ..usual() }),
        ] {
            assert_eq!(settings.check().unwrap_err().field, field);
        }
    }
}
