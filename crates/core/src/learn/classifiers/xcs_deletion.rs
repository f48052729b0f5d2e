//! How XCS loses rules: deletion from a full population, and removal from the vector of rules.
//!
//! Removing a rule shifts the indices of the rules behind it. Every function that removes rules therefore also corrects the sets of
//! indices that are still needed.

use rand::Rng;

use super::chance::Wheel;
use super::mask_table::forget;
use super::xcs::Xcs;
use super::xcs_rules::XcsRule;

impl Xcs {
    /// Deletes rules until the population is as large as allowed. Each deletion reduces the numerosity of one rule by one. The rule is
    /// drawn by its vote from the `deletable` oldest. Returns how many rules disappeared. `alive` is a set of rule indices that stays
    /// valid.
    ///
    /// The mean fitness to which votes refer is computed once, before the first of these deletions. This saves most of the work where a
    /// new situation needs a rule for each of many actions.
    pub(super) fn delete_surplus(
        &mut self,
        deletable: usize,
        alive: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) -> usize {
        if self.numerosity <= self.settings.population || deletable == 0 {
            return 0;
        }
        let mut wheel = Wheel::new(self.deletion_votes(deletable));
        let mut gone = Vec::new();
        while self.numerosity > self.settings.population && gone.len() < deletable {
            let victim = wheel.draw(rng);
            let rule = &mut self.rules[victim];
            if rule.numerosity == 0 {
                // A rule that has already disappeared is drawn only if rounding has left nothing of all votes.
                break;
            }
            let rest = f64::from(rule.numerosity - 1) / f64::from(rule.numerosity);
            wheel.scale(victim, rest);
            rule.numerosity -= 1;
            self.numerosity -= 1;
            if rule.numerosity == 0 {
                gone.push(victim);
            }
        }
        gone.sort_unstable();
        self.remove_rules(&gone, [alive]);
        gone.len()
    }

    /// Returns the deletion votes of the `count` oldest rules: action set size times numerosity, so that niches get equal room. The vote
    /// of an experienced rule whose fitness is far below the mean is multiplied by the ratio of the mean to its fitness.
    fn deletion_votes(&self, count: usize) -> Vec<f64> {
        let fitness = self.rules.iter().fold(0.0, |sum, rule| sum + f64::from(rule.fitness));
        let mean = fitness / f64::from(self.numerosity.max(1));
        let unfit = f64::from(self.settings.deletion_fitness_share) * mean;
        let vote = |rule: &XcsRule| {
            let numerosity = f64::from(rule.numerosity);
            let vote = f64::from(rule.action_set_size) * numerosity;
            let fitness = f64::from(rule.fitness);
            let is_experienced = rule.experience > self.settings.deletion_experience;
            if is_experienced && fitness < unfit * numerosity {
                vote * mean * numerosity / fitness.max(f64::from(f32::MIN_POSITIVE))
            } else {
                vote
            }
        };
        self.rules.iter().take(count).map(vote).collect()
    }

    /// Removes the rules without numerosity, which are those at the ascending indices `gone`. The sets of indices stay valid.
    pub(super) fn remove_rules<const N: usize>(
        &mut self,
        gone: &[usize],
        sets: [&mut Vec<usize>; N],
    ) {
        if gone.is_empty() {
            return;
        }
        self.rules.retain(|rule| rule.numerosity > 0);
        self.masks.remove_all(gone);
        for set in sets {
            // The removed indices are processed from the back, so that those in front stay right.
            gone.iter().rev().for_each(|&index| forget(set, index));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::mask_table::MaskTable;
    use super::super::textbook::ActionChoice;
    use super::super::xcs_rules::samples::experienced;
    use super::super::{EpisodeEnd, RecordedDecision, XcsSettings};
    use super::*;
    use crate::rng::{Purpose, stream};

    /// Returns a system of four rules whose numerosities add up to six.
    fn four_rules(population: u32) -> Xcs {
        let settings = XcsSettings { population, ..XcsSettings::default() };
        let mut xcs = Xcs::new(settings, 3, 2).unwrap();
        xcs.add(experienced("1##", 0));
        xcs.add(XcsRule { action_set_size: 6.0, numerosity: 3, ..experienced("0##", 0) });
        xcs.add(XcsRule { fitness: 0.001, ..experienced("#1#", 0) });
        xcs.add(XcsRule { fitness: 0.001, experience: 20, ..experienced("#0#", 0) });
        xcs
    }

    #[test]
    fn deletion_prefers_large_sets_and_experienced_unfit_rules() {
        let xcs = four_rules(6);
        let mean = (0.5 + 0.5 + 0.002) / 6.0;
        let expected = [2.0, 18.0, 2.0 * mean / 0.001, 2.0];
        for (vote, expected) in xcs.deletion_votes(4).into_iter().zip(expected) {
            assert!((vote / expected - 1.0).abs() < 1e-6, "{vote} is not {expected}");
        }
        assert_eq!(xcs.deletion_votes(2).len(), 2);
    }

    #[test]
    fn deletion_ends_at_the_population_and_spares_the_young() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        for population in 2..6 {
            for _ in 0..20 {
                let mut xcs = four_rules(6);
                xcs.settings.population = population;
                let mut alive = vec![1, 3];
                let gone = xcs.delete_surplus(3, &mut alive, &mut rng);
                assert_eq!((xcs.numerosity, xcs.rules.len()), (population, 4 - gone));
                assert_eq!(xcs.check(), Ok(()));
                let last = *alive.last().unwrap();
                assert_eq!(xcs.rules[last].condition.to_string(), "#0#");
                assert!(alive.len() == 1 || xcs.rules[alive[0]].condition.to_string() == "0##");
            }
        }
    }

    #[test]
    fn the_smallest_population_still_covers_every_action() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let settings = XcsSettings { population: 4, ga_interval: 1.0e9, ..XcsSettings::default() };
        let mut xcs = Xcs::new(settings, 8, 4).unwrap();
        for problem in 0..2_000_u32 {
            let mut episode = xcs.episode();
            episode.decide(problem * 37 % 256, ActionChoice::Explore, &mut rng);
            episode.decide(problem * 91 % 256, ActionChoice::Explore, &mut rng);
            let last = xcs.prediction_array(problem * 91 % 256);
            assert!(last.iter().all(Option::is_some), "{last:?}");
            assert_eq!(xcs.check(), Ok(()));
        }
    }

    #[test]
    fn the_same_stream_gives_the_same_population_and_its_parts_agree() {
        for action_set_subsumption in [false, true] {
            let settings = XcsSettings {
                population: 60,
                action_set_subsumption,
                gradient: true,
                ..XcsSettings::default()
            };
            let learned = |seed| {
                let mut xcs = Xcs::new(settings.clone(), 6, 4).unwrap();
                let mut rng = stream(seed, 0, 0, Purpose::Birth);
                for episode in 0..100_u32 {
                    let decisions: Vec<RecordedDecision> = (0..20_u32)
                        .map(|i| RecordedDecision {
                            bits: (episode * 29 + i * 7) % 64,
                            action: ((episode + i * i) % 4) as u16,
                            reward: if i % 3 == 0 { 1000.0 } else { 0.0 },
                        })
                        .collect();
                    xcs.learn(&decisions, EpisodeEnd::TimeOut { bits: 9 }, &mut rng).unwrap();
                }
                xcs
            };
            let xcs = learned(1);
            assert_eq!(xcs, learned(1));
            assert_ne!(xcs, learned(2));
            let masks = MaskTable::of(xcs.rules.iter().map(|rule| (rule.condition, rule.action)));
            assert_eq!(xcs.masks, masks);
            assert_eq!(xcs.numerosity, xcs.rules.iter().map(|rule| rule.numerosity).sum::<u32>());
            assert_eq!((xcs.check(), xcs.numerosity), (Ok(()), 60));
            assert!(xcs.rules.iter().any(|rule| rule.numerosity > 1));
        }
    }
}
