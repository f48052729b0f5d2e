//! Settings of the reinforcement learners.

use crate::check::{Invalid, within};
use crate::genome::controllers::{DECISION_DISCOUNT, DECISIONS_PER_S, JOINT_BENDS};
use crate::learn::classifiers::{XcsSettings, ZcsSettings};
use crate::learn::q_table::{ExplorationLadder, QRule};
use crate::schema::{SettingRow, number, setting_group, whole};

setting_group! {
    /// Settings of exploration: how often the snakes of a generation of learners take random postures.
    pub struct ExplorationSettings in "Exploration": "How often the learning snakes take a random posture." {
        /// Share of random postures that the most exploring snake takes in the first generation.
        first: f32 = 0.6,
            number("Random postures at first", 0.0..=1.0)
                .hint("Share of random postures that the boldest snake of the first generation takes")
                .slider(0.0, 1.0);

        /// Factor by which the share of random postures changes per generation.
        decay: f32 = 0.985,
            number("Factor per generation", 0.5..=1.0).advanced()
                .hint("The share of random postures is multiplied by this value after each generation")
                .slider(0.9, 1.0);

        /// Least share of random postures of the most exploring snake.
        least: f32 = 0.1,
            number("Random postures at least", 0.0..=1.0).advanced()
                .hint("Share of random postures below which the boldest snake never falls")
                .slider(0.0, 1.0);
    }
}

impl ExplorationSettings {
    /// Returns the exploration of the individuals of a generation, from the most to the least exploring snake.
    pub fn ladder(&self) -> ExplorationLadder {
        let Self { first, decay, least } = *self;
        ExplorationLadder { first, decay, least_of_boldest: least }
    }
}

setting_group! {
    /// Settings of Q-learning.
    pub struct QLearningSettings in "Q-learning": "Learns what each posture is worth in each situation." {
        /// Power of the number of visits to a pair of situation and posture by which the learning rate is divided.
        rate_power: f32 = 0.8,
            number("Fall of the learning rate", 0.0..=1.0).advanced()
                .hint("The learning rate is 1 over the number of visits to this power. At 0 it stays at 1")
                .slider(0.0, 1.0);

        /// Value below which the learning rate does not fall.
        rate_floor: f32 = 0.05,
            number("Least learning rate", 0.0..=1.0)
                .hint("Below this value the learning rate does not fall: what is new always counts a little")
                .slider(0.0, 0.5);

        /// Share of the later rewards in the outcome of a decision. The rest is the value that was expected of the next situation.
        trace: f32 = 0.8,
            share_of_later();
    }
}

impl QLearningSettings {
    /// Returns the rule by which values are updated.
    pub fn rule(&self) -> QRule {
        let Self { rate_power, rate_floor, .. } = *self;
        // A tick is 1/60 s; the discount per tick gives `DECISION_DISCOUNT` per decision.
        let ticks = 60.0 / DECISIONS_PER_S as f32;
        let discount_per_tick = libm::powf(DECISION_DISCOUNT, 1.0 / ticks);
        QRule { discount_per_tick, rate_power, rate_floor, ..QRule::default() }
    }
}

/// Checks that the experience of a generation of learners fits into memory.
pub(super) fn check_learners(population: u32) -> Result<(), Invalid> {
    within("evolution.population", population, 2..=MOST_LEARNERS)
}

setting_group! {
    /// Settings of XCS.
    pub struct XcsRunSettings in "XCS": "Keeps rules that predict what a posture is worth." {
        /// Greatest number of rules, copies included.
        rules: u32 = 2000,
            whole("Rules at most", 12..=MOST_SYSTEM_RULES)
                .hint("Maximum number of rules, copies included. More rules distinguish more situations. Joint decisions share them among the joints")
                .slider(100.0, 5000.0);

        /// Probability that a rule made for a new situation ignores a bit.
        wildcard_share: f32 = 0.05,
            wildcards();

        /// Discount of rewards per decision.
        discount: f32 = 0.95,
            worth_of_the_future();

        /// Learning rate: how fast the predictions of rules follow experience.
        learning_rate: f32 = 0.05,
            number("Learning rate", 0.001..=1.0).advanced()
                .hint("How fast the predictions of rules follow experience")
                .slider(0.01, 0.5);

        /// Mean number of decisions between two runs of the genetic algorithm in a set of rules.
        ga_interval: f32 = 500.0,
            number("Decisions between new rules", 0.0..=10_000.0).advanced()
                .hint("Mean number of decisions after which rules of an action set have children")
                .slider(1.0, 500.0);

        /// Prediction error below which a rule counts as accurate, in units of reward.
        error_threshold: f32 = 100.0,
            number("Accurate below", 0.001..=1000.0).advanced()
                .hint("Error of its prediction below which a rule counts as accurate. A whole tread is worth 1,000")
                .slider(1.0, 200.0);

        /// Share of the later rewards in the outcome of a decision. The rest is the value that was expected of the next situation.
        trace: f32 = 0.8,
            share_of_later();
    }
}

impl XcsRunSettings {
    /// Returns the parameters of the classifier system.
    pub fn parameters(&self) -> XcsSettings {
        let Self { rules, wildcard_share, discount, learning_rate, .. } = *self;
        let Self { ga_interval, error_threshold, .. } = *self;
        XcsSettings {
            population: rules,
            wildcard_share,
            discount,
            learning_rate,
            ga_interval,
            error_threshold,
            // Outcomes scatter by more than the threshold, so that no rule is accurate. The usual power of 5 would then give nearly all
            // fitness to the rules that happen to have the smallest errors.
            accuracy_power: 2.0,
            ..XcsSettings::default()
        }
    }

    /// Returns the parameters of each of several classifier systems that divide the number of rules among them.
    pub fn of_each(&self, systems: usize) -> XcsSettings {
        let parameters = self.parameters();
        let share = parameters.population / (systems as u32).max(1);
        XcsSettings { population: share.max(JOINT_BENDS.len() as u32), ..parameters }
    }
}

setting_group! {
    /// Settings of ZCS.
    pub struct ZcsRunSettings in "ZCS": "Rules grow stronger with what their postures earn." {
        /// Number of rules in the classifier system.
        rules: u32 = 2000,
            whole("Rules", 12..=MOST_SYSTEM_RULES)
                .hint("Number of rules. More rules distinguish more situations")
                .slider(100.0, 5000.0);

        /// Probability that a new rule ignores a bit.
        wildcard_share: f32 = 0.2,
            wildcards();

        /// Share of a payment that the rules of the previous decision receive.
        discount: f32 = 0.9,
            worth_of_the_future();

        /// Learning rate: share of its strength that a rule pays, and share of a payment that it receives.
        learning_rate: f32 = 0.2,
            number("Learning rate", 0.001..=1.0).advanced()
                .hint("How fast the strengths of rules follow experience")
                .slider(0.01, 0.5);

        /// Probability that the genetic algorithm makes new rules after a decision.
        ga_rate: f32 = 0.25,
            number("New rules per decision", 0.0..=1.0).advanced()
                .hint("Probability that two rules have children after a decision")
                .slider(0.0, 1.0);

        /// Share of the later rewards in the outcome of a decision. The rest is the value that was expected of the next situation.
        trace: f32 = 0.8,
            share_of_later();
    }
}

impl ZcsRunSettings {
    /// Returns the parameters of the classifier system.
    pub fn parameters(&self) -> ZcsSettings {
        let Self { rules, wildcard_share, discount, learning_rate, ga_rate, .. } = *self;
        ZcsSettings {
            population: rules,
            wildcard_share,
            discount,
            learning_rate,
            ga_rate,
            ..ZcsSettings::default()
        }
    }
}

/// Makes the row of the share of later rewards in the outcome of a decision.
fn share_of_later() -> SettingRow<f32> {
    number("What came later", 0.0..=1.0)
        .advanced()
        .hint("How much of what came later counts, in place of what was expected. Near 1 helps where situations look alike")
        .slider(0.0, 1.0)
}

/// Makes the row of the probability that a new rule ignores a bit.
fn wildcards() -> SettingRow<f32> {
    number("Wildcards", 0.0..=1.0)
        .hint("Probability that a new rule ignores a bit of the situation. More wildcards make rules more general")
        .slider(0.0, 1.0)
}

/// Makes the row of the discount of rewards per decision.
fn worth_of_the_future() -> SettingRow<f32> {
    number("Worth of the future", 0.0..=0.99)
        .hint("What a reward counts one decision later, relative to one now")
        .slider(0.0, 0.99)
}

/// Maximum number of rules of a classifier system, because a checkpoint writes each rule in some hundred characters.
const MOST_SYSTEM_RULES: u32 = 20_000;

/// Maximum number of individuals in a generation of learners. Each keeps the experience of its episode in memory, and has its own copy of
/// the learned table while it learns.
const MOST_LEARNERS: u32 = 10_000;
