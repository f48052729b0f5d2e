//! One episode of XCS as in the published texts, decision by decision: choose an action, receive the reward, and correct the rules that
//! led to this situation. Runs learn from whole episodes instead (`xcs_returns`). This form serves to compare the parts that both have in
//! common with published results.
//!
//! The payoff of an action, P = r + γ · max PA, is known one decision later. The rules that chose the action therefore wait in a pending
//! set.

use rand::Rng;
use rand::RngExt;

use super::chance::largest_beside;
use super::condition::all_bits;
use super::experience::{EpisodeEnd, RecordedDecision, ReplayReport};
use super::limits::MOST_REWARD;
use super::textbook::{ActionChoice, random_largest};
use super::xcs::Xcs;
use crate::check::Invalid;

/// An episode in progress. If it is dropped without `finish`, nothing is learned from its last action.
#[derive(Debug)]
pub struct XcsEpisode<'a> {
    xcs: &'a mut Xcs,
    /// Last action, whose payoff is still unknown.
    pending: Option<PendingActionSet>,
    /// Match set, whose memory is reused.
    matched: Vec<usize>,
    report: ReplayReport,
}

/// The rules that advised the last action, with the data needed to update them.
#[derive(Debug)]
struct PendingActionSet {
    /// Bits of the situation in which the action was taken.
    bits: u32,
    /// Indices of the rules, in ascending order.
    rules: Vec<usize>,
    /// Sum of the rewards since the action.
    reward: f32,
    /// Whether the genetic algorithm may run among the rules.
    evolves: bool,
}

impl XcsEpisode<'_> {
    /// Takes a decision in a situation and returns the action. Then it learns from the action before, whose payoff is now known. Bits
    /// beyond those of the learner are ignored. A given action beyond the last one counts as the last one.
    pub fn decide(&mut self, bits: u32, choice: ActionChoice, rng: &mut impl Rng) -> usize {
        let bits = bits & all_bits(self.xcs.situation_bits);
        self.xcs.time += 1;
        let mut nothing = Vec::new();
        let waiting = self.pending.as_mut().map_or(&mut nothing, |pending| &mut pending.rules);
        let covered = self.xcs.match_or_cover(bits, &mut self.matched, waiting, rng);
        self.report.add(ReplayReport { decisions: 1, covered: u32::from(covered) });
        let predictions = self.xcs.predictions(&self.matched);
        let action = match choice {
            ActionChoice::Given(action) => action.min(self.xcs.actions - 1),
            ActionChoice::Explore => rng.random_range(0..self.xcs.actions),
            ActionChoice::Exploit => random_largest(&predictions, rng).unwrap_or_default(),
        };
        let masks = &self.xcs.masks;
        let of_action = self.matched.iter().filter(|&&index| masks.action(index) == action);
        let mut rules: Vec<usize> = of_action.copied().collect();
        if let Some(pending) = self.pending.take() {
            self.xcs.reinforce(pending, largest_beside(&predictions, None), &mut rules, rng);
        }
        let evolves = choice != ActionChoice::Exploit;
        self.pending = Some(PendingActionSet { bits, rules, reward: 0.0, evolves });
        action
    }

    /// Adds a reward for the last action. The sum is limited to -1e6 to 1e6; NaN counts as 0.
    pub fn reward(&mut self, reward: f32) {
        if let Some(pending) = &mut self.pending
            && !reward.is_nan()
        {
            pending.reward = (pending.reward + reward).clamp(-MOST_REWARD, MOST_REWARD);
        }
    }

    /// Learns from the last action and returns the counts of the episode.
    pub fn finish(mut self, end: EpisodeEnd, rng: &mut impl Rng) -> ReplayReport {
        let next_payoff = match end {
            EpisodeEnd::Terminal => Some(0.0),
            EpisodeEnd::TimeOut { bits } => {
                let predictions = self.xcs.prediction_array(bits);
                let is_known = predictions.iter().any(Option::is_some);
                is_known.then(|| largest_beside(&predictions, None))
            }
        };
        if let (Some(pending), Some(next_payoff)) = (self.pending.take(), next_payoff) {
            self.xcs.reinforce(pending, next_payoff, &mut Vec::new(), rng);
        }
        self.report
    }
}

impl Xcs {
    /// Learns from one recorded episode: for every decision, the full cycle of covering, update, discovery and deletion, with the recorded
    /// action instead of a choice.
    ///
    /// # Errors
    /// Returns an error if a decision or the end does not fit the learner, or if a reward is not from -1e6 to 1e6. Then nothing is
    /// learned.
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
        Ok(episode.finish(end, rng))
    }

    /// Starts an episode from which the system learns one decision at a time.
    pub fn episode(&mut self) -> XcsEpisode<'_> {
        let report = ReplayReport::default();
        XcsEpisode { xcs: self, pending: None, matched: Vec::new(), report }
    }

    /// Makes a rule for each action that has none, and writes the indices of the matching rules into `matched`. Returns whether it made a
    /// rule. `waiting` is another set of rule indices that stays valid.
    ///
    /// Rules made for this situation cannot be deleted before the match set is complete. Otherwise a small population could endlessly
    /// delete the rules that it has just made.
    fn match_or_cover(
        &mut self,
        bits: u32,
        matched: &mut Vec<usize>,
        waiting: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) -> bool {
        let mut deletable = self.rules.len();
        let mut covered = false;
        // Deletion may remove the only rule of another action, so the search is repeated. Each round protects at least one more rule.
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

    /// Lets the most general accurate rule of an action set, the oldest among equal ones, absorb more special rules.
    fn subsume_within(&mut self, set: &mut Vec<usize>, alive: &mut Vec<usize>) {
        let mut subsumer: Option<usize> = None;
        for &index in set.iter().filter(|&&index| self.may_subsume(&self.rules[index])) {
            let wildcards = |index: usize| self.rules[index].condition.wildcards();
            if subsumer.is_none_or(|best| wildcards(index) > wildcards(best)) {
                subsumer = Some(index);
            }
        }
        let Some(subsumer) = subsumer else { return };
        let general = self.rules[subsumer].condition;
        let is_absorbed = |&&i: &&usize| general.is_more_general_than(&self.rules[i].condition);
        let absorbed: Vec<usize> = set.iter().filter(is_absorbed).copied().collect();
        for &index in &absorbed {
            self.rules[subsumer].numerosity += std::mem::take(&mut self.rules[index].numerosity);
        }
        self.remove_rules(&absorbed, [set, alive]);
    }

    /// Corrects the rules of an action by its reward and the payoff `next_payoff` of the situation to which it led. Then new rules may be
    /// bred from them. `alive` is a set of rule indices that stays valid.
    fn reinforce(
        &mut self,
        mut pending: PendingActionSet,
        next_payoff: f32,
        alive: &mut Vec<usize>,
        rng: &mut impl Rng,
    ) {
        self.update(&pending.rules, pending.reward + self.settings.discount * next_payoff);
        if self.settings.action_set_subsumption {
            self.subsume_within(&mut pending.rules, alive);
        }
        if pending.evolves {
            self.evolve(&pending.rules, pending.bits, alive, rng);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::xcs_rules::samples::{experienced, near, quiet};
    use super::*;
    use crate::learn::classifiers::{XcsRule, XcsSettings};
    use crate::rng::{Purpose, stream};

    fn rule_of(xcs: &Xcs, bits: u32, action: u16) -> &XcsRule {
        xcs.rules.iter().find(|r| r.condition.matches(bits) && r.action == action).unwrap()
    }

    #[test]
    fn updates_agree_with_those_by_hand() {
        let mut xcs = quiet(1, 2);
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let once = |reward| [RecordedDecision { bits: 1, action: 0, reward }];
        xcs.learn(&once(1000.0), EpisodeEnd::Terminal, &mut rng).unwrap();
        // The first update has the rate 1: the error becomes the whole deviation, the prediction the payoff.
        let rule = rule_of(&xcs, 1, 0);
        near(rule.error, 999.99);
        near(rule.prediction, 1000.0);
        near(rule.fitness, 0.01 + 0.2 * 0.99);
        assert_eq!(rule.experience, 1);
        xcs.learn(&once(0.0), EpisodeEnd::Terminal, &mut rng).unwrap();
        // The second update has the rate 1/2. The deviation is 1000 before the prediction changes.
        let rule = rule_of(&xcs, 1, 0);
        near(rule.error, 999.995);
        near(rule.prediction, 500.0);
        assert_eq!(rule_of(&xcs, 1, 1).experience, 0, "the other action learned nothing");
    }

    #[test]
    fn payoff_flows_back_from_the_next_situation() {
        let mut xcs = quiet(1, 2);
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let last = RecordedDecision { bits: 1, action: 0, reward: 1000.0 };
        xcs.learn(&[last], EpisodeEnd::Terminal, &mut rng).unwrap();
        let first = RecordedDecision { bits: 0, action: 1, reward: 50.0 };
        xcs.learn(&[first, last], EpisodeEnd::Terminal, &mut rng).unwrap();
        near(rule_of(&xcs, 0, 1).prediction, 50.0 + 0.71 * 1000.0);
    }

    #[test]
    fn time_up_is_worth_the_next_situation_and_an_end_is_not() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut xcs = quiet(1, 2);
        let good = RecordedDecision { bits: 1, action: 0, reward: 1000.0 };
        let idle = RecordedDecision { bits: 0, action: 0, reward: 0.0 };
        xcs.learn(&[idle], EpisodeEnd::TimeOut { bits: 1 }, &mut rng).unwrap();
        assert_eq!(rule_of(&xcs, 0, 0).experience, 0, "nothing is known of the next situation");
        xcs.learn(&[good], EpisodeEnd::Terminal, &mut rng).unwrap();
        xcs.learn(&[idle], EpisodeEnd::TimeOut { bits: 1 }, &mut rng).unwrap();
        near(rule_of(&xcs, 0, 0).prediction, 710.0);
        let rules = xcs.rules.len();
        xcs.learn(&[idle], EpisodeEnd::Terminal, &mut rng).unwrap();
        near(rule_of(&xcs, 0, 0).prediction, 355.0);
        assert_eq!(xcs.rules.len(), rules);
    }

    #[test]
    fn a_report_counts_the_decisions_that_needed_covering() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut xcs = quiet(1, 2);
        let seen = [0, 0, 1, 1, 0, 1].map(|bits| RecordedDecision { bits, action: 0, reward: 0.0 });
        let report = xcs.learn(&seen, EpisodeEnd::Terminal, &mut rng).unwrap();
        assert_eq!(report, ReplayReport { decisions: 6, covered: 2 });
    }

    #[test]
    fn exploiting_takes_the_best_action_and_exploring_all() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut xcs = quiet(1, 2);
        let good = RecordedDecision { bits: 1, action: 1, reward: 1000.0 };
        xcs.learn(&[good], EpisodeEnd::Terminal, &mut rng).unwrap();
        let mut counts = [0; 2];
        for _ in 0..50 {
            assert_eq!(xcs.episode().decide(1, ActionChoice::Exploit, &mut rng), 1);
            counts[xcs.episode().decide(1, ActionChoice::Explore, &mut rng)] += 1;
        }
        assert!(counts[0] > 10 && counts[1] > 10, "{counts:?}");
    }

    #[test]
    fn the_most_general_accurate_rule_of_an_action_set_absorbs_the_others() {
        let mut xcs = Xcs::new(XcsSettings::default(), 3, 2).unwrap();
        xcs.add(experienced("10#", 0));
        xcs.add(XcsRule { error: 500.0, ..experienced("###", 0) });
        xcs.add(experienced("1##", 0));
        xcs.add(XcsRule { numerosity: 4, ..experienced("101", 0) });
        xcs.add(experienced("##1", 0));
        let (mut set, mut alive) = (vec![0, 1, 2, 3, 4], vec![2, 3, 4]);
        xcs.subsume_within(&mut set, &mut alive);
        let texts: Vec<String> = xcs.rules.iter().map(|rule| rule.condition.to_string()).collect();
        assert_eq!(texts, ["###", "1##", "##1"], "the order of birth stays");
        assert_eq!((xcs.rules[1].numerosity, xcs.numerosity), (6, 8));
        assert_eq!((set, alive), (vec![0, 1, 2], vec![1, 2]));
    }
}
