//! How XCS learns from whole episodes, where situations show only a part of the world.
//!
//! The payoff of a decision is a mixture of the prediction for the next situation and of what was actually earned later: the λ-return. A
//! wrong prediction is then not passed on in full (see `q_table::returns`). Textbook XCS only uses the prediction, and covers all actions
//! of a situation. In this form, a rule is only made for the recorded action, so that the population only contains actions that were
//! tried.

use rand::Rng;

use super::chance::largest_beside;
use super::experience::{EpisodeEnd, RecordedDecision, ReplayReport};
use super::xcs::Xcs;
use crate::check::Invalid;

impl Xcs {
    /// Learns from a recorded episode backwards in time. `trace` is the share of later rewards in a payoff, from 0 (only the prediction
    /// counts) to 1 (only later rewards count). Unless `may_repeat` is set, no action is expected to follow itself.
    ///
    /// Returns an error if a decision or the end does not fit the learner, or if a reward is not from -1e6 to 1e6. Then nothing is
    /// learned.
    pub fn learn_returns(
        &mut self,
        decisions: &[RecordedDecision],
        end: EpisodeEnd,
        trace: f32,
        may_repeat: bool,
        rng: &mut impl Rng,
    ) -> Result<ReplayReport, Invalid> {
        self.check_experience(decisions, end)?;
        let mut report = ReplayReport::default();
        let mut next = match end {
            EpisodeEnd::Terminal => None,
            EpisodeEnd::TimeOut { bits } => Some(bits),
        };
        let mut later = None;
        for decision in decisions.iter().rev() {
            let action = usize::from(decision.action);
            let except = (!may_repeat).then_some(action);
            let guess =
                next.map_or(0.0, |bits| largest_beside(&self.prediction_array(bits), except));
            let future = later.map_or(guess, |later| (1.0 - trace) * guess + trace * later);
            let payoff = decision.reward + self.settings.discount * future;
            let is_covered = self.learn_payoff(decision, payoff, rng);
            report.add(ReplayReport { decisions: 1, covered: u32::from(is_covered) });
            (next, later) = (Some(decision.bits), Some(payoff));
        }
        Ok(report)
    }

    /// Corrects the rules that advise a recorded action, after making one if there is none. Then new rules may be bred from them. Returns
    /// whether a rule was made for the action.
    fn learn_payoff(
        &mut self,
        decision: &RecordedDecision,
        payoff: f32,
        rng: &mut impl Rng,
    ) -> bool {
        self.time += 1;
        let (bits, action) = (decision.bits, usize::from(decision.action));
        let mut rules = self.action_set(bits, action);
        let is_covered = rules.is_empty();
        if is_covered {
            let older = self.rules.len();
            let rule = self.covering_rule(bits, action, rng);
            self.add(rule);
            // The new rule cannot be deleted before it has learned.
            self.delete_surplus(older, &mut Vec::new(), rng);
            rules = self.action_set(bits, action);
        }
        self.update(&rules, payoff);
        self.evolve(&rules, bits, &mut Vec::new(), rng);
        is_covered
    }

    /// Returns the indices of the rules that match a situation and advise an action, in ascending order.
    fn action_set(&self, bits: u32, action: usize) -> Vec<usize> {
        let mut matched = self.match_set(bits);
        matched.retain(|&index| self.masks.action(index) == action);
        matched
    }
}

#[cfg(test)]
mod tests {
    use super::super::xcs_rules::samples::quiet;
    use super::*;
    use crate::learn::classifiers::XcsSettings;
    use crate::rng::{Purpose, stream};

    fn prediction(xcs: &Xcs, bits: u32, action: usize) -> Option<f32> {
        xcs.prediction_array(bits)[action]
    }

    fn step(bits: u32, action: u16, reward: f32) -> RecordedDecision {
        RecordedDecision { bits, action, reward }
    }

    #[test]
    fn a_payoff_mixes_what_came_later_with_the_prediction() {
        // Action 2 is predicted to earn 500 in situation 1, but action 1 is taken and earns 100.
        for (trace, expected) in [(0.0, 355.0), (0.5, 213.0), (1.0, 71.0)] {
            let mut xcs = quiet(2, 3);
            let mut rng = stream(1, 0, 0, Purpose::Birth);
            let known = xcs.learn(&[step(1, 2, 500.0)], EpisodeEnd::Terminal, &mut rng);
            assert!(known.is_ok());
            let episode = [step(0, 0, 0.0), step(1, 1, 100.0)];
            let report = xcs.learn_returns(&episode, EpisodeEnd::Terminal, trace, false, &mut rng);
            assert_eq!(report.unwrap().decisions, 2);
            let found = prediction(&xcs, 0, 0).unwrap();
            assert!((found - expected).abs() < 0.1, "{found} instead of {expected}");
        }
    }

    #[test]
    fn only_recorded_actions_get_rules_and_none_follows_itself() {
        let mut xcs = quiet(2, 3);
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut learn = |decisions: &[RecordedDecision], end| {
            xcs.learn_returns(decisions, end, 0.0, false, &mut rng).unwrap().covered
        };
        assert_eq!(learn(&[step(1, 0, 100.0)], EpisodeEnd::Terminal), 1);
        let time_is_up = EpisodeEnd::TimeOut { bits: 1 };
        assert_eq!(learn(&[step(0, 0, 8.0)], time_is_up), 1);
        assert_eq!(learn(&[step(0, 1, 8.0)], time_is_up), 1);
        assert_eq!(learn(&[step(0, 1, 8.0)], time_is_up), 0);
        assert!((prediction(&xcs, 0, 0).unwrap() - 8.0).abs() < 0.01);
        assert!((prediction(&xcs, 0, 1).unwrap() - 79.0).abs() < 0.01);
        assert_eq!(prediction(&xcs, 0, 2), None);
        assert_eq!(xcs.rules.len(), 3);
    }

    #[test]
    fn a_full_population_stays_within_its_limit() {
        let settings = XcsSettings { population: 6, ..XcsSettings::default() };
        let mut xcs = Xcs::new(settings, 4, 3).unwrap();
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        for round in 0..200_u32 {
            let episode: Vec<_> =
                (0..20).map(|i| step((i + round) % 16, (i % 3) as u16, 1.0)).collect();
            xcs.learn_returns(&episode, EpisodeEnd::TimeOut { bits: 3 }, 0.8, false, &mut rng)
                .unwrap();
            assert!(xcs.check().is_ok() && xcs.numerosity <= 6);
        }
        let bad = [step(0, 0, 0.0), step(16, 0, 0.0)];
        assert!(xcs.learn_returns(&bad, EpisodeEnd::Terminal, 0.8, false, &mut rng).is_err());
    }
}
