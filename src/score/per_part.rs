//! One number for all limbs or joints, or one for each.

use std::fmt;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ops::RangeInclusive;

use crate::check::{Invalid, within};

/// A setting of the parts of the snake, head first. In a file it is a number, or a list of them.
#[derive(Debug, Clone, PartialEq)]
pub enum PerPart {
    /// The same for all parts.
    All(f32),
    /// One for each part, from the head.
    Each(Vec<f32>),
}

impl PerPart {
    /// The value of part number `index`; the first is 0. Beyond a list's end its last value counts.
    pub fn at(&self, index: usize) -> f32 {
        match self {
            Self::All(value) => *value,
            Self::Each(values) => values.get(index).or(values.last()).copied().unwrap_or(0.0),
        }
    }

    /// Checks that there are as many values as parts, and each against the range.
    pub fn check(
        &self,
        field: &str,
        parts: usize,
        range: RangeInclusive<f32>,
    ) -> Result<(), Invalid> {
        match self {
            Self::All(value) => within(field, *value, range),
            Self::Each(values) if values.len() != parts => {
                let allowed = format!("one value, or a list of {parts}");
                Err(Invalid::new(field, format!("a list of {}", values.len()), allowed))
            }
            Self::Each(values) => values.iter().enumerate().try_for_each(|(index, &value)| {
                within(&format!("{field}[{index}]"), value, range.clone())
            }),
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

/// No list of parts is longer; what is longer is refused before it is held in memory.
const MOST_PARTS: usize = 100;

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
            if values.len() == MOST_PARTS {
                return Err(serde::de::Error::invalid_length(MOST_PARTS + 1, &self));
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
    fn a_number_or_a_list_comes_back_in_every_bit() {
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
    fn a_list_must_have_one_value_for_each_part() {
        let list = PerPart::Each(vec![1.0, 2.0, 30.0]);
        assert_eq!(list.check("x", 3, 0.0..=40.0), Ok(()));
        let error = list.check("x", 4, 0.0..=40.0).unwrap_err().to_string();
        assert_eq!(error, "x is a list of 3; allowed: one value, or a list of 4");
        let error = list.check("x", 3, 0.0..=10.0).unwrap_err().to_string();
        assert_eq!(error, "x[2] is 30; allowed: 0 to 10");
        assert_eq!((list.at(1), PerPart::All(5.0).at(7)), (2.0, 5.0));
    }
}
