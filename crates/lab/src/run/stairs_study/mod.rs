//! A study of snakes that learn on many stairs: how many of the held-out stairs they climb, against snakes that learn on one.
//!
//! All runs have the settings of the preset `generalist`, but for what their arm changes.

mod arm;
mod claims;

pub use arm::StairsArm;
pub use claims::{stairs_claims, stairs_records};
