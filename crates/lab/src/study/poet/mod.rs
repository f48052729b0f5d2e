//! A study of POET: whether it solves stairs that a direct search does not solve, after the control experiment of Wang et al.
//! (2019).
//!
//! Among the stairs that a run of POET has solved, the hardest are those on which the agents of all its stairs do worst on average.
//! Direct searches from scratch on each of them may spend as many trials as POET did on these stairs and all their ancestors.

mod claims;
mod controls;
mod hardest;

pub use claims::{poet_claims, poet_records};
pub use controls::{PlannedControl, planned_controls, run_controls};
pub use hardest::hardest_stairs;
