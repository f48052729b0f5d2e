//! A study of evolving bodies over several seeds: it tests whether protection and an archive pay, and whether a split of a
//! block changes little.
//!
//! All runs have the settings of the preset `bodies` and the same budget. They differ in the strategy alone.

mod arm;
mod claims;
mod measure;
mod splits;

pub use arm::Arm;
pub use claims::{claims, study_records};
