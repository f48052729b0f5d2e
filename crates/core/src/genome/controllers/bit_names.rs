//! Bits by which conditions distinguish situations: their number, and their names.

/// For each bit, in the order of their numbers, the words for a bit that is set and for one that is not.
pub type BitNames = [[&'static str; 2]];

/// Returns the number that these bits make. The first bit is the least significant.
pub fn bits_of(bits: &[bool]) -> u32 {
    bits.iter().enumerate().map(|(index, bit)| u32::from(*bit) << index).sum()
}

/// Describes the bits that are set in `care`, with their values, in words: "riser at the middle, not moving". Returns `nothing` if `care`
/// has no bits.
pub fn bits_in_words(names: &BitNames, care: u32, value: u32, nothing: &str) -> String {
    let cared = names.iter().enumerate().filter(|(bit, _)| care >> bit & 1 == 1);
    let word = |(bit, [set, clear]): (usize, &[&'static str; 2])| {
        if value >> bit & 1 == 1 { *set } else { *clear }
    };
    let words: Vec<&str> = cared.map(word).collect();
    if words.is_empty() { nothing.to_owned() } else { words.join(", ") }
}
