//! Where the rules of XCS come from: covering and the genetic algorithm.

use rand::Rng;
use rand::RngExt;

use super::chance::{happens, roulette};
use super::condition::Condition;
use super::xcs::Xcs;
use super::xcs_episode::PendingActionSet;
use super::xcs_rules::XcsRule;

/// Share of its parents' fitness that a child starts with (Butz and Wilson 2001).
const CHILD_FITNESS: f32 = 0.1;

impl Xcs {
    /// Writes the rules that match into `matched`, after making a rule for each action that has none. True if that
    /// was needed. `waiting` is another set of rule indices that stays valid.
    ///
    /// Rules made for this situation cannot be deleted before it is dealt with; otherwise a small population could
    /// delete what it has just made, for ever.
    pub(super) fn match_or_cover(
        &mut self,
        bits: u32,
        matched: &mut Vec<usize>,
        waiting: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) -> bool {
        let mut deletable = self.rules.len();
        let mut covered = false;
        // Deletion may take the only rule of another action, so look again; each round protects at least one more.
        loop {
            self.masks.match_into(bits, matched);
            let missing = self.actions_without_rule(matched);
            if missing.is_empty() {
                return covered;
            }
            covered = true;
            for action in missing {
                let rule = self.covering_rule(bits, action, rng);
                self.add(rule);
            }
            deletable -= self.delete_surplus(deletable, waiting, rng);
        }
    }

    fn actions_without_rule(&self, matched: &[usize]) -> Vec<usize> {
        let mut has_rule = vec![false; self.actions];
        matched.iter().for_each(|&index| has_rule[self.masks.action(index)] = true);
        (0..self.actions).filter(|&action| !has_rule[action]).collect()
    }

    pub(super) fn covering_rule(&self, bits: u32, action: usize, rng: &mut impl Rng) -> XcsRule {
        let settings = &self.settings;
        XcsRule {
            condition: Condition::covering(bits, self.situation_bits, settings.wildcard_share, rng),
            action: action as u16,
            prediction: settings.initial_prediction,
            error: settings.initial_error,
            fitness: settings.initial_fitness,
            experience: 0,
            time_stamp: self.time,
            action_set_size: 1.0,
            numerosity: 1,
        }
    }

    /// Breeds two children among the rules of an action set if the last time is long ago.
    pub(super) fn evolve(
        &mut self,
        pending: &PendingActionSet,
        alive: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) {
        let set = &pending.rules;
        if set.is_empty() || self.mean_age(set) <= f64::from(self.settings.ga_interval) {
            return;
        }
        set.iter().for_each(|&index| self.rules[index].time_stamp = self.time);
        let weights: Vec<f64> = set.iter().map(|&i| f64::from(self.rules[i].fitness)).collect();
        let parents = [set[roulette(&weights, rng)], set[roulette(&weights, rng)]];
        for child in self.children(parents, pending.bits, rng) {
            self.settle(child, parents);
        }
        self.delete_surplus(self.rules.len(), alive, rng);
    }

    /// Mean number of decisions since the genetic algorithm last ran among some rules.
    fn mean_age(&self, set: &[usize]) -> f64 {
        let (mut ages, mut count) = (0.0, 0.0);
        for rule in set.iter().map(|&index| &self.rules[index]) {
            let age = self.time.saturating_sub(rule.time_stamp);
            ages += age as f64 * f64::from(rule.numerosity);
            count += f64::from(rule.numerosity);
        }
        ages / count
    }

    /// Two children of two rules, made for a situation that both parents match.
    fn children(&self, parents: [usize; 2], bits: u32, rng: &mut impl Rng) -> [XcsRule; 2] {
        let [mut first, mut second] = parents.map(|parent| self.copy_of_one(&self.rules[parent]));
        if happens(self.settings.crossover_share, rng) {
            let (from, to) = segment(self.situation_bits, rng);
            first.condition.exchange(&mut second.condition, from, to);
            let mean = |a: f32, b: f32| 0.5 * (a + b);
            first.prediction = mean(first.prediction, second.prediction);
            first.error = mean(first.error, second.error);
            first.fitness = mean(first.fitness, second.fitness);
            second.prediction = first.prediction;
            second.error = first.error;
            second.fitness = first.fitness;
        }
        [first, second].map(|mut child| {
            child.fitness *= CHILD_FITNESS;
            child.condition.mutate_around(bits, self.settings.mutation_share, rng);
            if happens(self.settings.mutation_share, rng) && self.actions > 1 {
                let other = rng.random_range(0..self.actions as u16 - 1);
                child.action = other + u16::from(other >= child.action);
            }
            child
        })
    }

    /// A copy of one of the equal rules that a rule stands for, with that one's part of the fitness.
    fn copy_of_one(&self, rule: &XcsRule) -> XcsRule {
        XcsRule {
            fitness: rule.fitness / rule.numerosity as f32,
            experience: 0,
            time_stamp: self.time,
            numerosity: 1,
            ..rule.clone()
        }
    }

    /// Adds a rule at the end of the population.
    pub(super) fn add(&mut self, rule: XcsRule) {
        self.masks.push(&rule.condition, rule.action);
        self.numerosity += rule.numerosity;
        self.rules.push(rule);
    }
}

/// A segment of at least one symbol between two random cuts.
fn segment(length: usize, rng: &mut impl Rng) -> (usize, usize) {
    let (one, other) = (rng.random_range(0..length), rng.random_range(1..=length));
    let (from, to) = (one.min(other), one.max(other));
    (from, to.max(from + 1))
}

#[cfg(test)]
mod tests {
    use super::super::XcsSettings;
    use super::*;
    use crate::rng::{Purpose, stream};

    fn empty(settings: XcsSettings) -> Xcs {
        Xcs::new(settings, 3, 2).unwrap()
    }

    fn experienced(condition: &str, action: u16) -> XcsRule {
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

    #[test]
    fn children_match_the_situation_and_average_their_parents_only_if_crossed() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        for crossover_share in [0.0, 1.0] {
            let mut xcs = empty(XcsSettings { crossover_share, ..XcsSettings::default() });
            xcs.settings.mutation_share = 0.0;
            xcs.add(XcsRule { numerosity: 2, ..experienced("10#", 0) });
            xcs.add(XcsRule { prediction: 200.0, fitness: 0.75, ..experienced("#01", 0) });
            let [first, second] = xcs.children([0, 1], 0b101, &mut rng);
            let values = |child: &XcsRule| (child.prediction, child.fitness);
            let near = |(a, b): (f32, f32), (c, d): (f32, f32)| {
                assert!((a - c).abs() < 1e-4 && (b - d).abs() < 1e-6, "{a}, {b}");
            };
            let one_of_two = 0.25;
            if crossover_share == 0.0 {
                near(values(&first), (100.0, 0.1 * one_of_two));
                near(values(&second), (200.0, 0.075));
            } else {
                near(values(&first), (150.0, 0.05));
                near(values(&second), (150.0, 0.05));
            }
            assert!(first.condition.matches(0b101) && second.condition.matches(0b101));
            assert_eq!((first.numerosity, first.experience), (1, 0));
        }
    }

    #[test]
    fn a_mutated_action_is_another_one() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut xcs = Xcs::new(XcsSettings::default(), 3, 3).unwrap();
        xcs.settings.mutation_share = 1.0;
        xcs.add(experienced("###", 1));
        let mut seen = [0; 3];
        for _ in 0..50 {
            for child in xcs.children([0, 0], 0b010, &mut rng) {
                assert_eq!(child.condition.to_string(), "010");
                seen[usize::from(child.action)] += 1;
            }
        }
        assert!(seen[0] > 20 && seen[1] == 0 && seen[2] > 20, "{seen:?}");
    }

    #[test]
    fn every_segment_has_a_symbol_and_reaches_both_ends() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let segments: Vec<_> = (0..200).map(|_| segment(3, &mut rng)).collect();
        assert!(segments.iter().all(|&(from, to)| from < to && to <= 3));
        assert!(
            segments.contains(&(0, 3)) && segments.contains(&(2, 3)) && segments.contains(&(0, 1))
        );
        assert_eq!(segment(1, &mut rng), (0, 1));
    }
}
