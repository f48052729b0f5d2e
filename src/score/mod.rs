//! Scoring: a [`Trial`] says where, how long and on which surface; a [`Rollout`] is one genome going
//! through it; [`evaluate`] runs a rollout to its end.
//!
//! This is the only scoring path there is. A headless run, the studio's stage, a replay and a test all
//! advance the same [`Rollout`]; they differ in who watches.

mod rollout;
mod trial;

pub use rollout::{Evaluation, Rollout, evaluate};
pub use trial::{AgentSettings, Trial};
