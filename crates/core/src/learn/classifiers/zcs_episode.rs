//! One episode of ZCS as in its text, decision by decision: choose an action, pay the rules that led to this situation, and breed. Runs
//! learn from whole episodes instead (`zcs_returns`). This form serves to compare the parts that both have in common with published
//! results.
//!
//! Strength moves backwards in time by the bucket brigade: the rules whose action is taken pay a share of their strength, which goes to
//! the rules of the action before. A reward goes to the rules that have just acted.

use rand::Rng;

use super::chance::{largest_beside, roulette};
use super::condition::all_bits;
use super::experience::{EpisodeEnd, RecordedDecision, ReplayReport};
use super::limits::MOST_REWARD;
use super::textbook::{ActionChoice, random_largest};
use super::zcs::Zcs;
use crate::check::Invalid;

/// An episode of ZCS in progress.
#[derive(Debug)]
pub struct ZcsEpisode<'a> {
    zcs: &'a mut Zcs,
    /// Indices of the rules of the last action, in ascending order.
    last_set: Vec<usize>,
    report: ReplayReport,
}

impl Zcs {
    /// Learns from one recorded episode: the full cycle for every decision, with the recorded action instead of the roulette.
    ///
    /// If no rule advises the recorded action, one is made. Payments between rules follow the recorded actions, which an older population
    /// may have chosen.
    ///
    /// # Errors
    /// Returns an error if a decision or the end does not fit the learner, or if a reward is not from 0 to 1e6: strengths are the weights
    /// of a roulette and must not be negative. Then nothing is learned.
    pub fn learn(
        &mut self,
        decisions: &[RecordedDecision],
        end: EpisodeEnd,
        rng: &mut impl Rng,
    ) -> Result<ReplayReport, Invalid> {
        self.check_experience(decisions, end)?;
        let mut episode = self.episode();
        for decision in decisions {
            episode.decide(decision.bits, ActionChoice::Given(usize::from(decision.action)), rng);
            episode.reward(decision.reward);
        }
        Ok(episode.finish(end))
    }

    /// Starts an episode from which the system learns one decision at a time.
    pub fn episode(&mut self) -> ZcsEpisode<'_> {
        ZcsEpisode { zcs: self, last_set: Vec::new(), report: ReplayReport::default() }
    }
}

impl ZcsEpisode<'_> {
    /// Takes a decision in a situation, returns the action, and pays the rules of the action before. Bits beyond those of the learner are
    /// ignored. A given action beyond the last one counts as the last one.
    pub fn decide(&mut self, bits: u32, choice: ActionChoice, rng: &mut impl Rng) -> usize {
        let bits = bits & all_bits(self.zcs.situation_bits);
        let given = match choice {
            ActionChoice::Given(action) => Some(action.min(self.zcs.actions - 1)),
            ActionChoice::Explore | ActionChoice::Exploit => None,
        };
        let (matched, covered) = self.zcs.match_or_cover(bits, given, &mut self.last_set, rng);
        self.report.add(ReplayReport { decisions: 1, covered: u32::from(covered) });
        let action = given.unwrap_or_else(|| match choice {
            ActionChoice::Exploit => {
                random_largest(&self.zcs.strengths(&matched), rng).unwrap_or_default()
            }
            _ => {
                let strength = |&index: &usize| f64::from(self.zcs.rules[index].strength);
                let weights: Vec<f64> = matched.iter().map(strength).collect();
                self.zcs.masks.action(matched[roulette(&weights, rng)])
            }
        });
        let (mut set, others) = self.zcs.advisers(&matched, action);
        let bucket = self.zcs.collect(&set, self.zcs.settings.learning_rate);
        self.zcs.share_out(&self.last_set, self.zcs.settings.discount * bucket);
        self.zcs.end_decision(&others, &mut set, rng);
        self.last_set = set;
        action
    }

    /// Pays a reward to the rules of the last action. The reward is limited to 0 to 1e6; NaN counts as 0.
    pub fn reward(&mut self, reward: f32) {
        let reward = if reward.is_nan() { 0.0 } else { reward.clamp(0.0, MOST_REWARD) };
        self.zcs.share_out(&self.last_set, self.zcs.settings.learning_rate * reward);
    }

    /// Ends the episode and returns its counts. After a time-out the last rules are paid as if the strongest action of the next situation
    /// were taken, but the rules of this action pay nothing.
    pub fn finish(self, end: EpisodeEnd) -> ReplayReport {
        if let EpisodeEnd::TimeOut { bits } = end {
            let best = largest_beside(&self.zcs.strength_array(bits), None);
            let settings = &self.zcs.settings;
            let payment = settings.discount * settings.learning_rate * best;
            self.zcs.share_out(&self.last_set, payment);
        }
        self.report
    }
}

#[cfg(test)]
mod tests {
    use super::super::zcs::SavedZcs;
    use super::super::zcs_rules::{ZcsRule, ZcsSettings};
    use super::*;
    use crate::rng::{Purpose, stream};

    /// Returns a ZCS of three bits and two actions whose rules do not breed and are not weak.
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
        // Two rules pay a fifth of their strength and share a fifth of the reward. The third is taxed a tenth; the fourth does not match.
        assert_eq!(strengths(&zcs), [81.0, 41.0, 36.0, 200.0]);
        let mut zcs = quiet(&rules);
        let second = RecordedDecision { bits: 0b001, action: 1, reward: 0.0 };
        zcs.learn(&[first, second], EpisodeEnd::Terminal, &mut rng).unwrap();
        // The fourth rule pays 40, of which the two rules of the decision before get 71 %.
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
