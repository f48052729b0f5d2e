//! A rule that chooses a wave: a condition on what the snake senses, and what the rule does when the condition holds.

use serde::{Deserialize, Serialize};

use super::bit_names::bits_in_words;
use crate::genome::gene::{GeneRange, Genes, Quantity};
use crate::genome::limits::SHARE;
use crate::learn::classifiers::Condition;

/// Words for the bits of conditions, in the order of the symbols: for a bit that is set, and for one that is not. Bit number i has the
/// value 2^i.
pub const RULE_SENSES: [[&str; 2]; 10] = [
    ["head gap under 1 m", "head gap 1 m or more"],
    ["head gap under 0.25 m", "head gap 0.25 m or more"],
    ["step up over 0.05 m", "no step up over 0.05 m"],
    ["step up over 0.6 m", "no step up over 0.6 m"],
    ["head pitched up", "head not pitched up"],
    ["head blocked", "head not blocked"],
    ["middle touches", "middle does not touch"],
    ["tail touches", "tail does not touch"],
    ["middle gap under 1 m", "middle gap 1 m or more"],
    ["moved ahead", "not moved ahead"],
];

/// A rule of a controller that chooses waves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveRule {
    /// Condition under which the rule may decide. For each of [`RULE_SENSES`] it has a symbol: 1 if the bit must be set, 0 if it must not,
    /// and # if it does not matter.
    pub condition: Condition,
    /// Joints for which the rule decides.
    pub group: JointGroup,
    /// Number of the wave that the rule chooses; the first wave of the library is 1.
    pub wave: u32,
    /// Strength of the rule, from 0 to 1. Of the rules whose conditions hold, the strongest decides.
    pub strength: f32,
}

/// The joints for which a rule decides. If their number is odd, the front half has one joint more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointGroup {
    /// The joints nearer to the head.
    Front,
    /// All joints.
    All,
    /// The joints nearer to the tail.
    Rear,
}

/// Range of a gene for a symbol. The values -1, 0 and 1 stand for 0, # and 1. A random symbol is # with a probability of 0.6. Then one in
/// ten random rules holds at a given moment, and one of a dozen holds most of the time. With three equally likely symbols, one in sixty
/// would hold.
const SYMBOLS: GeneRange<'_> = GeneRange::Between(-1.25, 1.25);
/// Least absolute value of a gene for a symbol that is not rounded to #.
const LEAST_CERTAIN: f32 = 0.75;
/// Range of a gene for a group of joints: -1 stands for the front, 0 for all and 1 for the rear.
const GROUPS: GeneRange<'_> = GeneRange::Between(-1.5, 1.5);
/// Quantity of a gene for a symbol or a group.
const SIGN: Quantity = Quantity::pure(-1.5..=1.5);

impl WaveRule {
    /// A rule whose genes are in the middle of their ranges.
    pub(super) const ZEROED: Self = Self {
        condition: Condition::any(RULE_SENSES.len() as u8),
        group: JointGroup::All,
        wave: 1,
        strength: 0.0,
    };

    /// Returns whether the rule may decide for the front or the rear half of the joints while the snake senses these bits.
    pub fn holds(&self, bits: u32, half: JointGroup) -> bool {
        (self.group == JointGroup::All || self.group == half) && self.condition.matches(bits)
    }

    /// Describes the rule's condition in words, such as "head blocked, tail does not touch".
    pub fn words(&self) -> String {
        bits_in_words(&RULE_SENSES, self.condition.care(), self.condition.value(), "always")
    }

    /// Visits the genes. Symbols, groups and waves are numbers that are rounded, so that a small step of a search changes few of them.
    /// `waves` is the size of the library.
    pub(super) fn genes(&mut self, waves: usize, genes: &mut Genes<'_>) {
        for (sense, [name, _]) in RULE_SENSES.iter().enumerate() {
            let mut symbol = number_of(self.condition.symbol(sense));
            let field = format_args!("condition[{sense}]");
            genes.gene(field, format_args!(" if {name}"), SIGN, SYMBOLS, &mut symbol);
            self.condition.set_symbol(sense, symbol_of(symbol));
        }
        let mut group = self.group.number();
        genes.gene("group", ", joints", SIGN, GROUPS, &mut group);
        self.group = JointGroup::nearest(group);
        let (mut wave, most) = (self.wave as f32, waves as f32);
        let range = match waves {
            ..=1 => GeneRange::Fixed(1.0),
            _ => GeneRange::Between(0.5, most + 0.5),
        };
        genes.gene("wave", ", wave", Quantity::pure(1.0..=most.max(1.0)), range, &mut wave);
        self.wave = libm::roundf(wave).clamp(1.0, most.max(1.0)) as u32;
        let range = GeneRange::Between(0.0, 1.0);
        genes.gene("strength", ", strength", SHARE, range, &mut self.strength);
    }
}

/// Returns the value of the gene of a symbol; `None` is #.
fn number_of(symbol: Option<bool>) -> f32 {
    match symbol {
        None => 0.0,
        Some(false) => -1.0,
        Some(true) => 1.0,
    }
}

/// Returns the symbol for a value of its gene; `None` is #.
fn symbol_of(number: f32) -> Option<bool> {
    (number.abs() >= LEAST_CERTAIN).then_some(number > 0.0)
}

impl JointGroup {
    fn number(self) -> f32 {
        match self {
            Self::Front => -1.0,
            Self::All => 0.0,
            Self::Rear => 1.0,
        }
    }

    fn nearest(number: f32) -> Self {
        match number {
            ..-0.5 => Self::Front,
            0.5.. => Self::Rear,
            _ => Self::All,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule(condition: &str) -> WaveRule {
        WaveRule { condition: condition.parse().expect("a condition"), ..WaveRule::ZEROED }
    }

    #[test]
    fn a_rule_decides_for_its_joints_where_its_condition_holds() {
        let of_rear = WaveRule { group: JointGroup::Rear, ..rule("1#0#######") };
        for bits in 0..1 << RULE_SENSES.len() {
            let expected = bits & 0b101 == 0b001;
            assert_eq!(of_rear.holds(bits, JointGroup::Rear), expected, "{bits:010b}");
            assert!(!of_rear.holds(bits, JointGroup::Front));
        }
        assert!(rule("##########").holds(0, JointGroup::Front));
        assert!(rule("#########1").holds(0x200, JointGroup::Rear));
    }

    #[test]
    fn three_in_five_random_symbols_do_not_matter() {
        let mut counts = [0; 3];
        for share in 0..1000 {
            let symbol = symbol_of(SYMBOLS.at((f64::from(share) + 0.5) / 1000.0));
            counts[(number_of(symbol) + 1.0) as usize] += 1;
        }
        assert_eq!(counts, [200, 600, 200]);
    }

    #[test]
    fn a_condition_is_spelled_in_words() {
        for (text, words) in [
            ("##########", "always"),
            ("1####1####", "head gap under 1 m, head blocked"),
            ("#######0#0", "tail does not touch, not moved ahead"),
        ] {
            assert_eq!(rule(text).words(), words);
        }
    }
}
