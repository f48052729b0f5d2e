//! How XCS makes new rules: covering and the genetic algorithm.

use rand::Rng;
use rand::RngExt;

use super::chance::{happens, roulette};
use super::condition::Condition;
use super::xcs::Xcs;
use super::xcs_rules::XcsRule;

/// Share of its parents' fitness with which a child starts (Butz and Wilson 2001).
const CHILD_FITNESS: f32 = 0.1;

impl Xcs {
    /// Makes a rule that matches a situation and advises an action.
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

    /// Breeds two children from the rules of an action set, for the situation of the set, if the genetic algorithm last ran among them
    /// long enough ago. `alive` is a set of rule indices that stays valid.
    pub(super) fn evolve(
        &mut self,
        set: &[usize],
        bits: u32,
        alive: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) {
        if set.is_empty() || self.mean_age(set) <= f64::from(self.settings.ga_interval) {
            return;
        }
        set.iter().for_each(|&index| self.rules[index].time_stamp = self.time);
        let weights: Vec<f64> = set.iter().map(|&i| f64::from(self.rules[i].fitness)).collect();
        let parents = [set[roulette(&weights, rng)], set[roulette(&weights, rng)]];
        for child in self.children(parents, bits, rng) {
            self.settle(child, parents);
        }
        self.delete_surplus(self.rules.len(), alive, rng);
    }

    /// Returns the mean number of decisions since the genetic algorithm last ran among these rules.
    fn mean_age(&self, set: &[usize]) -> f64 {
        let (mut ages, mut count) = (0.0, 0.0);
        for rule in set.iter().map(|&index| &self.rules[index]) {
            let age = self.time.saturating_sub(rule.time_stamp);
            ages += age as f64 * f64::from(rule.numerosity);
            count += f64::from(rule.numerosity);
        }
        ages / count
    }

    /// Makes two children of two rules, for a situation that both parents match.
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

    /// Copies one of the equal rules that a rule stands for, with its share of the fitness.
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

/// Draws a segment of at least one symbol between two random cuts.
fn segment(length: usize, rng: &mut impl Rng) -> (usize, usize) {
    let (one, other) = (rng.random_range(0..length), rng.random_range(1..=length));
    let (from, to) = (one.min(other), one.max(other));
    (from, to.max(from + 1))
}

#[cfg(test)]
mod tests {
    use super::super::XcsSettings;
    use super::super::xcs_rules::samples::experienced;
    use super::*;
    use crate::rng::{Purpose, stream};

    #[test]
    fn children_match_the_situation_and_average_their_parents_only_if_crossed() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        for crossover_share in [0.0, 1.0] {
            let mut xcs = Xcs::new(XcsSettings::default(), 3, 2).unwrap();
            xcs.settings.crossover_share = crossover_share;
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
