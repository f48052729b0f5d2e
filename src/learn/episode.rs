//! The experience of one episode, from which a learner that all episodes of a run share can learn.

use super::q_table::Transition;

/// The experience of one episode.
#[derive(Debug, Clone, PartialEq)]
pub enum Episode {
    /// Of a table: its transitions in the order of time.
    Table(Vec<Transition>),
}
