//! Published learning tasks, against which the learners are tested.

pub mod cliff;
pub mod double_pole;
pub mod dyna_maze;
pub mod grid;
pub mod multiplexer;
pub mod windy;
pub mod woods;
pub mod xor;
