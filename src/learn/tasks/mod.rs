//! Published learning tasks, against which the learners are tested.

pub mod cliff;
pub mod dyna_maze;
pub mod grid;
pub mod windy;
