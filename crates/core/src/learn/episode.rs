//! The experience of one episode. A learner that all episodes of a run have in common learns from it.

use serde::{Deserialize, Serialize};

use super::classifiers::{EpisodeEnd, RecordedDecision};
use super::q_table::Transition;
use crate::check::{Invalid, within};

/// The experience of one episode, in the order of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Episode {
    /// Experience for a table of values.
    Table(Vec<Transition>),
    /// Experience for a system of rules: its decisions, and how the episode ended.
    Rules(Vec<RecordedDecision>, EpisodeEnd),
    /// Experience for the system of rules at each joint, from the head: its decisions, and how the episode ended.
    Joints(Vec<(Vec<RecordedDecision>, EpisodeEnd)>),
}

/// Maximum number of decisions in an episode: more than ten minutes contain at the shortest interval.
const MOST_DECISIONS: usize = 1_000_000;

impl Episode {
    /// Checks the number of decisions. A learner checks each decision when it learns from it, because only the learner knows which
    /// situations there are.
    ///
    /// # Errors
    /// Returns an error if the episode has more than `MOST_DECISIONS` decisions.
    pub fn check(&self) -> Result<(), Invalid> {
        let length = match self {
            Self::Table(transitions) => transitions.len(),
            Self::Rules(decisions, _) => decisions.len(),
            Self::Joints(joints) => joints.iter().map(|(decisions, _)| decisions.len()).sum(),
        };
        within("length of the episode", length, 0..=MOST_DECISIONS)
    }
}
