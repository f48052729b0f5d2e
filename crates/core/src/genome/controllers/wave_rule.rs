//! A rule that chooses a wave: a condition on what the snake senses, and what to do where it holds.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, quoted};
use crate::genome::gene::{GeneRange, Genes, Quantity};
use crate::genome::limits::SHARE;

/// The statements of the bits that conditions look at, in the order of the symbols. Bit number i has the value 2^i.
pub const RULE_SENSES: [&str; 10] = [
    "head gap under 1 m",
    "head gap under 0.25 m",
    "step up over 0.05 m",
    "step up over 0.6 m",
    "head pitched up",
    "head blocked",
    "middle touches",
    "tail touches",
    "middle gap under 1 m",
    "moved ahead",
];

/// The opposite of each statement, for a bit that must be 0.
const OPPOSITES: [&str; RULE_SENSES.len()] = [
    "head gap 1 m or more",
    "head gap 0.25 m or more",
    "no step up over 0.05 m",
    "no step up over 0.6 m",
    "head not pitched up",
    "head not blocked",
    "middle does not touch",
    "tail does not touch",
    "middle gap 1 m or more",
    "not moved ahead",
];

/// A rule of a controller that chooses waves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveRule {
    /// When it may decide.
    pub condition: RuleCondition,
    /// The joints for which it decides.
    pub group: JointGroup,
    /// The wave that it chooses; the first of the library is 1.
    pub wave: u32,
    /// Of the rules whose conditions hold the strongest decides, from 0 to 1.
    pub strength: f32,
}

/// The joints for which a rule decides. The front half has one joint more where their number is odd.
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

/// A condition: for each of [`RULE_SENSES`] a symbol, 1 if it must hold, 0 if it must not, and # if it does not matter.
/// Files have it as a text such as `1#0#######`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct RuleCondition {
    /// The bits that matter.
    mask: u16,
    /// The values that these bits must have; 0 elsewhere.
    bits: u16,
}

/// The range of a gene for a symbol, whose values are -1 for 0, 0 for # and 1 for 1. A random one is # with a probability
/// of 0.6, so that one in ten random rules holds at a moment, and one of a dozen most of the time. With three symbols
/// equally likely it would be one in sixty.
const SYMBOLS: GeneRange<'_> = GeneRange::Between(-1.25, 1.25);
/// From this size on, the value of such a gene is rounded away from #.
const LEAST_CERTAIN: f32 = 0.75;
/// The range of a gene for a group: -1 for the front, 0 for all and 1 for the rear.
const GROUPS: GeneRange<'_> = GeneRange::Between(-1.5, 1.5);
/// A symbol or a group, as a number.
const SIGN: Quantity = Quantity::pure(-1.5..=1.5);

impl WaveRule {
    /// A rule whose genes are in the middle of their ranges.
    pub(super) const ZEROED: Self = Self {
        condition: RuleCondition { mask: 0, bits: 0 },
        group: JointGroup::All,
        wave: 1,
        strength: 0.0,
    };

    /// Whether it may decide for the front or the rear half of the joints while the snake senses these bits.
    pub fn holds(&self, bits: u16, half: JointGroup) -> bool {
        (self.group == JointGroup::All || self.group == half) && self.condition.holds(bits)
    }

    /// Visits the genes. Symbols, groups and waves are numbers that are rounded, so that a small step of a search leaves
    /// most of them as they are; `waves` is the size of the library.
    pub(super) fn genes(&mut self, waves: usize, genes: &mut Genes<'_>) {
        for (sense, name) in RULE_SENSES.iter().enumerate() {
            let mut symbol = self.condition.number(sense);
            let field = format_args!("condition[{sense}]");
            genes.gene(field, format_args!(" if {name}"), SIGN, SYMBOLS, &mut symbol);
            self.condition.set_number(sense, symbol);
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

impl RuleCondition {
    /// Whether it holds where the snake senses these bits.
    pub fn holds(self, bits: u16) -> bool {
        (bits ^ self.bits) & self.mask == 0
    }

    /// The condition in words: "head blocked, tail does not touch".
    pub fn words(self) -> String {
        let senses = RULE_SENSES.iter().zip(OPPOSITES).enumerate();
        let words = senses.filter_map(|(sense, (holds, opposite))| match self.number(sense) {
            0.0 => None,
            number if number > 0.0 => Some(*holds),
            _ => Some(opposite),
        });
        let words: Vec<&str> = words.collect();
        if words.is_empty() { "always".to_owned() } else { words.join(", ") }
    }

    /// The value of the gene of a symbol.
    fn number(self, sense: usize) -> f32 {
        match (self.mask >> sense & 1, self.bits >> sense & 1) {
            (0, _) => 0.0,
            (_, 0) => -1.0,
            _ => 1.0,
        }
    }

    fn set_number(&mut self, sense: usize, number: f32) {
        let bit = 1 << sense;
        (self.mask, self.bits) = (self.mask & !bit, self.bits & !bit);
        if number.abs() >= LEAST_CERTAIN {
            self.mask |= bit;
            self.bits |= if number > 0.0 { bit } else { 0 };
        }
    }
}

impl From<RuleCondition> for String {
    fn from(condition: RuleCondition) -> Self {
        let symbol = |sense| match condition.number(sense) {
            0.0 => '#',
            number if number > 0.0 => '1',
            _ => '0',
        };
        (0..RULE_SENSES.len()).map(symbol).collect()
    }
}

impl TryFrom<String> for RuleCondition {
    type Error = Invalid;

    fn try_from(text: String) -> Result<Self, Invalid> {
        let refused = || {
            let allowed = format!("{} symbols, each 0, 1 or #", RULE_SENSES.len());
            Invalid::new("condition", quoted(&text), allowed)
        };
        if text.len() != RULE_SENSES.len() {
            return Err(refused());
        }
        let mut condition = Self::default();
        for (sense, symbol) in text.chars().enumerate() {
            let number = match symbol {
                '0' => -1.0,
                '#' => 0.0,
                '1' => 1.0,
                _ => return Err(refused()),
            };
            condition.set_number(sense, number);
        }
        Ok(condition)
    }
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

    fn condition(text: &str) -> RuleCondition {
        text.to_owned().try_into().expect("a condition")
    }

    #[test]
    fn a_condition_holds_exactly_where_its_symbols_agree_with_the_bits() {
        let of = condition("1#0#######");
        for bits in 0..1 << RULE_SENSES.len() {
            assert_eq!(of.holds(bits), bits & 0b101 == 0b001, "{bits:010b}");
        }
        assert!(condition("##########").holds(0) && condition("#########1").holds(0x200));
        let rule = WaveRule { condition: of, group: JointGroup::Rear, ..WaveRule::ZEROED };
        assert!(rule.holds(1, JointGroup::Rear) && !rule.holds(1, JointGroup::Front));
        let of_all = WaveRule { group: JointGroup::All, ..rule };
        assert!(of_all.holds(1, JointGroup::Front) && !of_all.holds(0, JointGroup::Front));
    }

    #[test]
    fn a_condition_is_a_readable_text_in_files_and_a_hostile_one_is_refused() {
        for text in ["1#0#######", "##########", "0101010101"] {
            let written = ron::to_string(&condition(text)).expect("written");
            assert_eq!(written, format!("{text:?}"));
            assert_eq!(ron::from_str::<RuleCondition>(&written).expect("read"), condition(text));
        }
        for text in ["", "1#0######", "1#0########", "1#0######2", "1#0######é", "1#0#####é"] {
            let error = RuleCondition::try_from(text.to_owned()).expect_err(text).to_string();
            let allowed = "allowed: 10 symbols, each 0, 1 or #";
            assert_eq!(error, format!("condition is {text:?}; {allowed}"));
            let error = ron::from_str::<RuleCondition>(&format!("{text:?}")).expect_err(text);
            assert!(error.to_string().contains(allowed), "{error}");
        }
    }

    #[test]
    fn three_in_five_random_symbols_do_not_matter() {
        let mut counts = [0; 3];
        for share in 0..1000 {
            let mut condition = RuleCondition::default();
            condition.set_number(4, SYMBOLS.at((f64::from(share) + 0.5) / 1000.0));
            counts[(condition.number(4) + 1.0) as usize] += 1;
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
            let condition = RuleCondition::try_from(text.to_owned()).expect("a condition");
            assert_eq!(condition.words(), words);
        }
    }
}
