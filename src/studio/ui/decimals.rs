//! Numbers as text with a fixed count of decimals.

/// The number with this many decimals. One that rounds to zero has no minus: "0.00" instead of "-0.00".
pub(crate) fn decimals(value: f32, count: usize) -> String {
    let text = format!("{value:.count$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_has_no_minus() {
        for (value, count, text) in [
            (-0.004, 2, "0.00"),
            (-0.0, 1, "0.0"),
            (-0.4, 0, "0"),
            (-0.006, 2, "-0.01"),
            (-10.0, 1, "-10.0"),
            (0.25, 2, "0.25"),
        ] {
            assert_eq!(decimals(value, count), text);
        }
    }
}
