//! The experience of one episode, from which a learner that all episodes of a run share can learn.

use super::classifiers::{EpisodeEnd, RecordedDecision};
use super::q_table::Transition;

/// The experience of one episode, in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub enum Episode {
    /// Of a table.
    Table(Vec<Transition>),
    /// Of a system of rules: its decisions, and how the episode ended.
    Rules(Vec<RecordedDecision>, EpisodeEnd),
    /// The same of a system of rules at each joint, from the head.
    Joints(Vec<(Vec<RecordedDecision>, EpisodeEnd)>),
}
