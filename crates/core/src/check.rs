//! Validation of input: one error type for every value that comes from outside.
//!
//! Input (a flag, a preset, a save, a field of a panel) is checked where it enters. The error message always has three parts: the field,
//! its value, and the allowed range.

use std::borrow::Cow;
use std::fmt::Display;
use std::ops::RangeInclusive;

/// An error: a value from outside the program that is not allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{field} is {value}; allowed: {allowed}")]
pub struct Invalid {
    /// Dotted name of the field, as presets and saves spell it.
    pub field: String,
    /// Text of the value that was given.
    pub value: String,
    /// Description of the allowed values.
    pub allowed: String,
}

impl Invalid {
    /// Makes an error about a field with its value and a description of the allowed values.
    pub fn new(field: impl Into<String>, value: impl Display, allowed: impl Into<String>) -> Self {
        Self {
            field: field.into(),
            value: without_zeros(value.to_string()),
            allowed: allowed.into(),
        }
    }

    /// Returns this error with `parent` and a dot in front of its field's name.
    pub fn inside(mut self, parent: &str) -> Self {
        self.field = format!("{parent}.{}", self.field);
        self
    }
}

impl From<Invalid> for String {
    fn from(error: Invalid) -> Self {
        error.to_string()
    }
}

/// Digits of the longest whole number, 2⁶⁴ - 1.
const MOST_DIGITS: usize = 20;

/// Returns the text of a number with a power of ten if the text is longer than any whole number: `1e300` instead of 300 zeros. Texts whose
/// digits would not all be kept, such as 2⁷⁰ in full, stay as they are.
fn without_zeros(text: String) -> String {
    let number = if text.len() > MOST_DIGITS { text.parse::<f64>().ok() } else { None };
    let same = |number: &f64| number.to_string() == text;
    number.filter(same).map_or_else(|| text.clone(), |number| format!("{number:e}"))
}

/// Accepts `value` if it lies in `range`, ends included. NaN lies in no range.
pub fn within<T: PartialOrd + Display>(
    field: &str,
    value: T,
    range: RangeInclusive<T>,
) -> Result<(), Invalid> {
    if range.contains(&value) {
        Ok(())
    } else {
        Err(Invalid::new(field, value, format!("{} to {}", range.start(), range.end())))
    }
}

/// Accepts a name that may become part of a file name. The allowed characters exclude paths to other folders and hidden files.
pub fn name(field: &str, value: &str) -> Result<(), Invalid> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if (1..=40).contains(&value.len()) && value.chars().all(plain) {
        return Ok(());
    }
    Err(Invalid::new(field, quoted(value), "1 to 40 characters, each a-z, 0-9 or -"))
}

/// Refuses a file's name that Windows reserves for a device, with any extension and in any case. It is refused on every system, because
/// files are shared between systems. [Naming Files](https://learn.microsoft.com/windows/win32/fileio/naming-a-file) lists the names.
pub fn no_device(field: &str, value: &str) -> Result<(), Invalid> {
    let stem = value.split('.').next().unwrap_or_default().trim_end().to_ascii_lowercase();
    let number = stem.strip_prefix("com").or_else(|| stem.strip_prefix("lpt"));
    let numbers = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "¹", "²", "³"];
    let is_device = ["con", "prn", "aux", "nul"].contains(&stem.as_str())
        || number.is_some_and(|number| numbers.contains(&number));
    if is_device {
        return Err(Invalid::new(
            field,
            quoted(value),
            "a name that Windows does not keep for a device",
        ));
    }
    Ok(())
}

/// Reads a hash of 64 bits from its 16 hexadecimal digits.
///
/// # Errors
/// Fails if `text` is not 16 hexadecimal digits; the error names the value `field`.
pub fn hash_of(field: &str, text: &str) -> Result<u64, Invalid> {
    let digits = text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let hash = u64::from_str_radix(text, 16).ok().filter(|_| digits);
    hash.ok_or_else(|| Invalid::new(field, quoted(text), "16 hexadecimal digits"))
}

/// Writes a hash of 64 bits to files as 16 hexadecimal digits, and reads it back. For `#[serde(with = "hex_hash")]`.
pub mod hex_hash {
    use serde::{Deserialize, Deserializer, Serializer, de};

    use crate::check::hash_of;

    #[expect(missing_docs, reason = "serde asks for it")]
    pub fn serialize<S: Serializer>(hash: &u64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{hash:016x}"))
    }

    #[expect(missing_docs, reason = "serde asks for it")]
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
        hash_of("hash", &String::deserialize(deserializer)?).map_err(de::Error::custom)
    }
}

/// Returns a text from outside, such as the name of a file, as one line that a terminal only shows. A line break becomes a space. Other
/// control characters, which would move the cursor or change colours, characters that turn the direction of writing, which would hide the
/// end of a name, and Unicode's separators of lines and paragraphs become escapes such as `\u001b`. JSON reads such an escape as the character.
pub fn printable(text: &str) -> Cow<'_, str> {
    let directs = |c: char| matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let acts = |c: char| c != '\t' && (c.is_control() || directs(c));
    if !text.contains(acts) {
        return Cow::Borrowed(text);
    }
    let shown = |c: char| match c {
        '\n' | '\r' => " ".to_owned(),
        c if acts(c) => format!("\\u{:04x}", u32::from(c)),
        c => c.to_string(),
    };
    Cow::Owned(text.chars().map(shown).collect())
}

/// Returns a text as a cell of CSV that no spreadsheet computes: a text that begins as a formula does gets an apostrophe in front. Numbers
/// stay as they are.
pub fn no_formula(text: &str) -> Cow<'_, str> {
    if text.starts_with(['=', '+', '-', '@', '\t']) && text.parse::<f64>().is_err() {
        Cow::Owned(format!("'{text}"))
    } else {
        Cow::Borrowed(text)
    }
}

/// Quotes a text from outside for an error message: at most 60 characters, with control characters escaped.
pub fn quoted(text: &str) -> String {
    format!("{:?}", text.chars().take(60).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f9_characters_that_act_on_a_terminal_become_escapes_that_json_reads_back() {
        for plain in ["climber", "Schlange ü", "蛇\tثعبان", "a|b \\ c"] {
            assert!(matches!(printable(plain), Cow::Borrowed(same) if same == plain), "{plain}");
        }
        assert_eq!(printable("\u{1b}[31mred\u{7f}"), "\\u001b[31mred\\u007f");
        assert_eq!(printable("a\nb\rc"), "a b c");
        assert_eq!(printable("a\u{2028}b\u{2029}c"), "a\\u2028b\\u2029c");
        assert_eq!(printable("nor.\u{202e}gpj\u{2066}"), "nor.\\u202egpj\\u2066");
        // In a line of JSON only these are left as they are.
        let name = "a\u{9b}2J\u{7f}\u{202e}b";
        let line = serde_json::to_string(name).expect("a text");
        assert!(line.contains('\u{9b}'), "{line}");
        let read: String = serde_json::from_str(&printable(&line)).expect("JSON");
        assert_eq!(read, name);
    }

    #[test]
    fn f13_a_name_that_a_spreadsheet_would_compute_gets_an_apostrophe_and_a_number_none() {
        for formula in ["=1+1", "+A1", "-x", "@SUM(A1)", "=cmd|' /C calc'!A0", "-"] {
            assert_eq!(no_formula(formula), format!("'{formula}"));
        }
        for plain in ["climber", "-3.25", "+1e-3", "1=1", "NA", "", "-inf", "generation 2"] {
            assert_eq!(no_formula(plain), plain);
        }
    }

    #[test]
    fn names_of_devices_are_refused_in_any_case_and_with_any_extension() {
        for device in ["con", "PRN", "Aux.best", "nul .x", "com1", "COM¹", "lpt³.ron", "Lpt9"] {
            assert!(no_device("name", device).is_err(), "{device}");
        }
        for name in ["conic", "com", "com0", "com10", "lpt12", "a.con", "null", ""] {
            assert_eq!(no_device("name", name), Ok(()), "{name}");
        }
    }

    #[test]
    fn a_message_has_the_field_the_value_and_the_range() {
        let error = within("duration_s", -1.0, 0.1..=600.0).unwrap_err().inside("trial");
        assert_eq!(error.to_string(), "trial.duration_s is -1; allowed: 0.1 to 600");
    }

    #[test]
    fn s8_a_number_with_hundreds_of_zeros_is_told_as_a_power_of_ten() {
        let told = |value: f64| within("x", value, 0.0..=1.0).unwrap_err().value;
        assert_eq!(told(-1e300), "-1e300");
        assert_eq!(told(-2.5e-30), "-2.5e-30");
        assert_eq!(within("x", 1.0e30_f32, 0.0..=1.0).unwrap_err().value, "1e30");
        assert_eq!(told(-1234.5), "-1234.5");
        assert_eq!(told(f64::NEG_INFINITY), "-inf");
        assert_eq!(within("x", u64::MAX, 0..=1).unwrap_err().value, u64::MAX.to_string());
        let in_full = "1180591620717411303424";
        assert_eq!(Invalid::new("threads", in_full, "1 to 1024").value, in_full);
        let text = "\"100000000000000000000000\"";
        assert_eq!(Invalid::new("x", text, "a name").value, text);
    }

    #[test]
    fn a_name_cannot_leave_its_folder() {
        for good in ["report", "my-preset-2", "a"] {
            assert_eq!(name("name", good), Ok(()));
        }
        for bad in ["", ".", "..", "a/b", "a\\b", "C:x", "con\0", "A", "ä", &"x".repeat(41)] {
            assert!(name("name", bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn nan_is_in_no_range() {
        assert!(within("x", f32::NAN, f32::MIN..=f32::MAX).is_err());
        assert!(within("x", f32::INFINITY, f32::MIN..=f32::MAX).is_err());
    }
}
