//! Removes the rules of a population that none of its decisions needs.
//!
//! While it learns, XCS keeps many rules that change no decision: they are new, or redundant. In a system that no longer learns and that
//! people read, they make reading harder. Several algorithms make rule sets compact after learning (Wyatt, Bull and Parmee, "Building
//! Compact Rulesets for Describing Continuous-Valued Problem Spaces Using a Learning Classifier System"); they judge by samples. If
//! situations have few bits, all situations can be examined, so that no decision changes.

use super::chance::two_largest;
use super::xcs::Xcs;

/// Number of bits of a situation up to which all situations are examined: 4,096 of them.
const MOST_BITS: usize = 12;

impl Xcs {
    /// Returns this system without the rules that no choice needs. The least fit rules are removed first. In every situation the best
    /// action stays the best, and the second best the second best, which is chosen where the best is the present action. Predictions
    /// change. A system whose situations have more than twelve bits stays as it is.
    #[must_use]
    pub fn compacted(&self) -> Self {
        if self.situation_bits > MOST_BITS {
            return self.clone();
        }
        let mut situations: Vec<MatchedSituation> = (0..1 << self.situation_bits)
            .map(|bits| {
                let rules = self.match_set(bits);
                let predictions = self.predictions(&rules);
                MatchedSituation { leading: two_largest(&predictions), rules, predictions }
            })
            .collect();
        let mut matched_by = vec![Vec::new(); self.rules.len()];
        for (index, situation) in situations.iter().enumerate() {
            situation.rules.iter().for_each(|&rule| matched_by[rule].push(index));
        }
        let mut order: Vec<usize> = (0..self.rules.len()).collect();
        order.sort_by(|&a, &b| self.rules[a].fitness.total_cmp(&self.rules[b].fitness));
        let mut gone = Vec::new();
        for rule in order {
            let action = self.masks.action(rule);
            // Without a rule, only the prediction of the rule's own action changes.
            let without = |&index: &usize| {
                let situation = &mut situations[index];
                let others = situation.rules.iter().copied().filter(|&other| other != rule);
                let new = self.prediction(others.filter(|&of| self.masks.action(of) == action));
                let old = std::mem::replace(&mut situation.predictions[action], new);
                let leads_alike = two_largest(&situation.predictions) == situation.leading;
                situation.predictions[action] = old;
                leads_alike.then_some(new)
            };
            let Some(predictions) =
                matched_by[rule].iter().map(without).collect::<Option<Vec<_>>>()
            else {
                continue;
            };
            for (&index, prediction) in matched_by[rule].iter().zip(predictions) {
                let situation = &mut situations[index];
                situation.predictions[action] = prediction;
                situation.rules.retain(|&other| other != rule);
            }
            gone.push(rule);
        }
        gone.sort_unstable();
        let mut compact = self.clone();
        for &rule in &gone {
            compact.numerosity -= std::mem::take(&mut compact.rules[rule].numerosity);
        }
        compact.remove_rules(&gone, []);
        compact
    }
}

/// A situation with the rules that match it and are not removed yet.
struct MatchedSituation {
    /// Indices of the rules, in ascending order.
    rules: Vec<usize>,
    /// Predicted payoff of each action; `None` without a rule.
    predictions: Vec<Option<f32>>,
    /// Best and second best action by all rules.
    leading: [Option<usize>; 2],
}

#[cfg(test)]
mod tests {
    use super::super::textbook::ActionChoice;
    use super::super::{EpisodeEnd, XcsSettings};
    use super::*;
    use crate::rng::{Purpose, stream};
    use rand::RngExt;

    /// Returns a system that has learned which of six bits the first two point to, from rewards that scatter.
    fn learned() -> Xcs {
        let settings = XcsSettings { population: 400, ..XcsSettings::default() };
        let mut xcs = Xcs::new(settings, 6, 3).expect("allowed");
        let mut rng = stream(1, 0, 0, Purpose::Learn);
        for _ in 0..2000 {
            let bits = rng.random_range(0..64_u32);
            let mut episode = xcs.episode();
            let action = episode.decide(bits, ActionChoice::Explore, &mut rng);
            let right = bits >> (2 + (bits & 3)) & 1;
            let chance: f32 = rng.random_range(0.0..200.0);
            episode.reward(chance + if action == right as usize { 500.0 } else { 0.0 });
            episode.finish(EpisodeEnd::Terminal, &mut rng);
        }
        xcs
    }

    #[test]
    fn a_compact_system_decides_alike_in_every_situation_with_fewer_rules() {
        let whole = learned();
        let compact = whole.compacted();
        assert!(compact.rules.len() * 2 < whole.rules.len(), "{}", compact.rules.len());
        for bits in 0..64 {
            assert_eq!(compact.frozen_action(bits), whole.frozen_action(bits), "{bits:06b}");
            let first_two = |xcs: &Xcs| two_largest(&xcs.prediction_array(bits));
            assert_eq!(first_two(&compact), first_two(&whole), "{bits:06b}");
        }
        assert_eq!(compact.check(), Ok(()));
        let copies: u32 = compact.rules.iter().map(|rule| rule.numerosity).sum();
        assert_eq!(compact.numerosity, copies);
        let is_kept = |rule| whole.rules.contains(rule);
        assert!(compact.rules.iter().all(is_kept), "rules stay as they are");
    }

    #[test]
    fn a_system_with_too_many_situations_stays_as_it_is() {
        let mut xcs = Xcs::new(XcsSettings::default(), 13, 2).expect("allowed");
        let mut rng = stream(1, 0, 0, Purpose::Learn);
        for bits in 0..50 {
            let mut episode = xcs.episode();
            episode.decide(bits, ActionChoice::Explore, &mut rng);
            episode.finish(EpisodeEnd::Terminal, &mut rng);
        }
        assert_eq!(xcs.compacted(), xcs);
    }
}
