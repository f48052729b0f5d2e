//! The experience from which a classifier system learns: recorded decisions, how an episode ended, and a report of the
//! replay.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::condition::all_bits;
use crate::check::{Invalid, within};

/// One decision of an episode: the situation, the action, and the reward until the next decision.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedDecision {
    /// Bits of the situation in which the decision was taken.
    pub bits: u32,
    /// Index of the chosen action.
    pub action: u16,
    /// Reward between this decision and the next.
    pub reward: f32,
}

impl RecordedDecision {
    /// Checks a decision for a learner of `length` bits and `actions` actions.
    ///
    /// # Errors
    /// Returns an error for a bit beyond the length, an unknown action, or a reward outside `rewards`.
    pub fn check(
        &self,
        length: usize,
        actions: usize,
        rewards: RangeInclusive<f32>,
    ) -> Result<(), Invalid> {
        within("bits", self.bits, 0..=all_bits(length))?;
        within("action", usize::from(self.action), 0..=actions.saturating_sub(1))?;
        within("reward", self.reward, rewards)
    }
}

/// The way in which an episode ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum EpisodeEnd {
    /// The task ended for good: nothing could follow, so the return of the last action is its reward.
    Terminal,
    /// The time was up although the task could have continued (Pardo et al. 2018). The return of the last action is its reward plus the
    /// discounted value of the situation to which it led. If no rule matches this situation, nothing is learned from the last action.
    TimeOut {
        /// The bits of the situation after the last action.
        bits: u32,
    },
}

impl EpisodeEnd {
    /// Checks the end of an episode for a learner of `length` bits.
    ///
    /// # Errors
    /// Returns an error for a bit beyond the length.
    pub fn check(&self, length: usize) -> Result<(), Invalid> {
        match *self {
            Self::Terminal => Ok(()),
            Self::TimeOut { bits } => within("bits", bits, 0..=all_bits(length)),
        }
    }
}

/// Checks an episode for a learner of `length` bits and `actions` actions.
///
/// # Errors
/// Returns an error if a decision or the end does not fit the learner, or if a reward is outside `rewards`.
pub fn check_episode(
    decisions: &[RecordedDecision],
    end: EpisodeEnd,
    [length, actions]: [usize; 2],
    rewards: RangeInclusive<f32>,
) -> Result<(), Invalid> {
    for (index, decision) in decisions.iter().enumerate() {
        decision
            .check(length, actions, rewards.clone())
            .map_err(|error| error.inside(&format!("decisions[{index}]")))?;
    }
    end.check(length)
}

/// Counts of the decisions of a replay.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReplayReport {
    /// Number of decisions replayed.
    pub decisions: u32,
    /// Number of decisions for which a rule was missing and had to be made.
    pub covered: u32,
}

impl ReplayReport {
    /// Adds the counts of another replay.
    pub fn add(&mut self, other: Self) {
        self.decisions = self.decisions.saturating_add(other.decisions);
        self.covered = self.covered.saturating_add(other.covered);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_decisions_are_refused_with_field_value_and_range() {
        let good = RecordedDecision { bits: 7, action: 1, reward: 0.0 };
        let refused = |decision: RecordedDecision| {
            decision.check(3, 2, 0.0..=1000.0).unwrap_err().to_string()
        };
        assert_eq!(good.check(3, 2, 0.0..=1000.0), Ok(()));
        assert_eq!(refused(RecordedDecision { bits: 8, ..good }), "bits is 8; allowed: 0 to 7");
        assert_eq!(refused(RecordedDecision { action: 2, ..good }), "action is 2; allowed: 0 to 1");
        assert!(
            refused(RecordedDecision { reward: f32::NAN, ..good }).starts_with("reward is NaN")
        );
        assert!(EpisodeEnd::TimeOut { bits: 8 }.check(3).is_err());
        assert_eq!(EpisodeEnd::TimeOut { bits: u32::MAX }.check(32), Ok(()));
    }
}
