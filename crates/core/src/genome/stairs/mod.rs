//! Stairs as a genome: a few numbers from which a staircase is built.

mod classes;
mod genes;
mod mutation;

pub use classes::{HELD_OUT_PER_CLASS, StairsClass, held_out};
pub use genes::{LANDING_M, StairsGenome};
pub use mutation::StairsChange;
