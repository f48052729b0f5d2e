//! ZCS: a population of rules that share the payoff of the actions that they advise.
//!
//! The method is that of Wilson, "ZCS: a zeroth level classifier system" (Evolutionary Computation 2(1), 1994). ZCS acts by roulette on
//! strength while it learns. Frozen play needs no random numbers: it takes the action whose rules have the largest total strength.

use rand::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::chance::first_largest;
use super::condition::{Condition, LENGTHS};
use super::experience::{EpisodeEnd, RecordedDecision, check_episode};
use super::limits::{MOST_ACTIONS, MOST_REWARD};
use super::mask_table::MaskTable;
use super::zcs_rules::{ZcsRule, ZcsSettings};
use crate::check::{Invalid, within};

/// A ZCS for situations with a fixed number of bits and a fixed number of actions.
///
/// It is saved as [`SavedZcs`]. A population that is read is checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SavedZcs", into = "SavedZcs")]
pub struct Zcs {
    pub(super) settings: ZcsSettings,
    /// Number of bits of a situation.
    pub(crate) situation_bits: usize,
    /// Number of actions.
    pub(crate) actions: usize,
    /// Rules in order of birth.
    pub(crate) rules: Vec<ZcsRule>,
    /// Conditions and actions of `rules`, laid out for matching.
    pub(super) masks: MaskTable,
}

/// The saved form of a [`Zcs`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedZcs {
    /// Parameters of the system.
    pub settings: ZcsSettings,
    /// Number of bits of a situation, 1 to 32.
    pub situation_bits: usize,
    /// Number of actions, 1 to 256.
    pub actions: usize,
    /// Rules in order of birth.
    pub rules: Vec<ZcsRule>,
}

impl Zcs {
    /// Creates a ZCS with a full population of random rules.
    ///
    /// # Errors
    /// Returns an error if a setting is outside its range, if the bits are not from 1 to 32, or if the actions are not from 1 to 256.
    pub fn new(
        settings: ZcsSettings,
        situation_bits: usize,
        actions: usize,
        rng: &mut impl Rng,
    ) -> Result<Self, Invalid> {
        let empty = SavedZcs { settings, situation_bits, actions, rules: Vec::new() };
        let mut zcs = Self::try_from(empty)?;
        for _ in 0..zcs.settings.population {
            let share = zcs.settings.wildcard_share;
            let condition = Condition::covering(rng.next_u32(), situation_bits, share, rng);
            let action = rng.random_range(0..actions as u16);
            zcs.add(ZcsRule { condition, action, strength: zcs.settings.initial_strength });
        }
        Ok(zcs)
    }

    pub(super) fn check_experience(
        &self,
        decisions: &[RecordedDecision],
        end: EpisodeEnd,
    ) -> Result<(), Invalid> {
        check_episode(decisions, end, [self.situation_bits, self.actions], 0.0..=MOST_REWARD)
    }

    /// Returns the action whose matching rules have the largest total strength, the lowest among equal ones; `None` if no rule matches. It
    /// makes no rules and draws no random number.
    pub fn frozen_action(&self, bits: u32) -> Option<usize> {
        first_largest(&self.strength_array(bits))
    }

    /// Computes the total strength of each action's matching rules; `None` for an action without a matching rule.
    pub fn strength_array(&self, bits: u32) -> Vec<Option<f32>> {
        self.strengths(&self.match_set(bits))
    }

    /// Returns the indices of the rules that match a situation, in order of birth.
    pub fn match_set(&self, bits: u32) -> Vec<usize> {
        let mut matched = Vec::new();
        self.masks.match_into(bits, &mut matched);
        matched
    }

    /// Computes the strength array of a match set.
    pub(super) fn strengths(&self, matched: &[usize]) -> Vec<Option<f32>> {
        let mut sums: Vec<Option<f64>> = vec![None; self.actions];
        for &index in matched {
            let sum = &mut sums[self.masks.action(index)];
            *sum = Some(sum.unwrap_or_default() + f64::from(self.rules[index].strength));
        }
        sums.into_iter().map(|sum| sum.map(|sum| sum as f32)).collect()
    }

    /// Adds a rule at the end of the population.
    pub(super) fn add(&mut self, rule: ZcsRule) {
        self.masks.push(&rule.condition, rule.action);
        self.rules.push(rule);
    }

    /// Replaces the parameters.
    ///
    /// # Errors
    /// Returns an error if a setting is outside its range, or if the population is below the present number of rules.
    pub fn set_settings(&mut self, settings: ZcsSettings) -> Result<(), Invalid> {
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

    fn check_with(&self, settings: &ZcsSettings) -> Result<(), Invalid> {
        settings.check().map_err(|error| error.inside("settings"))?;
        within("situation_bits", self.situation_bits, LENGTHS)?;
        within("actions", self.actions, 1..=MOST_ACTIONS)?;
        within("rules", self.rules.len(), 0..=settings.population as usize)?;
        for (index, rule) in self.rules.iter().enumerate() {
            let at = format!("rules[{index}]");
            rule.check(self.situation_bits, self.actions).map_err(|error| error.inside(&at))?;
        }
        Ok(())
    }
}

impl TryFrom<SavedZcs> for Zcs {
    type Error = Invalid;

    fn try_from(saved: SavedZcs) -> Result<Self, Invalid> {
        let SavedZcs { settings, situation_bits, actions, rules } = saved;
        let masks = MaskTable::of(rules.iter().map(|rule| (rule.condition, rule.action)));
        let zcs = Self { settings, situation_bits, actions, rules, masks };
        zcs.check()?;
        Ok(zcs)
    }
}

impl From<Zcs> for SavedZcs {
    fn from(zcs: Zcs) -> Self {
        let Zcs { settings, situation_bits, actions, rules, masks: _ } = zcs;
        Self { settings, situation_bits, actions, rules }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    fn rule(condition: &str, action: u16, strength: f32) -> ZcsRule {
        ZcsRule { condition: condition.parse().unwrap(), action, strength }
    }

    fn saved(rules: Vec<ZcsRule>) -> SavedZcs {
        let settings = ZcsSettings { population: 4, ..ZcsSettings::default() };
        SavedZcs { settings, situation_bits: 3, actions: 3, rules }
    }

    #[test]
    fn frozen_play_takes_the_strongest_action_and_changes_nothing() {
        let rules = vec![rule("1##", 2, 30.0), rule("##0", 1, 20.0), rule("###", 1, 10.0)];
        let zcs = Zcs::try_from(saved(rules)).unwrap();
        let before = zcs.clone();
        assert_eq!(zcs.match_set(0b001), [0, 1, 2]);
        assert_eq!(zcs.strength_array(0b001), [None, Some(30.0), Some(30.0)]);
        assert_eq!(zcs.frozen_action(0b001), Some(1), "ties go to the lowest action");
        assert_eq!(zcs.frozen_action(0b101), Some(2));
        assert_eq!(Zcs::try_from(saved(vec![rule("1##", 0, 1.0)])).unwrap().frozen_action(0), None);
        assert_eq!(zcs, before);
    }

    #[test]
    fn hostile_rule_sets_are_refused() {
        for (part, bad) in [
            ("rules[0].condition is 1#;", rule("1#", 0, 1.0)),
            ("rules[0].action is 3; allowed: 0 to 2", rule("0##", 3, 1.0)),
            ("rules[0].strength is NaN", rule("0##", 0, f32::NAN)),
            ("rules[0].strength is -1", rule("0##", 0, -1.0)),
            ("rules[0].strength is inf", rule("0##", 0, f32::INFINITY)),
        ] {
            let error = Zcs::try_from(saved(vec![bad])).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        let error = Zcs::try_from(saved(vec![rule("1##", 0, 1.0); 5])).unwrap_err();
        assert_eq!(error.to_string(), "rules is 5; allowed: 0 to 4");
    }

    #[test]
    fn hostile_experience_changes_nothing() {
        let mut rng = stream(7, 0, 0, Purpose::Birth);
        let mut zcs = Zcs::new(ZcsSettings::default(), 3, 3, &mut rng).unwrap();
        let before = zcs.clone();
        let good = RecordedDecision { bits: 0, action: 0, reward: 0.0 };
        for bad in [
            RecordedDecision { bits: 8, ..good },
            RecordedDecision { action: 3, ..good },
            RecordedDecision { reward: -1.0, ..good },
        ] {
            assert!(zcs.learn(&[good, bad], EpisodeEnd::Terminal, &mut rng).is_err());
        }
        assert!(zcs.learn(&[good], EpisodeEnd::TimeOut { bits: 8 }, &mut rng).is_err());
        assert_eq!(zcs, before);
    }

    #[test]
    fn a_saved_population_goes_on_exactly_as_the_original() {
        let mut rng = stream(8, 0, 0, Purpose::Birth);
        let mut zcs = Zcs::new(ZcsSettings::default(), 4, 3, &mut rng).unwrap();
        let seen: Vec<RecordedDecision> = (0..500_u32)
            .map(|i| RecordedDecision {
                bits: i * 7 % 16,
                action: (i % 3) as u16,
                reward: (i % 5) as f32,
            })
            .collect();
        zcs.learn(&seen, EpisodeEnd::Terminal, &mut rng).unwrap();
        let mut read: Zcs = ron::from_str(&ron::to_string(&zcs).unwrap()).unwrap();
        assert_eq!(read, zcs);
        let end = EpisodeEnd::TimeOut { bits: 1 };
        let report = zcs.learn(&seen, end, &mut stream(9, 0, 0, Purpose::Birth));
        assert_eq!(read.learn(&seen, end, &mut stream(9, 0, 0, Purpose::Birth)), report);
        assert_eq!(read, zcs);
        assert_eq!((zcs.check(), zcs.rules.len()), (Ok(()), 400));
    }
}
