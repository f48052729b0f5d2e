//! Scoring: a [`Trial`] defines place, duration and surfaces; a [`Rollout`] is one genome in a trial; [`evaluate`] runs a rollout to its
//! end.
//!
//! There is no other way to score. A headless run, the studio's stage, a replay and a test all advance the same [`Rollout`].

mod agent;
mod behaviour;
mod ending;
mod evaluation;
mod exam;
mod faults;
mod fitness;
mod history;
mod mirrored;
mod own_blocks;
mod own_body;
mod perturbation;
mod perturbation_range;
mod recording;
mod repeats;
mod rollout;
mod scored;
mod stairs_grid;
mod trial;
mod way_up;

pub use agent::AgentSettings;
pub use behaviour::Behaviour;
pub use ending::{Ending, EndingCount, EndingKind, Endings, Trick, median};
pub use evaluation::Evaluation;
pub use exam::{ExamCondition, ExamEnd, ExamSuite, SuiteResult, varied};
pub use fitness::{FITNESS_RANGE, Fitness, arrived_y_m};
pub use history::KeyframeHistory;
pub use mirrored::MirroredRollout;
pub use perturbation::Perturbation;
pub use perturbation_range::{PerturbationRange, StairsVariation};
pub use recording::Recording;
pub use repeats::{PerturbationList, RepeatAggregate, Repeats};
pub use rollout::Rollout;
pub use scored::{Scored, evaluate, score, score_together};
pub use stairs_grid::{StairsCell, StairsGrid};
pub(crate) use trial::FRONT_M;
pub use trial::Trial;

pub use crate::schema::PerPart;
