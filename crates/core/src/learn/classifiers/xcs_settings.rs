//! The parameters of XCS, with the names and usual values of Butz and Wilson, "An algorithmic description of XCS"
//! (LNAI 1996, 2001).

use super::limits::{MOST_REWARD, MOST_RULES};
use crate::learn::parameters::parameters;

parameters! {
    /// The parameters of [`Xcs`](super::Xcs). The Greek letters are those of Butz and Wilson (2001). So are the defaults, which they call
    /// commonly used, for rewards from 0 to 1000.
    pub struct XcsSettings {
        /// N: maximum sum of the rules' numerosities; at least one per action.
        population: u32 = 2_000, 1..=MOST_RULES;
        /// P#: probability that a bit does not matter in a rule made for a new situation.
        wildcard_share: f32 = 0.33, 0.0..=1.0;
        /// β: learning rate of prediction, error, fitness and action set size.
        learning_rate: f32 = 0.2, 0.001..=1.0;
        /// α: accuracy of a rule whose error is just above the threshold. An accurate rule has an accuracy of 1.
        accuracy_fall: f32 = 0.1, 0.0..=1.0;
        /// ε₀: error below which a rule counts as accurate, in units of reward; usually 1 % of the range of rewards.
        error_threshold: f32 = 10.0, 1.0e-6..=MOST_REWARD;
        /// ν: exponent with which accuracy falls as error rises.
        accuracy_power: f32 = 5.0, 0.0..=20.0;
        /// γ: discount factor of the next situation's payoff.
        discount: f32 = 0.71, 0.0..=0.999;
        /// θ_GA: mean number of decisions between two runs of the genetic algorithm in an action set.
        ga_interval: f32 = 25.0, 0.0..=1.0e9;
        /// χ: probability of crossover.
        crossover_share: f32 = 0.8, 0.0..=1.0;
        /// μ: probability that a symbol, or the action, mutates.
        mutation_share: f32 = 0.04, 0.0..=1.0;
        /// θ_del: experience above which an unfit rule is deleted with a higher probability.
        deletion_experience: u32 = 20, 0..=u32::MAX;
        /// δ: share of the mean fitness below which a rule is unfit.
        deletion_fitness_share: f32 = 0.1, 0.0..=1.0;
        /// θ_sub: experience above which an accurate rule may subsume more special ones.
        subsumption_experience: u32 = 20, 0..=u32::MAX;
        /// Whether a child is added to an accurate, more general parent instead of becoming a rule of its own.
        ga_subsumption: bool = true, false..=true;
        /// Whether the most general accurate rule of an action set absorbs more special ones. It should be off where episodes have several
        /// decisions. Learning from whole episodes ignores it.
        action_set_subsumption: bool = false, false..=true;
        /// Whether the prediction moves in proportion to the rule's share of the action set's fitness (Butz, Goldberg
        /// and Lanzi, IEEE Transactions on Evolutionary Computation 9(5), 2005), which helps long chains of decisions.
        gradient: bool = false, false..=true;
        /// p: prediction of a new rule, in units of reward.
        initial_prediction: f32 = 0.01, -MOST_REWARD..=MOST_REWARD;
        /// ε: prediction error of a new rule, in units of reward.
        initial_error: f32 = 0.01, 0.0..=MOST_REWARD;
        /// F: fitness of a new rule.
        initial_fitness: f32 = 0.01, 1.0e-6..=1.0;
    }
}
