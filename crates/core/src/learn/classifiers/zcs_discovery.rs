//! How ZCS makes and deletes rules, and how strength moves between them.

use rand::Rng;
use rand::RngExt;

use super::chance::{happens, roulette};
use super::condition::Condition;
use super::mask_table::forget;
use super::zcs::Zcs;
use super::zcs_rules::{MOST_STRENGTH, ZcsRule};

/// Strength below which the probability of deletion no longer grows, so that its weight stays finite.
const LEAST_STRENGTH: f64 = 1.0e-6;

impl Zcs {
    /// Finds the rules that match a situation. Makes a rule if no rule matches, if the matching rules are weak, or if none advises a
    /// `given` action. Returns their indices, and whether a rule was made. `alive` is a set of rule indices that stays valid.
    pub(super) fn match_or_cover(
        &mut self,
        bits: u32,
        given: Option<usize>,
        alive: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) -> (Vec<usize>, bool) {
        let matched = self.match_set(bits);
        let strength = |index: usize| f64::from(self.rules[index].strength);
        let of_match = matched.iter().fold(0.0, |sum, &index| sum + strength(index));
        let mean = self.mean_strength();
        let is_weak = of_match < f64::from(self.settings.covering_share) * mean;
        let lacks = |action| matched.iter().all(|&index| self.masks.action(index) != action);
        if !matched.is_empty() && !is_weak && !given.is_some_and(lacks) {
            return (matched, false);
        }
        let share = self.settings.wildcard_share;
        let condition = Condition::covering(bits, self.situation_bits, share, rng);
        let action = given.unwrap_or_else(|| rng.random_range(0..self.actions)) as u16;
        self.make_room(1, alive, rng);
        self.add(ZcsRule { condition, action, strength: mean as f32 });
        (self.match_set(bits), true)
    }

    /// Divides rules into those that advise an action and the others.
    pub(super) fn advisers(&self, matched: &[usize], action: usize) -> (Vec<usize>, Vec<usize>) {
        matched.iter().partition(|&&index| self.masks.action(index) == action)
    }

    /// Ends a decision: taxes the rules whose action was not taken, and breeds with the rate of the genetic algorithm. `alive` is a set of
    /// rule indices that stays valid.
    pub(super) fn end_decision(
        &mut self,
        others: &[usize],
        alive: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) {
        self.collect(others, self.settings.tax);
        if happens(self.settings.ga_rate, rng) {
            self.evolve(alive, rng);
        }
    }

    /// Returns the mean strength of all rules; the initial strength if there are no rules.
    fn mean_strength(&self) -> f64 {
        if self.rules.is_empty() {
            return f64::from(self.settings.initial_strength);
        }
        let sum = self.rules.iter().fold(0.0, |sum, rule| sum + f64::from(rule.strength));
        sum / self.rules.len() as f64
    }

    /// Takes a share of the strength of these rules and returns the sum.
    pub(super) fn collect(&mut self, set: &[usize], share: f32) -> f32 {
        let mut bucket = 0.0;
        for &index in set {
            let strength = &mut self.rules[index].strength;
            let part = share * *strength;
            *strength -= part;
            bucket += part;
        }
        bucket
    }

    /// Divides an amount equally among these rules.
    pub(super) fn share_out(&mut self, set: &[usize], amount: f32) {
        let part = amount / set.len().max(1) as f32;
        for &index in set {
            let strength = &mut self.rules[index].strength;
            *strength = (*strength + part).min(MOST_STRENGTH);
        }
    }

    /// Breeds two children of two rules of the whole population, drawn by strength. Each parent gives half of its strength to its copy.
    /// `alive` is a set of rule indices that stays valid.
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

    /// Deletes rules, weak ones with a higher probability, until there is room for `count` more.
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
