//! XCS: a population of rules that each predict the payoff of an action, and that are kept for the accuracy of their predictions.
//!
//! The method is that of Wilson, "Classifier fitness based on accuracy" (Evolutionary Computation 3(2), 1995), in the form of Butz and
//! Wilson, "An algorithmic description of XCS" (LNAI 1996, 2001). This file contains the population and the functions that read it.
//! `xcs_returns` contains learning, `xcs_discovery` the discovery of new rules.

use serde::{Deserialize, Serialize};

use super::chance::first_largest;
use super::condition::LENGTHS;
use super::experience::{EpisodeEnd, RecordedDecision, check_episode};
use super::limits::{MOST_ACTIONS, MOST_REWARD};
use super::mask_table::MaskTable;
use super::xcs_rules::{XcsRule, check_rules};
use super::xcs_saved::SavedXcs;
use super::xcs_settings::XcsSettings;
use crate::check::{Invalid, within};

/// An XCS for situations with a fixed number of bits and a fixed number of actions.
///
/// It is saved as [`SavedXcs`]. A population that is read is checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SavedXcs", into = "SavedXcs")]
pub struct Xcs {
    /// Parameters of the system.
    pub(crate) settings: XcsSettings,
    /// Number of bits of a situation.
    pub(crate) situation_bits: usize,
    /// Number of actions.
    pub(crate) actions: usize,
    /// Number of decisions learned from so far.
    pub(super) time: u64,
    /// Rules in order of birth.
    pub(crate) rules: Vec<XcsRule>,
    /// Conditions and actions of `rules`, laid out for matching.
    pub(super) masks: MaskTable,
    /// Sum of the rules' numerosities.
    pub(super) numerosity: u32,
}

impl Xcs {
    /// Creates an XCS without rules.
    ///
    /// # Errors
    /// Returns an error if a setting is outside its range, if the bits are not from 1 to 32, or if the actions are not from 1 to 256 or
    /// more than the population.
    pub fn new(
        settings: XcsSettings,
        situation_bits: usize,
        actions: usize,
    ) -> Result<Self, Invalid> {
        SavedXcs { settings, situation_bits, actions, time: 0, rules: Vec::new() }.try_into()
    }

    pub(super) fn check_experience(
        &self,
        decisions: &[RecordedDecision],
        end: EpisodeEnd,
    ) -> Result<(), Invalid> {
        check_episode(
            decisions,
            end,
            [self.situation_bits, self.actions],
            -MOST_REWARD..=MOST_REWARD,
        )
    }

    /// Returns the action of the largest predicted payoff, the lowest among equal ones; `None` if no rule matches. It makes no rules and
    /// draws no random number.
    pub fn frozen_action(&self, bits: u32) -> Option<usize> {
        first_largest(&self.prediction_array(bits))
    }

    /// Computes the predicted payoff of each action: the mean of its matching rules' predictions, weighted by fitness; `None` for an
    /// action without a matching rule.
    pub fn prediction_array(&self, bits: u32) -> Vec<Option<f32>> {
        self.predictions(&self.match_set(bits))
    }

    /// Returns the indices of the rules that match a situation, in order of birth.
    pub fn match_set(&self, bits: u32) -> Vec<usize> {
        let mut matched = Vec::new();
        self.masks.match_into(bits, &mut matched);
        matched
    }

    /// Computes the predicted payoff of an action from the ascending indices of its matching rules; `None` without a rule.
    pub(super) fn prediction(&self, matched: impl Iterator<Item = usize>) -> Option<f32> {
        let mut sum = PredictionSum::default();
        matched.for_each(|index| sum.add(&self.rules[index]));
        sum.mean()
    }

    /// Computes the prediction array of a match set.
    pub(super) fn predictions(&self, matched: &[usize]) -> Vec<Option<f32>> {
        let mut sums = vec![PredictionSum::default(); self.actions];
        for &index in matched {
            sums[self.masks.action(index)].add(&self.rules[index]);
        }
        sums.iter().map(PredictionSum::mean).collect()
    }

    /// Replaces the parameters, for instance by parameters without crossover and mutation, which condense the population.
    ///
    /// # Errors
    /// Returns an error if a setting is outside its range, or if the population is below the present sum of numerosities.
    pub fn set_settings(&mut self, settings: XcsSettings) -> Result<(), Invalid> {
        self.check_with(&settings)?;
        self.settings = settings;
        Ok(())
    }

    /// Checks the parameters and every rule.
    ///
    /// # Errors
    /// Returns the first error found: field, value and allowed range.
    pub fn check(&self) -> Result<(), Invalid> {
        self.check_with(&self.settings)
    }

    fn check_with(&self, settings: &XcsSettings) -> Result<(), Invalid> {
        settings.check().map_err(|error| error.inside("settings"))?;
        within("situation_bits", self.situation_bits, LENGTHS)?;
        within("actions", self.actions, 1..=MOST_ACTIONS)?;
        // Every action of a situation has a rule, so the population must have room for one rule per action.
        within("actions", self.actions, 1..=settings.population as usize)?;
        // No learner reaches this count, but a hostile file may claim a larger one, and then the count must not overflow.
        within("time", self.time, 0..=1 << 62)?;
        check_rules(&self.rules, settings.population, self.situation_bits, self.actions, self.time)
    }
}

/// The sums from which the predicted payoff of one action is computed.
#[derive(Debug, Clone, Copy, Default)]
struct PredictionSum {
    fitness: f64,
    weighted_by_fitness: f64,
    numerosity: f64,
    weighted_by_numerosity: f64,
}

impl PredictionSum {
    fn add(&mut self, rule: &XcsRule) {
        let (prediction, fitness) = (f64::from(rule.prediction), f64::from(rule.fitness));
        self.fitness += fitness;
        self.weighted_by_fitness += prediction * fitness;
        self.numerosity += f64::from(rule.numerosity);
        self.weighted_by_numerosity += prediction * f64::from(rule.numerosity);
    }

    /// Returns the mean prediction, weighted by fitness. If rounding has reduced the fitness of all rules to zero, it is weighted by
    /// numerosity; `None` without rules.
    fn mean(&self) -> Option<f32> {
        if self.fitness > 0.0 {
            Some((self.weighted_by_fitness / self.fitness) as f32)
        } else if self.numerosity > 0.0 {
            Some((self.weighted_by_numerosity / self.numerosity) as f32)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::xcs_rules::samples::{rule, saved};
    use super::*;
    use crate::rng::{Purpose, stream};

    #[test]
    fn predictions_are_means_weighted_by_fitness() {
        let rules = vec![
            rule("1##", 0, 100.0, 0.25),
            rule("##0", 0, 500.0, 0.75),
            rule("0##", 1, 900.0, 1.0),
            rule("###", 2, 400.0, 0.5),
        ];
        let xcs = Xcs::try_from(saved(rules)).unwrap();
        assert_eq!(xcs.match_set(0b001), [0, 1, 3]);
        assert_eq!(xcs.prediction_array(0b001), [Some(400.0), None, Some(400.0)]);
        assert_eq!(xcs.frozen_action(0b001), Some(0), "ties go to the lowest action");
        assert_eq!(xcs.frozen_action(0b000), Some(1));
    }

    #[test]
    fn rules_whose_fitness_vanished_still_predict() {
        let xcs = Xcs::try_from(saved(vec![rule("###", 0, 8.0, 0.0)])).unwrap();
        assert_eq!(xcs.prediction_array(0), [Some(8.0), None, None]);
    }

    #[test]
    fn frozen_play_never_covers() {
        let xcs = Xcs::try_from(saved(vec![rule("1##", 0, 1.0, 1.0)])).unwrap();
        let before = xcs.clone();
        assert_eq!(xcs.frozen_action(0b000), None);
        assert_eq!(xcs, before);
    }

    #[test]
    fn hostile_experience_changes_nothing() {
        let mut xcs = Xcs::try_from(saved(vec![rule("1##", 0, 1.0, 1.0)])).unwrap();
        let before = xcs.clone();
        let good = RecordedDecision { bits: 0, action: 0, reward: 0.0 };
        let mut rng = stream(7, 0, 0, Purpose::Birth);
        for bad in [
            RecordedDecision { bits: 8, ..good },
            RecordedDecision { action: 3, ..good },
            RecordedDecision { reward: f32::NAN, ..good },
        ] {
            let error = xcs.learn(&[good, bad], EpisodeEnd::Terminal, &mut rng).unwrap_err();
            assert!(error.field.starts_with("decisions[1]."), "{error}");
        }
        assert!(xcs.learn(&[good], EpisodeEnd::TimeOut { bits: 8 }, &mut rng).is_err());
        assert_eq!(xcs, before);
    }
}
