//! The condition of a rule: which bits of a situation matter, and which values they must have.
//!
//! As text a condition has one character per bit, bit 0 first: `0`, `1`, or `#` for a bit that does not matter.

use std::fmt::{Display, Formatter};
use std::ops::RangeInclusive;
use std::str::FromStr;

use rand::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::chance::happens;
use crate::check::{Invalid, quoted, within};

/// Allowed numbers of bits of a situation.
pub const LENGTHS: RangeInclusive<usize> = 1..=32;

/// A condition over the bits of a situation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Condition {
    /// Bit mask with ones where a bit of the situation matters.
    care: u32,
    /// Values that the bits in `care` must have. Other bits are zero, so that equal conditions have equal words.
    value: u32,
    /// Number of bits of a situation, 1 to 32.
    length: u8,
}

impl Condition {
    /// Creates the condition that the bits of `care` have the values in `value`, for situations of `length` bits. Bits of `value` outside
    /// `care` are ignored.
    ///
    /// Returns an error if the length is not from 1 to 32, or if `care` has bits beyond the length.
    pub fn new(care: u32, value: u32, length: usize) -> Result<Self, Invalid> {
        within("bits", length, LENGTHS)?;
        within("care", care, 0..=all_bits(length))?;
        Ok(Self { care, value: value & care, length: length as u8 })
    }

    /// Creates the condition that every situation of `length` bits meets.
    pub const fn any(length: u8) -> Self {
        Self { care: 0, value: 0, length }
    }

    /// Returns the symbol at a position: the value that the bit must have, or `None` for `#`.
    pub fn symbol(&self, position: usize) -> Option<bool> {
        let is_set = |bits: u32| bits >> position & 1 == 1;
        is_set(self.care).then_some(is_set(self.value))
    }

    /// Replaces the symbol at a position.
    pub fn set_symbol(&mut self, position: usize, symbol: Option<bool>) {
        let others = !(1 << position);
        self.care = self.care & others | u32::from(symbol.is_some()) << position;
        self.value = self.value & others | u32::from(symbol == Some(true)) << position;
    }

    /// Draws a condition that `bits` meets. Each bit is `#` with probability `wildcard_share`.
    pub(super) fn covering(
        bits: u32,
        length: usize,
        wildcard_share: f32,
        rng: &mut impl Rng,
    ) -> Self {
        let mut care = 0;
        for bit in 0..length {
            care |= u32::from(!happens(wildcard_share, rng)) << bit;
        }
        Self { care, value: bits & care, length: length as u8 }
    }

    /// Returns the mask of the bits that matter.
    pub fn care(&self) -> u32 {
        self.care
    }

    /// Returns the values of the bits that matter; other bits are zero.
    pub fn value(&self) -> u32 {
        self.value
    }

    /// Returns the number of bits of a situation.
    pub fn length(&self) -> usize {
        usize::from(self.length)
    }

    /// Checks that the condition is for situations of `length` bits.
    ///
    /// # Errors
    /// Returns an error if the condition has another length.
    pub fn check_length(&self, length: usize) -> Result<(), Invalid> {
        if self.length() == length {
            return Ok(());
        }
        Err(Invalid::new("condition", self, format!("{length} characters, each 0, 1 or #")))
    }

    /// Returns whether a situation meets the condition.
    pub fn matches(&self, bits: u32) -> bool {
        (bits ^ self.value) & self.care == 0
    }

    /// Returns whether this condition accepts every situation that `other` accepts, and more.
    pub fn is_more_general_than(&self, other: &Self) -> bool {
        let is_weaker = self.care & other.care == self.care && self.care != other.care;
        is_weaker && other.value & self.care == self.value
    }

    /// Counts the `#`.
    pub fn wildcards(&self) -> u32 {
        u32::from(self.length) - self.care.count_ones()
    }

    /// Exchanges with `other` the symbols from position `from` to just before `to`.
    pub(super) fn exchange(&mut self, other: &mut Self, from: usize, to: usize) {
        let segment = below(to) & !below(from);
        let care = (self.care ^ other.care) & segment;
        let value = (self.value ^ other.value) & segment;
        (self.care, other.care) = (self.care ^ care, other.care ^ care);
        (self.value, other.value) = (self.value ^ value, other.value ^ value);
    }

    /// Changes each symbol with probability `share`, such that `bits` still meets the condition: `#` becomes the bit of the situation, and
    /// a bit becomes `#`.
    pub(super) fn mutate_around(&mut self, bits: u32, share: f32, rng: &mut impl Rng) {
        for bit in 0..self.length() {
            self.care ^= u32::from(happens(share, rng)) << bit;
        }
        self.value = bits & self.care;
    }

    /// Changes each symbol with probability `share` to one of the two others.
    pub(super) fn mutate_freely(&mut self, share: f32, rng: &mut impl Rng) {
        for bit in (0..self.length()).map(|position| 1_u32 << position) {
            if !happens(share, rng) {
                continue;
            }
            let is_first = rng.random_range(0..2) == 0;
            let (cares, is_one) = (self.care & bit != 0, self.value & bit != 0);
            // A `#` becomes 0 or 1; a bit becomes `#` or its opposite.
            let (new_care, new_one) = match (cares, is_first) {
                (false, _) => (true, is_first),
                (true, true) => (false, false),
                (true, false) => (true, !is_one),
            };
            self.care = (self.care & !bit) | if new_care { bit } else { 0 };
            self.value = (self.value & !bit) | if new_one { bit } else { 0 };
        }
    }
}

/// Returns a word whose lowest `length` bits are ones.
pub fn all_bits(length: usize) -> u32 {
    below(length)
}

/// Returns a word with ones at the positions below `position`; all ones from 32 on.
fn below(position: usize) -> u32 {
    if position >= 32 { u32::MAX } else { (1 << position) - 1 }
}

impl Display for Condition {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let symbol = |position: usize| match self.symbol(position) {
            None => '#',
            Some(false) => '0',
            Some(true) => '1',
        };
        f.pad(&(0..self.length()).map(symbol).collect::<String>())
    }
}

impl FromStr for Condition {
    type Err = Invalid;

    fn from_str(text: &str) -> Result<Self, Invalid> {
        let refused =
            || Invalid::new("condition", quoted(text), "1 to 32 characters, each 0, 1 or #");
        if !LENGTHS.contains(&text.len()) {
            return Err(refused());
        }
        let (mut care, mut value) = (0, 0);
        for (position, symbol) in text.bytes().enumerate() {
            match symbol {
                b'#' => {}
                b'0' => care |= 1 << position,
                b'1' => (care, value) = (care | 1 << position, value | 1 << position),
                _ => return Err(refused()),
            }
        }
        Ok(Self { care, value, length: text.len() as u8 })
    }
}

impl TryFrom<String> for Condition {
    type Error = Invalid;

    fn try_from(text: String) -> Result<Self, Invalid> {
        text.parse()
    }
}

impl From<Condition> for String {
    fn from(condition: Condition) -> Self {
        condition.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    fn condition(text: &str) -> Condition {
        text.parse().unwrap()
    }

    #[test]
    fn a_condition_looks_only_at_the_bits_it_names() {
        let rule = condition("01#");
        let matched: Vec<u32> = (0..8).filter(|&bits| rule.matches(bits)).collect();
        assert_eq!(matched, [0b010, 0b110]);
        let long = condition(&"1".repeat(32));
        assert!(long.matches(u32::MAX) && !long.matches(u32::MAX - 1));
        assert!(condition(&"#".repeat(32)).matches(0xdead_beef));
    }

    #[test]
    fn text_survives_the_round_trip() {
        for text in [
            "0",
            "1",
            "#",
            "01#10",
            "################################",
            "1#0#1#0#1#0#1#0#1#0#1#0#1#0#1#0#",
        ] {
            assert_eq!(condition(text).to_string(), text);
            let json = serde_json::to_string(&condition(text)).unwrap();
            assert_eq!(json, format!("\"{text}\""));
            assert_eq!(serde_json::from_str::<Condition>(&json).unwrap(), condition(text));
            let ron = ron::to_string(&condition(text)).unwrap();
            assert_eq!(ron::from_str::<Condition>(&ron).unwrap(), condition(text));
        }
    }

    #[test]
    fn text_of_a_wrong_length_or_letter_is_refused() {
        for text in ["", "2", "01x", "0 1", "ä", &"0".repeat(33)] {
            let error = text.parse::<Condition>().unwrap_err().to_string();
            assert!(error.contains("each 0, 1 or #"), "{error}");
            assert!(serde_json::from_str::<Condition>(&format!("{text:?}")).is_err());
        }
        assert!(Condition::new(0b1000, 0, 3).is_err());
        assert!(Condition::new(0, 0, 0).is_err() && Condition::new(0, 0, 33).is_err());
    }

    #[test]
    fn more_general_means_more_wildcards_and_no_contradiction() {
        let general = |a: &str, b: &str| condition(a).is_more_general_than(&condition(b));
        assert!(general("0##", "01#") && general("###", "111"));
        assert!(!general("01#", "0##") && !general("01#", "01#"));
        assert!(!general("0##", "11#") && !general("0##", "#11"));
        assert_eq!(condition("0##").wildcards(), 2);
    }

    #[test]
    fn exchange_swaps_a_segment_of_symbols() {
        let (mut a, mut b) = (condition("000000"), condition("1#1#1#"));
        a.exchange(&mut b, 1, 4);
        assert_eq!((a.to_string().as_str(), b.to_string().as_str()), ("0#1#00", "10001#"));
        let (mut a, mut b) = (condition(&"0".repeat(32)), condition(&"1".repeat(32)));
        a.exchange(&mut b, 31, 32);
        assert_eq!(a.value(), 1 << 31);
        assert_eq!(b.value(), u32::MAX >> 1);
    }

    #[test]
    fn covering_and_mutation_keep_the_situation_matched() {
        let mut rng = stream(2, 0, 0, Purpose::Birth);
        for bits in 0..64 {
            let mut rule = Condition::covering(bits, 6, 0.5, &mut rng);
            assert!(rule.matches(bits));
            rule.mutate_around(bits, 0.5, &mut rng);
            assert!(rule.matches(bits) && rule.value() & !rule.care() == 0);
        }
        assert_eq!(Condition::covering(5, 3, 0.0, &mut rng).to_string(), "101");
        assert_eq!(Condition::covering(5, 3, 1.0, &mut rng).to_string(), "###");
    }

    #[test]
    fn free_mutation_reaches_both_other_symbols() {
        let mut rng = stream(3, 0, 0, Purpose::Birth);
        for start in ["0", "1", "#"] {
            let mut seen = String::new();
            for _ in 0..40 {
                let mut rule = condition(start);
                rule.mutate_freely(1.0, &mut rng);
                assert_eq!(rule.value() & !rule.care(), 0);
                seen += &rule.to_string();
            }
            let others = ["0", "1", "#"].iter().filter(|symbol| seen.contains(**symbol)).count();
            assert!(others == 2 && !seen.contains(start), "{start} became {seen}");
        }
    }
}
