//! A shove: a sudden change of a limb's velocity, as if something had hit the limb.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Vector;
use crate::check::{Invalid, within};

/// A sudden change of a limb's velocity. It leaves the limb's angular velocity as it is, and acts on other limbs only through the joints.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shove {
    /// Index of the shoved limb; the head is 0.
    pub limb: usize,
    /// Time of the shove, in s from the start. It acts before the step that begins at this time.
    pub at_s: f32,
    /// Change of the limb's velocity, in m/s, added at once.
    #[serde(serialize_with = "write_vector", deserialize_with = "read_vector")]
    pub change_m_s: Vector,
}

impl Shove {
    /// Checks that every value is in the range that exams draw from.
    ///
    /// # Errors
    /// Returns the first value outside the range that exams draw from.
    pub fn check(&self) -> Result<(), Invalid> {
        within("limb", self.limb, 0..=1000)?;
        within("at_s", self.at_s, 0.0..=1.0e4)?;
        self.change_m_s
            .to_array()
            .into_iter()
            .try_for_each(|change_m_s| within("change_m_s", change_m_s, -1.0e3..=1.0e3))
    }
}

/// Writes a vector as the list of its three coordinates.
fn write_vector<S: Serializer>(vector: &Vector, serializer: S) -> Result<S::Ok, S::Error> {
    vector.to_array().serialize(serializer)
}

fn read_vector<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vector, D::Error> {
    <[f32; 3]>::deserialize(deserializer).map(Vector::from_array)
}
