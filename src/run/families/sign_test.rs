//! The sign test of paired results.

/// The probability, from 0 to 1, that of `more + fewer` pairs without a tie the counts of both signs differ by at least as
/// much as here, if both signs are equally likely: the exact two-sided sign test (Dixon and Mood, The statistical sign
/// test, Journal of the American Statistical Association 41 (1946)). Ties are left out beforehand.
pub fn sign_test(more: u32, fewer: u32) -> f64 {
    let pairs = more + fewer;
    // The probability of each count follows from that of the count before.
    let mut chance = (0..pairs).fold(1.0_f64, |chance, _| chance / 2.0);
    let mut tail = 0.0;
    for count in 0..=more.min(fewer) {
        tail += chance;
        chance *= f64::from(pairs - count) / f64::from(count + 1);
    }
    (2.0 * tail).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_probabilities_are_those_of_fair_coins() {
        // Of ten coins none shows tails, or at most one, or two, with probabilities of 1, 11 and 56 in 1,024.
        for (more, fewer, expected) in [
            (10, 0, 2.0 / 1024.0),
            (0, 10, 2.0 / 1024.0),
            (9, 1, 22.0 / 1024.0),
            (8, 2, 112.0 / 1024.0),
            (6, 0, 2.0 / 64.0),
            (5, 5, 1.0),
            (1, 0, 1.0),
            (0, 0, 1.0),
        ] {
            let p = sign_test(more, fewer);
            assert!((p - expected).abs() < 1e-12, "{more} and {fewer}: {p}");
        }
    }
}
