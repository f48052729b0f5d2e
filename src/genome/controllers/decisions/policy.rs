//! What was learned about decisions: a table of values.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::{POSTURES, TABLE_STATES};
use crate::check::Invalid;
use crate::learn::q_table::ActionValues;

/// What was learned about decisions. Clones share it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Policy {
    /// The value of each posture in each situation.
    #[serde(with = "shared")]
    Table(Arc<ActionValues>),
}

impl Default for Policy {
    fn default() -> Self {
        Self::Table(Arc::new(ActionValues::new(TABLE_STATES, POSTURES.len())))
    }
}

impl Policy {
    /// Checks that it decides among the postures, by the situations that there are.
    ///
    /// # Errors
    /// The number that differs.
    pub fn check(&self) -> Result<(), Invalid> {
        match self {
            Self::Table(table) => {
                table.check(TABLE_STATES, POSTURES.len()).map_err(|error| error.inside("policy"))
            }
        }
    }

    /// Adds the bits of everything that was learned to a hash.
    pub(super) fn hash(&self, hash: &mut Xxh3Default) {
        match self {
            Self::Table(table) => {
                for state in 0..table.states() {
                    for value in table.values(state) {
                        hash.update(&value.to_bits().to_le_bytes());
                    }
                    for visits in table.visits(state) {
                        hash.update(&visits.to_le_bytes());
                    }
                }
            }
        }
    }
}

/// Writes shared data as if it were not shared.
mod shared {
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
