//! How ZCS learns from whole episodes, where situations show only a part of the world.
//!
//! Wilson's bucket brigade passes a share of each payment to the rules of the decision before. A reward therefore takes as many episodes
//! to reach the beginning as it is decisions away, and on the way it also reaches situations that only look alike. In this form, the rules
//! of a decision are paid at once from later rewards, mixed with the strength of the next rules (see `q_table::returns`).

use rand::Rng;

use super::chance::largest_beside;
use super::experience::{EpisodeEnd, RecordedDecision, ReplayReport};
use super::zcs::Zcs;
use crate::check::Invalid;

impl Zcs {
    /// Learns from a recorded episode backwards in time. `trace` is the share of later rewards in a payment, from 0 (only the strength of
    /// the next rules counts) to 1 (only later rewards count). No action is expected to follow itself.
    ///
    /// Returns an error if a decision or the end does not fit the learner, or if a reward is not from 0 to 1e6: strengths are the weights
    /// of a roulette and must not be negative. Then nothing is learned.
    pub fn learn_returns(
        &mut self,
        decisions: &[RecordedDecision],
        end: EpisodeEnd,
        trace: f32,
        rng: &mut impl Rng,
    ) -> Result<ReplayReport, Invalid> {
        self.check_experience(decisions, end)?;
        let discount = self.settings.discount;
        let mut next = match end {
            EpisodeEnd::Terminal => None,
            EpisodeEnd::TimeOut { bits } => Some(bits),
        };
        let mut later = None;
        let mut report = ReplayReport::default();
        for decision in decisions.iter().rev() {
            let action = usize::from(decision.action);
            let guess =
                next.map_or(0.0, |bits| largest_beside(&self.strength_array(bits), Some(action)));
            let future = later.map_or(guess, |later| (1.0 - trace) * guess + trace * later);
            let payoff = decision.reward + discount * future;
            let is_covered = self.pay(decision.bits, action, payoff, rng);
            report.add(ReplayReport { decisions: 1, covered: u32::from(is_covered) });
            (next, later) = (Some(decision.bits), Some(payoff));
        }
        Ok(report)
    }

    /// Pays the rules that advise a recorded action in a situation, after making one if there is none, and breeds. The rules first pay a
    /// share of their strength. It is not passed on, because `payoff` already contains the later rewards. Returns whether a rule was made.
    fn pay(&mut self, bits: u32, action: usize, payoff: f32, rng: &mut impl Rng) -> bool {
        let (matched, is_covered) = self.match_or_cover(bits, Some(action), &mut Vec::new(), rng);
        let (mut set, others) = self.advisers(&matched, action);
        let rate = self.settings.learning_rate;
        self.collect(&set, rate);
        self.share_out(&set, rate * payoff);
        self.end_decision(&others, &mut set, rng);
        is_covered
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::classifiers::ZcsSettings;
    use crate::rng::{Purpose, stream};

    fn step(bits: u32, action: u16, reward: f32) -> RecordedDecision {
        RecordedDecision { bits, action, reward }
    }

    /// Returns the total strength of an action after many episodes of two decisions, of which the second earns 1000.
    fn strength_of_the_first(trace: f32, episodes: u32) -> f32 {
        // The tax is 0, because it would also be taken from rules that match both situations.
        let settings =
            ZcsSettings { ga_rate: 0.0, population: 30, tax: 0.0, ..ZcsSettings::default() };
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let mut zcs = Zcs::new(settings, 2, 3, &mut rng).unwrap();
        for _ in 0..episodes {
            let episode = [step(0, 0, 0.0), step(1, 1, 1000.0)];
            zcs.learn_returns(&episode, EpisodeEnd::Terminal, trace, &mut rng).unwrap();
        }
        zcs.strength_array(0)[0].unwrap()
    }

    #[test]
    fn strengths_approach_what_came_later_and_at_once_with_a_trace() {
        let known = strength_of_the_first(1.0, 200);
        assert!((known - 710.0).abs() < 1.0, "{known}");
        let (with, without) = (strength_of_the_first(1.0, 2), strength_of_the_first(0.0, 2));
        assert!(with > 1.5 * without, "{with} and {without}");
    }
}
