//! Scoring: a [`Trial`] says where, how long and on which surface; a [`Rollout`] is one genome going
//! through it; [`evaluate`] runs a rollout to its end.
//!
//! This is the only scoring path there is. A headless run, the studio's stage, a replay and a test all
//! advance the same [`Rollout`]; they differ in who watches.

mod agent;
mod behaviour;
mod fitness;
mod history;
mod per_part;
mod perturbation;
mod recording;
mod repeats;
mod rollout;
mod trial;

pub use agent::AgentSettings;
pub use behaviour::Behaviour;
pub use fitness::{FITNESS_RANGE, Fitness};
pub use history::History;
pub use per_part::PerPart;
pub use perturbation::{Perturbation, PerturbationRange};
pub use recording::Recording;
pub use repeats::{Counts, Repeats};
pub use rollout::{Evaluation, Rollout, evaluate};
pub use trial::Trial;
