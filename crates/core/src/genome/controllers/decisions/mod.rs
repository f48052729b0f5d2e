//! Decisions: four times a second the snake takes one of a few postures, by the values that it has learned for its situation.

mod policy;

pub use policy::Policy;
pub(super) use policy::hash_xcs;
pub(crate) use policy::shared;

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::encoding::{ControllerEncoding, SERVO_SETTINGS, SettingNames};
use super::servo::ServoGenes;
use crate::check::{Invalid, within};
use crate::genome::gene::{Genes, GenomeShape};
use crate::genome::space::GenomeSpace;
use crate::learn::q_table::QRule;
use crate::rng::{Purpose, stream};

/// Number of decisions per second.
pub const DECISIONS_PER_S: u32 = 4;

/// Weight of a reward one decision later relative to a reward now, for a table. It corresponds to a horizon of five seconds.
pub const DECISION_DISCOUNT: f32 = 0.95;

/// Names of the postures among which a decision chooses. A decision never keeps the posture of the decision before.
pub const POSTURES: [&str; 11] = [
    "straight",
    "fold in front",
    "fold in the middle",
    "fold behind",
    "fold all",
    "fold all by half",
    "fold in front, half behind",
    "half in front, fold behind",
    "head up",
    "head down",
    "tail down",
];

/// Number of situations that a table distinguishes: eleven last postures, three classes each of the head's gap, height and pitch, and the
/// answers to four questions ([`TABLE_QUESTIONS`]).
pub const TABLE_STATES: usize = POSTURES.len() * 3 * 3 * 3 * (1 << TABLE_QUESTIONS.len());

/// Questions by which a table distinguishes situations, besides classes of numbers.
pub const TABLE_QUESTIONS: [&str; 4] =
    ["moving", "middle at a riser", "folded in front", "folded behind"];

/// Bits by which rules distinguish situations, in their order: the words for a bit that is set, and for one that is not. There are few
/// bits, because each further one divides the experience of a run. The last five tell the last posture, so that a rule can depend on it.
pub const SITUATION_BITS: [[&str; 2]; 10] = [
    ["riser within half a metre", "no riser within half a metre"],
    ["riser at the middle", "no riser at the middle"],
    ["head up", "head not up"],
    ["head down", "head not down"],
    ["moving", "not moving"],
    ["first joint bent", "first joint straight"],
    ["first joint arched", "first joint not arched"],
    ["last joint bent", "last joint straight"],
    ["second joint folded", "second joint not folded"],
    ["last joint but one folded", "last joint but one not folded"],
];

/// A learned policy, and the servos that move the joints to its postures. This controller does not evolve: it has no genes, but learns
/// from the outcome of its decisions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DecisionGenes {
    /// Number of joints that the postures bend.
    pub joints: u32,
    /// Servos of the joints. Their bend range is the angle of a full bend.
    pub servo: ServoGenes,
    /// The learned policy: values or rules.
    pub policy: Policy,
    /// How the controller explores; `None` for play without chance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explorer: Option<Explorer>,
}

/// How an individual of a learning run explores.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Explorer {
    /// Probability with which a decision takes a random posture.
    pub epsilon: f32,
    /// Seed of the learning run.
    pub seed: u64,
    /// Generation of the individual.
    pub generation: u32,
    /// Index of the individual in its generation.
    pub individual: u32,
    /// Rule by which a table, in the individual's own copy, learns during the episode.
    pub rule: QRule,
}

impl Explorer {
    /// Returns the stream of the individual's random numbers.
    pub fn rng(&self) -> ChaCha8Rng {
        stream(self.seed, self.generation, self.individual, Purpose::Explore)
    }

    pub(super) fn check(&self) -> Result<(), Invalid> {
        within("explorer.epsilon", self.epsilon, 0.0..=1.0)?;
        self.rule.check().map_err(|error| error.inside("explorer.rule"))
    }

    /// Adds the bits that distinguish the explorer from others to a hash.
    pub(super) fn hash(&self, hash: &mut Xxh3Default) {
        let Self { epsilon, seed, generation, individual, rule: _ } = self;
        hash.update(&epsilon.to_bits().to_le_bytes());
        hash.update(&seed.to_le_bytes());
        hash.update(&generation.to_le_bytes());
        hash.update(&individual.to_le_bytes());
    }
}

impl ControllerEncoding for DecisionGenes {
    fn settings() -> SettingNames {
        &[SERVO_SETTINGS]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        Self {
            joints: shape.joints as u32,
            servo: ServoGenes { twist_range_rad: 0.0, ..ServoGenes::zeroed(space) },
            policy: Policy::default(),
            explorer: None,
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.servo.genes_without_twist(space, genes);
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    /// Returns half the rate of decisions: the frequency of a posture that changes with each decision.
    fn estimated_frequency_hz(&self) -> Option<f32> {
        Some(DECISIONS_PER_S as f32 / 2.0)
    }

    fn compact(&mut self) {
        if let Policy::Xcs(rules) = &mut self.policy {
            *rules = Arc::new(rules.compacted());
        }
    }

    fn check_rest(&self) -> Result<(), Invalid> {
        self.policy.check()?;
        self.explorer.as_ref().map_or(Ok(()), Explorer::check)
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen_without_twist(space);
    }

    fn hash_learned(&self, hash: &mut Xxh3Default) {
        self.policy.hash(hash);
        if let Some(explorer) = &self.explorer {
            explorer.hash(hash);
        }
    }
}
