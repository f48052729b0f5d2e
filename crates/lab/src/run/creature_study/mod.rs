//! A study of creatures over several seeds: whether they move on flat ground, whether they climb low stairs, and how much their
//! shapes differ.
//!
//! All runs have the settings of the preset `creatures`, but for what their arm changes.

mod arm;
mod claims;

pub use arm::CreatureArm;
pub use claims::{creature_claims, creature_records};
