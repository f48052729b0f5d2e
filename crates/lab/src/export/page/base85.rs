//! Bytes as text of 85 letters: five letters for four bytes, a sixteenth shorter than base64. `bytesOf` in `web/page/motion.js` reads it.
//!
//! The method is that of Ascii85 (PostScript Language Reference, section 3.13.3) without its short form of zeros. The letters are
//! the visible ones of ASCII without those that HTML, JSON or the page's template could take for something else.

/// Letters that the text never contains.
const NOT_USED: &[u8] = b"\"'<>&\\`{}";

/// Returns the letters of the digits 0 to 84.
fn letters() -> Vec<char> {
    (b'!'..=b'~').filter(|letter| !NOT_USED.contains(letter)).map(char::from).collect()
}

/// Returns `bytes` as text. A last group of fewer than four bytes has one letter more than bytes.
pub(super) fn encoded(bytes: &[u8]) -> String {
    let letters = letters();
    let mut text = String::with_capacity(bytes.len() / 4 * 5 + 5);
    for group in bytes.chunks(4) {
        let mut four = [0; 4];
        four[..group.len()].copy_from_slice(group);
        let number = u32::from_be_bytes(four);
        let digit = |power| letters[(number / 85_u32.pow(power) % 85) as usize];
        text.extend((0..5).rev().map(digit).take(group.len() + 1));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_85_letters_that_mean_nothing_else() {
        let letters = letters();
        assert_eq!(letters.len(), 85);
        assert_eq!((letters[0], letters[84]), ('!', '~'));
        assert!(!letters.iter().any(|letter| "\"'<>&\\`{}".contains(*letter)));
    }

    #[test]
    fn each_four_bytes_are_five_letters_and_the_rest_has_one_more_than_bytes() {
        assert_eq!(encoded(&[]), "");
        assert_eq!(encoded(&[0]), "!!");
        assert_eq!(encoded(&[0, 0, 0, 1]), "!!!!#");
        assert_eq!(encoded(&[0, 0, 0, 85]), "!!!#!");
        let lengths: Vec<usize> = (0..6).map(|length| encoded(&vec![255; length]).len()).collect();
        assert_eq!(lengths, [0, 2, 3, 4, 5, 7]);
    }
}
