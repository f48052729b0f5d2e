//! The experience of one episode, from which a learner that all episodes of a run share can learn.

use serde::{Deserialize, Serialize};

use super::classifiers::{EpisodeEnd, RecordedDecision};
use super::q_table::Transition;
use crate::check::{Invalid, within};

/// The experience of one episode, in the order of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Episode {
    /// The experience of a table.
    Table(Vec<Transition>),
    /// The experience of a system of rules: its decisions, and how the episode ended.
    Rules(Vec<RecordedDecision>, EpisodeEnd),
    /// The experience of the system of rules at each joint, from the head: its decisions, and how the episode ended.
    Joints(Vec<(Vec<RecordedDecision>, EpisodeEnd)>),
}

/// Maximum number of decisions in an episode: more than ten minutes have at the shortest interval.
const MOST_DECISIONS: usize = 1_000_000;

impl Episode {
    /// Checks the length. A learner checks each decision when it learns from it, and knows which situations there are.
    ///
    /// # Errors
    /// The episode is longer than any.
    pub fn check(&self) -> Result<(), Invalid> {
        let length = match self {
            Self::Table(transitions) => transitions.len(),
            Self::Rules(decisions, _) => decisions.len(),
            Self::Joints(joints) => joints.iter().map(|(decisions, _)| decisions.len()).sum(),
        };
        within("length of the episode", length, 0..=MOST_DECISIONS)
    }
}
