//! A study of POET: whether it solves stairs that a direct search does not, after the control experiment of Wang et al. (2019).
//!
//! Of the stairs that a run of POET has solved, the hardest are those on which the agents of all its stairs do worst on average.
//! For each of them, direct searches from scratch may spend as many trials as POET did on these stairs and all their ancestors.

mod claims;
mod controls;
mod hardest;

pub use claims::{poet_claims, poet_records};
pub use controls::{PlannedControl, planned_controls, run_controls};
pub use hardest::hardest_stairs;

/// Share of the way from which on a trial is a success.
const SUCCESS: f32 = 0.85;
/// Perturbed trials of the agent of solved stairs.
const TRIALS: u32 = 10;
/// Number of them that have to succeed.
const MUST_SUCCEED: u32 = 8;
/// Number of the hardest stairs.
const HARDEST: usize = 5;
/// Direct searches on each of them.
const SEEDS: u64 = 10;
/// Share of the way that none of the direct searches may cover on stairs that only POET solves.
const DIRECT: f32 = 0.55;
