//! Learners: what a snake can learn from the outcome of its actions, within one run.

pub mod q_table;
#[cfg(test)]
mod tasks;
