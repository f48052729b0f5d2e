//! A setting with one value for all limbs, joints or steps, or one value for each.

use std::fmt;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Values of a setting of the limbs or joints, head first, or of the steps, lowest first. In a file they are a number or a list of numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum PerPart {
    /// One value for all parts.
    All(f32),
    /// One value for each part, in order from the head or from the lowest step.
    Each(Vec<f32>),
}

impl PerPart {
    /// Returns the value of the part with an index from 0. Beyond the end of a list its last value applies; an empty list gives 0.
    pub fn at(&self, index: usize) -> f32 {
        match self {
            Self::All(value) => *value,
            Self::Each(values) => values.get(index).or(values.last()).copied().unwrap_or(0.0),
        }
    }

    /// Returns the setting with `of` applied to each value.
    pub fn map(&self, of: impl Fn(f32) -> f32) -> Self {
        match self {
            Self::All(value) => Self::All(of(*value)),
            Self::Each(values) => Self::Each(values.iter().map(|value| of(*value)).collect()),
        }
    }
}

impl From<f32> for PerPart {
    fn from(value: f32) -> Self {
        Self::All(value)
    }
}

impl Serialize for PerPart {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::All(value) => serializer.serialize_f32(*value),
            Self::Each(values) => values.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for PerPart {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PerPartVisitor)
    }
}

struct PerPartVisitor;

/// Greatest length of a list in a file. A longer list is refused while it is read, before it fills the memory.
const MAX_PARTS: usize = 100;

#[expect(clippy::cast_possible_truncation, reason = "a setting is a 32-bit float")]
impl<'de> Visitor<'de> for PerPartVisitor {
    type Value = PerPart;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a number or a list of numbers")
    }

    fn visit_f64<E>(self, value: f64) -> Result<PerPart, E> {
        Ok(PerPart::All(value as f32))
    }

    fn visit_i64<E>(self, value: i64) -> Result<PerPart, E> {
        Ok(PerPart::All(value as f32))
    }

    fn visit_u64<E>(self, value: u64) -> Result<PerPart, E> {
        Ok(PerPart::All(value as f32))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<PerPart, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = seq.next_element()? {
            if values.len() == MAX_PARTS {
                return Err(serde::de::Error::invalid_length(MAX_PARTS + 1, &self));
            }
            values.push(value);
        }
        Ok(PerPart::Each(values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_or_a_list_is_read_back_with_the_same_bits() {
        for value in [0.1, 1.0e-7, 123_456.79, f32::MAX] {
            for part in [PerPart::All(value), PerPart::Each(vec![value, 2.0, -0.3])] {
                let text = ron::to_string(&part).expect("serialisable");
                assert_eq!(ron::from_str::<PerPart>(&text).expect("parsed"), part, "{text}");
                let json = serde_json::to_value(&part).expect("serialisable");
                assert_eq!(serde_json::from_value::<PerPart>(json).expect("parsed"), part);
            }
        }
        assert_eq!(ron::from_str::<PerPart>("3").expect("parsed"), PerPart::All(3.0));
        assert!(ron::from_str::<PerPart>("\"three\"").is_err());
    }

    #[test]
    fn each_part_has_the_value_of_its_place_or_the_common_one() {
        let list = PerPart::Each(vec![1.0, 2.0, 30.0]);
        assert_eq!((list.at(1), PerPart::All(5.0).at(7)), (2.0, 5.0));
    }
}
