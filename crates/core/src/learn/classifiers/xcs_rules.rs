//! A rule of XCS, and checks of rule sets that come from outside.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::condition::Condition;
use super::limits::MOST_RULES;
use crate::check::{Invalid, within};

/// Largest prediction and error in size, in units of reward: the largest reward, again at every decision for ever,
/// at the largest discount.
const MOST_PAYOFF: f32 = 1.0e9;

/// A rule of XCS: a macro-rule in the words of the field, which stands for `numerosity` equal rules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct XcsRule {
    /// The situations that the rule is about.
    pub condition: Condition,
    /// The action whose payoff it predicts.
    pub action: u16,
    /// p: predicted payoff, in units of reward.
    pub prediction: f32,
    /// ε: mean size of the prediction's error, in units of reward.
    pub error: f32,
    /// F: accuracy relative to the rules that act with it, 0 to 1.
    pub fitness: f32,
    /// exp: number of updates.
    pub experience: u32,
    /// ts: the decision at which the genetic algorithm last ran in a set with this rule.
    pub time_stamp: u64,
    /// as: mean numerosity of the action sets it was in.
    pub action_set_size: f32,
    /// n: number of equal rules that it stands for.
    pub numerosity: u32,
}

impl XcsRule {
    /// Checks the rule for a learner of `length` bits and `actions` actions at decision `time`.
    ///
    /// # Errors
    /// A condition of another length, an unknown action, or a number that learning cannot produce.
    pub fn check(&self, length: usize, actions: usize, time: u64) -> Result<(), Invalid> {
        self.condition.check_length(length)?;
        within("action", usize::from(self.action), 0..=actions.saturating_sub(1))?;
        within("prediction", self.prediction, -MOST_PAYOFF..=MOST_PAYOFF)?;
        within("error", self.error, 0.0..=2.0 * MOST_PAYOFF)?;
        within("fitness", self.fitness, 0.0..=1.0)?;
        within("time_stamp", self.time_stamp, 0..=time)?;
        // A set has at least the rule itself; rounding is given some room.
        within("action_set_size", self.action_set_size, 0.5..=2.0 * MOST_RULES as f32)?;
        within("numerosity", self.numerosity, 1..=MOST_RULES)
    }
}

/// Checks a whole rule set: its size, each rule, and that no two rules have the same condition and action.
///
/// # Errors
/// The first fault found.
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
    use super::super::{SavedXcs, XcsSettings};
    use super::XcsRule;

    /// A rule that is accurate and experienced enough to subsume others.
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

    /// A rule of this prediction and fitness.
    pub fn rule(condition: &str, action: u16, prediction: f32, fitness: f32) -> XcsRule {
        XcsRule { prediction, fitness, ..experienced(condition, action) }
    }

    /// A system of up to ten rules over three bits and three actions, after five decisions.
    pub fn saved(rules: Vec<XcsRule>) -> SavedXcs {
        let settings = XcsSettings { population: 10, ..XcsSettings::default() };
        SavedXcs { settings, situation_bits: 3, actions: 3, time: 5, rules }
    }

    /// Checks a number that was computed by hand.
    pub fn near(value: f32, expected: f32) {
        let off = (value - expected).abs();
        assert!(off <= 1e-4 * expected.abs().max(1.0), "{value} is not {expected}");
    }
}
