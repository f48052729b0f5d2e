//! Numbers as text.

/// Formats a number with this many decimals. A number that rounds to zero has no minus sign: "0.00" instead of "-0.00".
pub(crate) fn decimals(value: impl Into<f64>, count: usize) -> String {
    let text = format!("{:.count$}", value.into());
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// Formats a share, where 1 is the whole, as whole percents.
pub(crate) fn in_percent(share: f32) -> String {
    format!("{:.0} %", share * 100.0)
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
