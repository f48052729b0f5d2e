//! The Boolean multiplexer: k address bits select one of 2ᵏ data bits, and the right action is the selected bit.
//!
//! The multiplexer has been the standard test of classifier systems since Wilson (1987): no single bit determines the answer, and the
//! smallest complete set of accurate rules has 4 · 2ᵏ members, each with k + 1 bits that matter.

use rand::Rng;
use rand::RngExt;

use crate::learn::classifiers::Condition;

/// A multiplexer of 6, 11 or 20 bits.
#[derive(Debug, Clone, Copy)]
pub struct Multiplexer {
    address_bits: usize,
}

impl Multiplexer {
    /// Creates the multiplexer with this number of address bits.
    pub fn new(address_bits: usize) -> Self {
        Self { address_bits }
    }

    /// Returns the number of address and data bits together.
    pub fn bits(self) -> usize {
        self.address_bits + (1 << self.address_bits)
    }

    /// Draws a random situation.
    pub fn draw(self, rng: &mut impl Rng) -> u32 {
        rng.random_range(0..1 << self.bits())
    }

    /// Returns the right action. The address comes first, with its most significant bit at position 0.
    pub fn answer(self, bits: u32) -> usize {
        let address =
            (0..self.address_bits).fold(0, |address, i| address << 1 | (bits >> i & 1) as usize);
        (bits >> (self.address_bits + address) & 1) as usize
    }

    /// Returns the reward of an action: 1000 for the right one, 0 for the wrong one.
    pub fn reward(self, bits: u32, action: usize) -> f32 {
        if action == self.answer(bits) { 1000.0 } else { 0.0 }
    }

    /// Returns whether a condition belongs to the smallest complete set: it has all address bits and the data bit that they select.
    pub fn is_optimal(self, condition: &Condition) -> bool {
        let address = (1_u32 << self.address_bits) - 1;
        let data = condition.care() & !address;
        let selected = (0..self.address_bits)
            .fold(0, |number, i| number << 1 | (condition.value() >> i & 1) as usize);
        condition.care() & address == address && data == 1 << (self.address_bits + selected)
    }
}

#[test]
fn the_address_selects_the_data_bit() {
    let six = Multiplexer::new(2);
    let answer = |text: &str| six.answer(text.parse::<Condition>().unwrap().value());
    assert_eq!((six.bits(), Multiplexer::new(3).bits(), Multiplexer::new(4).bits()), (6, 11, 20));
    assert_eq!(
        [answer("000111"), answer("001000"), answer("010100"), answer("100010")],
        [0, 1, 1, 1]
    );
    assert_eq!([answer("110001"), answer("111110")], [1, 0]);
    assert!(
        six.is_optimal(&"10##1#".parse().unwrap()) && six.is_optimal(&"000###".parse().unwrap())
    );
    assert!(
        !six.is_optimal(&"1###1#".parse().unwrap()) && !six.is_optimal(&"00#1##".parse().unwrap())
    );
}
