//! A rule of XCS, and checks of rule sets that were read from files.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::condition::Condition;
use super::limits::MOST_RULES;
use crate::check::{Invalid, within};

/// Largest absolute value of a prediction, in units of reward: the sum of the largest reward at every decision, at the largest discount.
const MOST_PAYOFF: f32 = 1.0e9;

/// A rule of XCS. In terms of the field it is a macro-rule, which stands for `numerosity` equal rules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct XcsRule {
    /// Condition on the situations to which the rule applies.
    pub condition: Condition,
    /// Action whose payoff the rule predicts.
    pub action: u16,
    /// p: predicted payoff, in units of reward.
    pub prediction: f32,
    /// ε: mean absolute error of the prediction, in units of reward.
    pub error: f32,
    /// F: accuracy relative to the rules in the same action sets, 0 to 1.
    pub fitness: f32,
    /// exp: number of updates of the rule.
    pub experience: u32,
    /// ts: number of the decision at which the genetic algorithm last ran in a set with this rule.
    pub time_stamp: u64,
    /// as: mean numerosity of the action sets that contained the rule.
    pub action_set_size: f32,
    /// n: number of equal rules for which the rule stands.
    pub numerosity: u32,
}

impl XcsRule {
    /// Checks the rule for a learner of `length` bits and `actions` actions at decision `time`.
    ///
    /// # Errors
    /// Returns an error for a condition of another length, an unknown action, or a number that learning cannot produce.
    pub fn check(&self, length: usize, actions: usize, time: u64) -> Result<(), Invalid> {
        self.condition.check_length(length)?;
        within("action", usize::from(self.action), 0..=actions.saturating_sub(1))?;
        within("prediction", self.prediction, -MOST_PAYOFF..=MOST_PAYOFF)?;
        within("error", self.error, 0.0..=2.0 * MOST_PAYOFF)?;
        within("fitness", self.fitness, 0.0..=1.0)?;
        within("time_stamp", self.time_stamp, 0..=time)?;
        // An action set contains at least the rule itself. The range allows for rounding.
        within("action_set_size", self.action_set_size, 0.5..=2.0 * MOST_RULES as f32)?;
        within("numerosity", self.numerosity, 1..=MOST_RULES)
    }
}

/// Checks a whole rule set: its size, each rule, and that no two rules have the same condition and action.
///
/// # Errors
/// Returns the first error found.
pub fn check_rules(
    rules: &[XcsRule],
    population: u32,
    length: usize,
    actions: usize,
    time: u64,
) -> Result<(), Invalid> {
    within("rules", rules.len(), 0..=population as usize)?;
    let mut known = BTreeSet::new();
    for (index, rule) in rules.iter().enumerate() {
        let at = format!("rules[{index}]");
        rule.check(length, actions, time).map_err(|error| error.inside(&at))?;
        if !known.insert((rule.action, rule.condition.care(), rule.condition.value())) {
            let field = format!("{at}.condition");
            return Err(Invalid::new(field, rule.condition, "one rule per condition and action"));
        }
    }
    let total: u64 = rules.iter().map(|rule| u64::from(rule.numerosity)).sum();
    within("sum of numerosities", total, 0..=u64::from(population))
}

/// Rules and systems for tests.
#[cfg(test)]
pub(super) mod samples {
    use super::super::{SavedXcs, Xcs, XcsSettings};
    use super::XcsRule;

    /// Returns a rule that is accurate and experienced enough to subsume others.
    pub fn experienced(condition: &str, action: u16) -> XcsRule {
        XcsRule {
            condition: condition.parse().unwrap(),
            action,
            prediction: 100.0,
            error: 0.0,
            fitness: 0.5,
            experience: 21,
            time_stamp: 0,
            action_set_size: 2.0,
            numerosity: 1,
        }
    }

    /// Returns a rule with this prediction and fitness.
    pub fn rule(condition: &str, action: u16, prediction: f32, fitness: f32) -> XcsRule {
        XcsRule { prediction, fitness, ..experienced(condition, action) }
    }

    /// Returns a system of up to ten rules over three bits and three actions, after five decisions.
    pub fn saved(rules: Vec<XcsRule>) -> SavedXcs {
        let settings = XcsSettings { population: 10, ..XcsSettings::default() };
        SavedXcs { settings, situation_bits: 3, actions: 3, time: 5, rules }
    }

    /// Returns a system that makes rules without wildcards and does not breed.
    pub fn quiet(situation_bits: usize, actions: usize) -> Xcs {
        let settings =
            XcsSettings { ga_interval: 1.0e9, wildcard_share: 0.0, ..XcsSettings::default() };
        Xcs::new(settings, situation_bits, actions).unwrap()
    }

    /// Checks a number against a value computed by hand.
    pub fn near(value: f32, expected: f32) {
        let off = (value - expected).abs();
        assert!(off <= 1e-4 * expected.abs().max(1.0), "{value} is not {expected}");
    }
}
