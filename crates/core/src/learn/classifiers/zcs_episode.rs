//! One episode of ZCS, decision by decision: choose, pay the rules that led here, and breed.
//!
//! Strength moves backwards in time by the bucket brigade: the rules whose action is taken pay a share, which goes to the
//! rules of the action before; a reward goes to the rules that just acted.

use rand::Rng;
use rand::RngExt;

use super::chance::{happens, random_largest, roulette};
use super::condition::{Condition, all_bits};
use super::experience::{ActionChoice, EpisodeEnd, ReplayReport};
use super::limits::MOST_REWARD;
use super::mask_table::forget;
use super::zcs::Zcs;
use super::zcs_rules::{MOST_STRENGTH, ZcsRule};

/// Strength below which rules are all deleted alike, so that weights of deletion stay finite.
const LEAST_STRENGTH: f64 = 1.0e-6;

/// An episode in progress.
#[derive(Debug)]
pub struct ZcsEpisode<'a> {
    zcs: &'a mut Zcs,
    /// Indices of the rules of the last action, rising.
    last_set: Vec<usize>,
    /// The match set, kept for its memory.
    matched: Vec<usize>,
    report: ReplayReport,
}

impl<'a> ZcsEpisode<'a> {
    pub(super) fn new(zcs: &'a mut Zcs) -> Self {
        let report = ReplayReport::default();
        Self { zcs, last_set: Vec::new(), matched: Vec::new(), report }
    }

    /// Takes a decision in a situation, returns the action, and pays the rules of the action before. Bits beyond
    /// those of the learner are ignored; an action given beyond the last is the last.
    pub fn decide(&mut self, bits: u32, choice: ActionChoice, rng: &mut impl Rng) -> usize {
        let bits = bits & all_bits(self.zcs.situation_bits);
        let covered = self.match_or_cover(bits, choice, rng);
        self.report.decisions = self.report.decisions.saturating_add(1);
        self.report.covered = self.report.covered.saturating_add(u32::from(covered));
        let action = match choice {
            ActionChoice::Given(action) => action.min(self.zcs.actions - 1),
            ActionChoice::Explore => {
                let strength = |&index: &usize| f64::from(self.zcs.rules[index].strength);
                let weights: Vec<f64> = self.matched.iter().map(strength).collect();
                self.zcs.masks.action(self.matched[roulette(&weights, rng)])
            }
            ActionChoice::Exploit => {
                random_largest(&self.zcs.strengths(&self.matched), rng).unwrap_or_default()
            }
        };
        let (mut set, others) = self.advisers(action);
        let bucket = self.zcs.collect(&set, self.zcs.settings.learning_rate);
        self.zcs.share_out(&self.last_set, self.zcs.settings.discount * bucket);
        self.finish_decision(&mut set, &others, rng);
        self.last_set = set;
        action
    }

    /// Pays a reward to the rules of the last action. It is limited to 0 to 1e6; NaN counts as 0.
    pub fn reward(&mut self, reward: f32) {
        let reward = if reward.is_nan() { 0.0 } else { reward.clamp(0.0, MOST_REWARD) };
        self.zcs.share_out(&self.last_set, self.zcs.settings.learning_rate * reward);
    }

    /// Ends and reports the episode. After a time-out the last rules are paid as if the strongest action of the next
    /// situation were taken, but the rules of that action pay nothing.
    pub fn finish(self, end: EpisodeEnd) -> ReplayReport {
        if let EpisodeEnd::TimeOut { bits } = end {
            let strengths = self.zcs.strength_array(bits);
            let best = strengths.iter().flatten().copied().reduce(f32::max).unwrap_or_default();
            let settings = &self.zcs.settings;
            let payment = settings.discount * settings.learning_rate * best;
            self.zcs.share_out(&self.last_set, payment);
        }
        self.report
    }

    /// Pays the rules that advise a recorded action in a situation, after making one if there is none, and breeds. The
    /// rules pay a share of their strength first, which is lost: what came later is in `payoff`.
    pub(super) fn pay(&mut self, bits: u32, action: usize, payoff: f32, rng: &mut impl Rng) {
        let covered = self.match_or_cover(bits, ActionChoice::Given(action), rng);
        self.report.add(ReplayReport { decisions: 1, covered: u32::from(covered) });
        let (mut set, others) = self.advisers(action);
        let rate = self.zcs.settings.learning_rate;
        self.zcs.collect(&set, rate);
        self.zcs.share_out(&set, rate * payoff);
        self.finish_decision(&mut set, &others, rng);
    }

    /// The matching rules that advise an action, and the others.
    fn advisers(&self, action: usize) -> (Vec<usize>, Vec<usize>) {
        self.matched.iter().partition(|&&index| self.zcs.masks.action(index) == action)
    }

    /// Takes the tax of the rules whose action was not taken, and breeds.
    fn finish_decision(&mut self, set: &mut Vec<usize>, others: &[usize], rng: &mut impl Rng) {
        self.zcs.collect(others, self.zcs.settings.tax);
        if happens(self.zcs.settings.ga_rate, rng) {
            self.zcs.evolve(set, rng);
        }
    }

    /// The largest summed strength in a situation of an action other than `action`; 0 if there is none.
    pub(super) fn strength_beside(&self, bits: u32, action: usize) -> f32 {
        let strengths = self.zcs.strength_array(bits).into_iter().enumerate();
        let others = strengths.filter(|(other, _)| *other != action);
        others.filter_map(|(_, strength)| strength).reduce(f32::max).unwrap_or(0.0)
    }

    /// What was met so far.
    pub(super) fn report(&self) -> ReplayReport {
        self.report
    }

    /// Finds the matching rules, and makes one if they are none or weak, or if none advises a given action. True if
    /// a rule was made.
    fn match_or_cover(&mut self, bits: u32, choice: ActionChoice, rng: &mut impl Rng) -> bool {
        self.zcs.masks.match_into(bits, &mut self.matched);
        let zcs = &mut *self.zcs;
        let strength = |index: usize| f64::from(zcs.rules[index].strength);
        let of_match = self.matched.iter().fold(0.0, |sum, &index| sum + strength(index));
        let mean = zcs.mean_strength();
        let is_weak = of_match < f64::from(zcs.settings.covering_share) * mean;
        let given = match choice {
            ActionChoice::Given(action) => Some(action.min(zcs.actions - 1)),
            ActionChoice::Explore | ActionChoice::Exploit => None,
        };
        let lacks = |action| self.matched.iter().all(|&index| zcs.masks.action(index) != action);
        if !self.matched.is_empty() && !is_weak && !given.is_some_and(lacks) {
            return false;
        }
        let (length, share) = (zcs.situation_bits, zcs.settings.wildcard_share);
        let condition = Condition::covering(bits, length, share, rng);
        let action = given.unwrap_or_else(|| rng.random_range(0..zcs.actions)) as u16;
        zcs.make_room(1, &mut self.last_set, rng);
        zcs.add(ZcsRule { condition, action, strength: mean as f32 });
        zcs.masks.match_into(bits, &mut self.matched);
        true
    }
}

impl Zcs {
    /// Mean strength of all rules; that of a first rule if there is none.
    fn mean_strength(&self) -> f64 {
        if self.rules.is_empty() {
            return f64::from(self.settings.initial_strength);
        }
        let sum = self.rules.iter().fold(0.0, |sum, rule| sum + f64::from(rule.strength));
        sum / self.rules.len() as f64
    }

    /// Takes a share of the strength of some rules and returns the sum.
    fn collect(&mut self, set: &[usize], share: f32) -> f32 {
        let mut bucket = 0.0;
        for &index in set {
            let strength = &mut self.rules[index].strength;
            let part = share * *strength;
            *strength -= part;
            bucket += part;
        }
        bucket
    }

    /// Gives some rules equal parts of an amount.
    fn share_out(&mut self, set: &[usize], amount: f32) {
        let part = amount / set.len().max(1) as f32;
        for &index in set {
            let strength = &mut self.rules[index].strength;
            *strength = (*strength + part).min(MOST_STRENGTH);
        }
    }

    /// Breeds two children of two rules of the whole population, drawn by strength. Each parent gives half of its
    /// strength to its copy. `alive` is a set of rule indices that stays valid.
    fn evolve(&mut self, alive: &mut Vec<usize>, rng: &mut impl Rng) {
        if self.rules.is_empty() {
            return;
        }
        let weights: Vec<f64> = self.rules.iter().map(|rule| f64::from(rule.strength)).collect();
        let parents = [roulette(&weights, rng), roulette(&weights, rng)];
        let [mut first, mut second] = parents.map(|parent| {
            self.rules[parent].strength *= 0.5;
            self.rules[parent].clone()
        });
        if happens(self.settings.crossover_share, rng) {
            let cut = rng.random_range(0..self.situation_bits);
            first.condition.exchange(&mut second.condition, cut, self.situation_bits);
            first.strength = 0.5 * (first.strength + second.strength);
            second.strength = first.strength;
        }
        self.make_room(2, alive, rng);
        for mut child in [first, second] {
            child.condition.mutate_freely(self.settings.mutation_share, rng);
            if happens(self.settings.mutation_share, rng) && self.actions > 1 {
                let other = rng.random_range(0..self.actions as u16 - 1);
                child.action = other + u16::from(other >= child.action);
            }
            self.add(child);
        }
    }

    /// Deletes rules, weak ones more readily, until `count` more have room.
    fn make_room(&mut self, count: usize, alive: &mut Vec<usize>, rng: &mut impl Rng) {
        while !self.rules.is_empty() && self.rules.len() + count > self.settings.population as usize
        {
            let weight = |rule: &ZcsRule| 1.0 / f64::from(rule.strength).max(LEAST_STRENGTH);
            let weights: Vec<f64> = self.rules.iter().map(weight).collect();
            let removed = roulette(&weights, rng);
            self.rules.remove(removed);
            self.masks.remove_all(&[removed]);
            forget(alive, removed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::zcs::SavedZcs;
    use super::super::zcs_rules::ZcsSettings;
    use super::*;
    use crate::learn::classifiers::RecordedDecision;
    use crate::rng::{Purpose, stream};

    /// A ZCS of three bits and two actions whose rules neither breed nor are weak.
    fn quiet(rules: &[(&str, u16, f32)]) -> Zcs {
        let settings = ZcsSettings {
            population: 9,
            ga_rate: 0.0,
            covering_share: 0.0,
            ..ZcsSettings::default()
        };
        let rules = rules.iter().map(|&(condition, action, strength)| ZcsRule {
            condition: condition.parse().unwrap(),
            action,
            strength,
        });
        let rules = rules.collect();
        SavedZcs { settings, situation_bits: 3, actions: 2, rules }.try_into().unwrap()
    }

    fn strengths(zcs: &Zcs) -> Vec<f32> {
        zcs.rules.iter().map(|rule| rule.strength).collect()
    }

    #[test]
    fn payments_agree_with_those_by_hand() {
        let rules = [("0##", 0, 100.0), ("00#", 0, 50.0), ("0##", 1, 40.0), ("1##", 1, 200.0)];
        let mut zcs = quiet(&rules);
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let first = RecordedDecision { bits: 0b000, action: 0, reward: 10.0 };
        zcs.learn(&[first], EpisodeEnd::Terminal, &mut rng).unwrap();
        // Two rules pay a fifth and share a fifth of the reward; the third is taxed a tenth; the fourth is silent.
        assert_eq!(strengths(&zcs), [81.0, 41.0, 36.0, 200.0]);
        let mut zcs = quiet(&rules);
        let second = RecordedDecision { bits: 0b001, action: 1, reward: 0.0 };
        zcs.learn(&[first, second], EpisodeEnd::Terminal, &mut rng).unwrap();
        // The fourth rule pays 40, of which 71 % reach the two rules before.
        let expected = [95.2, 55.2, 36.0, 160.0];
        for (strength, expected) in strengths(&zcs).into_iter().zip(expected) {
            assert!((strength - expected).abs() < 1e-4, "{strength} is not {expected}");
        }
    }

    #[test]
    fn after_a_time_out_the_next_situation_pays_without_loss() {
        let mut zcs = quiet(&[("0##", 0, 100.0), ("1##", 1, 200.0)]);
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let first = RecordedDecision { bits: 0b000, action: 0, reward: 0.0 };
        zcs.learn(&[first], EpisodeEnd::TimeOut { bits: 0b001 }, &mut rng).unwrap();
        assert!((strengths(&zcs)[0] - (80.0 + 0.71 * 40.0)).abs() < 1e-4);
        assert_eq!(strengths(&zcs)[1], 200.0);
    }

    #[test]
    fn a_rule_is_made_for_a_new_situation_and_for_a_given_action_without_one() {
        let mut zcs = quiet(&[("0##", 0, 100.0)]);
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let seen = [(0, 0), (0, 1), (1, 0)];
        let seen = seen.map(|(bits, action)| RecordedDecision { bits, action, reward: 0.0 });
        let report = zcs.learn(&seen[..1], EpisodeEnd::Terminal, &mut rng).unwrap();
        assert_eq!(report, ReplayReport { decisions: 1, covered: 0 });
        zcs.learn(&seen[1..2], EpisodeEnd::Terminal, &mut rng).unwrap();
        assert!(zcs.rules[1].condition.matches(0) && zcs.rules[1].action == 1);
        zcs.learn(&seen[2..], EpisodeEnd::Terminal, &mut rng).unwrap();
        assert!(zcs.rules.iter().any(|rule| rule.condition.matches(1) && rule.action == 0));
    }

    #[test]
    fn weak_rules_count_as_none() {
        let mut zcs = quiet(&[("0##", 0, 1.0), ("1##", 0, 99.0)]);
        zcs.settings.covering_share = 0.5;
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        zcs.episode().decide(0, ActionChoice::Explore, &mut rng);
        assert_eq!(zcs.rules.len(), 3);
        zcs.episode().decide(1, ActionChoice::Explore, &mut rng);
        assert_eq!(zcs.rules.len(), 3);
    }

    #[test]
    fn exploring_follows_strength_and_exploiting_takes_the_strongest() {
        let mut zcs = quiet(&[("###", 0, 1.0), ("###", 1, 3.0)]);
        zcs.settings.learning_rate = 0.001;
        zcs.settings.tax = 0.0;
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut count = 0;
        for _ in 0..200 {
            count += zcs.episode().decide(0, ActionChoice::Explore, &mut rng);
            assert_eq!(zcs.episode().decide(0, ActionChoice::Exploit, &mut rng), 1);
        }
        assert!((115..=170).contains(&count), "{count} of 200");
    }
}
