//! Learning classifier systems: populations of rules "if the situation looks like this, do that".
//!
//! A situation is a word of 1 to 32 bits, an action a small number. [`Xcs`] rates a rule by how accurately it predicts the payoff (Wilson
//! 1995), [`Zcs`] by the payoff itself (Wilson 1994). Both learn from recorded episodes with `learn_returns`, and act by what they have
//! learned with `frozen_action`, which changes nothing and draws no random number. Tests compare both with the results of published tasks,
//! with the updates of the papers, one decision after the other.
//!
//! Rules are stored in order of birth, sums are computed in this order, and every random number comes from the stream that is passed in.
//! The same experience and the same stream therefore give the same population on every machine.

mod chance;
mod condition;
mod experience;
mod limits;
mod mask_table;
#[cfg(test)]
mod replay_tests;
#[cfg(test)]
mod textbook;
mod xcs;
mod xcs_compaction;
mod xcs_deletion;
mod xcs_discovery;
#[cfg(test)]
mod xcs_episode;
mod xcs_returns;
mod xcs_rules;
mod xcs_saved;
mod xcs_settings;
mod xcs_subsumption;
#[cfg(test)]
mod xcs_textbook;
mod xcs_update;
mod zcs;
mod zcs_discovery;
#[cfg(test)]
mod zcs_episode;
mod zcs_returns;
mod zcs_rules;
#[cfg(test)]
mod zcs_textbook;

pub use condition::Condition;
pub use experience::{EpisodeEnd, RecordedDecision, ReplayReport};
pub use xcs::Xcs;
pub use xcs_rules::XcsRule;
pub use xcs_saved::SavedXcs;
pub use xcs_settings::XcsSettings;
pub use zcs::{SavedZcs, Zcs};
pub use zcs_rules::{ZcsRule, ZcsSettings};
