//! One episode of XCS, decision by decision: choose, reward, and correct the rules that led here.
//!
//! The payoff of an action is known one decision later, P = r + γ · max PA, so the rules that chose it wait in a
//! pending set.

use rand::Rng;
use rand::RngExt;

use super::chance::random_largest;
use super::condition::all_bits;
use super::experience::{ActionChoice, EpisodeEnd, ReplayReport};
use super::limits::MOST_REWARD;
use super::xcs::Xcs;

/// An episode in progress. If it is dropped instead of finished, nothing is learned from its last action.
#[derive(Debug)]
pub struct XcsEpisode<'a> {
    xcs: &'a mut Xcs,
    /// The last action, whose payoff is still unknown.
    pending: Option<PendingActionSet>,
    /// The match set, kept for its memory.
    matched: Vec<usize>,
    report: ReplayReport,
}

/// The rules that advised the last action.
#[derive(Debug)]
pub(super) struct PendingActionSet {
    /// The situation in which the action was taken.
    pub bits: u32,
    /// Indices of the rules, rising.
    pub rules: Vec<usize>,
    /// Reward since the action.
    pub reward: f32,
    /// Whether the genetic algorithm may run among the rules.
    pub evolves: bool,
}

impl<'a> XcsEpisode<'a> {
    pub(super) fn new(xcs: &'a mut Xcs) -> Self {
        Self { xcs, pending: None, matched: Vec::new(), report: ReplayReport::default() }
    }

    /// Takes a decision in a situation and returns the action; then learns from the action before it, whose payoff
    /// is now known. Bits beyond those of the learner are ignored; an action given beyond the last is the last.
    pub fn decide(&mut self, bits: u32, choice: ActionChoice, rng: &mut impl Rng) -> usize {
        let bits = bits & all_bits(self.xcs.situation_bits);
        self.xcs.time += 1;
        let mut nothing = Vec::new();
        let waiting = self.pending.as_mut().map_or(&mut nothing, |pending| &mut pending.rules);
        let covered = self.xcs.match_or_cover(bits, &mut self.matched, waiting, rng);
        self.report.decisions = self.report.decisions.saturating_add(1);
        self.report.covered = self.report.covered.saturating_add(u32::from(covered));
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
            self.xcs.reinforce(pending, largest(&predictions), &mut rules, rng);
        }
        let evolves = choice != ActionChoice::Exploit;
        self.pending = Some(PendingActionSet { bits, rules, reward: 0.0, evolves });
        action
    }

    /// Adds a reward for the last action. It is limited to -1e6 to 1e6; NaN counts as 0.
    pub fn reward(&mut self, reward: f32) {
        if let Some(pending) = &mut self.pending
            && !reward.is_nan()
        {
            pending.reward = (pending.reward + reward).clamp(-MOST_REWARD, MOST_REWARD);
        }
    }

    /// Learns from the last action and reports the episode.
    pub fn finish(mut self, end: EpisodeEnd, rng: &mut impl Rng) -> ReplayReport {
        let next_payoff = match end {
            EpisodeEnd::Terminal => Some(0.0),
            EpisodeEnd::TimeOut { bits } => {
                let predictions = self.xcs.prediction_array(bits);
                predictions.iter().any(Option::is_some).then(|| largest(&predictions))
            }
        };
        if let (Some(pending), Some(next_payoff)) = (self.pending.take(), next_payoff) {
            self.xcs.reinforce(pending, next_payoff, &mut Vec::new(), rng);
        }
        self.report
    }
}

impl Xcs {
    /// Corrects the rules of an action that earned its reward and led to a situation of payoff `next_payoff`, then
    /// lets new rules arise among them. `alive` is a set of rule indices that stays valid.
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
            self.evolve(&pending, alive, rng);
        }
    }
}

/// The largest prediction; 0 if there is none.
fn largest(predictions: &[Option<f32>]) -> f32 {
    let largest = predictions.iter().flatten().copied().reduce(f32::max);
    largest.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::classifiers::{RecordedDecision, XcsRule, XcsSettings};
    use crate::rng::{Purpose, stream};

    /// An XCS with one rule for each bit and action, in which neither crossover nor mutation nor the genetic
    /// algorithm takes part.
    fn quiet() -> Xcs {
        let settings =
            XcsSettings { ga_interval: 1.0e9, wildcard_share: 0.0, ..XcsSettings::default() };
        Xcs::new(settings, 1, 2).unwrap()
    }

    fn rule_of(xcs: &Xcs, bits: u32, action: u16) -> &XcsRule {
        xcs.rules.iter().find(|r| r.condition.matches(bits) && r.action == action).unwrap()
    }

    fn near(value: f32, expected: f32) {
        assert!(
            (value - expected).abs() <= 1e-4 * expected.abs().max(1.0),
            "{value} is not {expected}"
        );
    }

    #[test]
    fn updates_agree_with_those_by_hand() {
        let mut xcs = quiet();
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let once = |reward| [RecordedDecision { bits: 1, action: 0, reward }];
        xcs.learn(&once(1000.0), EpisodeEnd::Terminal, &mut rng).unwrap();
        // The first update has rate 1: the error is the whole miss, the prediction the payoff.
        let rule = rule_of(&xcs, 1, 0);
        near(rule.error, 999.99);
        near(rule.prediction, 1000.0);
        near(rule.fitness, 0.01 + 0.2 * 0.99);
        assert_eq!(rule.experience, 1);
        xcs.learn(&once(0.0), EpisodeEnd::Terminal, &mut rng).unwrap();
        // The second has rate 1/2, and misses by 1000 before the prediction moves.
        let rule = rule_of(&xcs, 1, 0);
        near(rule.error, 999.995);
        near(rule.prediction, 500.0);
        assert_eq!(rule_of(&xcs, 1, 1).experience, 0, "the other action learned nothing");
    }

    #[test]
    fn payoff_flows_back_from_the_next_situation() {
        let mut xcs = quiet();
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
        let mut xcs = quiet();
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
        let mut xcs = quiet();
        let seen = [0, 0, 1, 1, 0, 1].map(|bits| RecordedDecision { bits, action: 0, reward: 0.0 });
        let report = xcs.learn(&seen, EpisodeEnd::Terminal, &mut rng).unwrap();
        assert_eq!(report, ReplayReport { decisions: 6, covered: 2 });
    }

    #[test]
    fn exploiting_takes_the_best_action_and_exploring_all() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut xcs = quiet();
        let good = RecordedDecision { bits: 1, action: 1, reward: 1000.0 };
        xcs.learn(&[good], EpisodeEnd::Terminal, &mut rng).unwrap();
        let mut counts = [0; 2];
        for _ in 0..50 {
            assert_eq!(xcs.episode().decide(1, ActionChoice::Exploit, &mut rng), 1);
            counts[xcs.episode().decide(1, ActionChoice::Explore, &mut rng)] += 1;
        }
        assert!(counts[0] > 10 && counts[1] > 10, "{counts:?}");
    }
}
