//! A learned policy of decisions: a table of values, or a population of rules.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::{POSTURES, SITUATION_BITS, TABLE_STATES};
use crate::check::{Invalid, within};
use crate::learn::classifiers::{Condition, Xcs, Zcs};
use crate::learn::q_table::ActionValues;

/// A learned policy of decisions. Clones share its data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Policy {
    /// A table with the value of each posture in each situation.
    #[serde(with = "shared")]
    Table(Arc<ActionValues>),
    /// Rules that predict the value of a posture. Rules with accurate predictions are kept.
    #[serde(with = "shared")]
    Xcs(Arc<Xcs>),
    /// Rules whose strength grows with their reward.
    #[serde(with = "shared")]
    Zcs(Arc<Zcs>),
}

impl Default for Policy {
    fn default() -> Self {
        Self::Table(Arc::new(ActionValues::new(TABLE_STATES, POSTURES.len())))
    }
}

impl Policy {
    /// Checks that the policy has the expected numbers of postures and of situations.
    ///
    /// # Errors
    /// Returns the number that differs.
    pub fn check(&self) -> Result<(), Invalid> {
        let same = |bits: usize, actions: usize| {
            within("situation_bits", bits, SITUATION_BITS.len()..=SITUATION_BITS.len())?;
            within("actions", actions, POSTURES.len()..=POSTURES.len())
        };
        let checked = match self {
            Self::Table(table) => table.check(TABLE_STATES, POSTURES.len()),
            Self::Xcs(rules) => same(rules.situation_bits, rules.actions),
            Self::Zcs(rules) => same(rules.situation_bits, rules.actions),
        };
        checked.map_err(|error| error.inside("policy"))
    }

    /// Adds the bits of all learned data to a hash.
    pub(super) fn hash(&self, hash: &mut Xxh3Default) {
        match self {
            Self::Table(table) => {
                for state in 0..table.states {
                    for value in table.values(state) {
                        hash.update(&value.to_bits().to_le_bytes());
                    }
                    for visits in table.visits(state) {
                        hash.update(&visits.to_le_bytes());
                    }
                }
            }
            Self::Xcs(rules) => hash_xcs(rules, hash),
            Self::Zcs(rules) => {
                for rule in &rules.rules {
                    hash_rule(&rule.condition, rule.action, hash);
                    hash.update(&rule.strength.to_bits().to_le_bytes());
                }
            }
        }
    }
}

/// Adds the bits of all rules of an XCS to a hash.
pub fn hash_xcs(rules: &Xcs, hash: &mut Xxh3Default) {
    for rule in &rules.rules {
        hash_rule(&rule.condition, rule.action, hash);
        for number in [rule.prediction, rule.error, rule.fitness] {
            hash.update(&number.to_bits().to_le_bytes());
        }
        hash.update(&rule.numerosity.to_le_bytes());
    }
}

fn hash_rule(condition: &Condition, action: u16, hash: &mut Xxh3Default) {
    hash.update(&condition.care().to_le_bytes());
    hash.update(&condition.value().to_le_bytes());
    hash.update(&action.to_le_bytes());
}

/// Serialises the data of an `Arc` as if it were not shared.
pub mod shared {
    use std::sync::Arc;

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<T: Serialize, S: Serializer>(
        shared: &Arc<T>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        shared.as_ref().serialize(serializer)
    }

    pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Arc<T>, D::Error> {
        T::deserialize(deserializer).map(Arc::new)
    }
}
