//! Learners: what a snake can learn from the outcome of its actions, within one run.

pub mod classifiers;
mod episode;
pub mod neat;
mod parameters;
pub mod q_table;
#[cfg(test)]
mod tasks;

pub use episode::Episode;
