//! Q-learning with a table: one value per state and action, learned from the outcome of actions that last one or more ticks.
//!
//! The rule is that of Watkins & Dayan ("Q-learning", Machine Learning 8, 1992), and for actions that last several ticks that of Sutton,
//! Precup & Singh ("Between MDPs and semi-MDPs", Artificial Intelligence 112, 1999). This module depends neither on snakes nor on physics:
//! states and actions are numbers, whose meaning the caller determines.
//!
//! A generation uses one master table. Each actor learns in a copy of it while it acts. The copies are discarded, and the master table
//! learns from the experience of all actors, in their order ([`ActionValues::learn_returns`]). The result does not depend on threads.

mod action_values;
mod exploration;
mod q_rule;
mod returns;
mod shaping;
mod sparse_values;
mod transition;

pub use action_values::{ActionValues, LARGEST_VALUE};
pub use exploration::{ExplorationLadder, epsilon};
pub use q_rule::QRule;
pub use shaping::shaped;
pub use sparse_values::{MOST_PAIRS, SparseRow, SparseValues};
pub use transition::{LARGEST_REWARD, Next, Transition};

#[cfg(test)]
mod actor_copies_tests;
#[cfg(test)]
mod grid_episode;
#[cfg(test)]
mod textbook_tests;
