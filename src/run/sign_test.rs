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

/// The median of paired differences and its interval of at least 95 %, by the order statistics that the sign test does not
/// reject. No interval below six pairs, of which none has that confidence; nothing without pairs.
pub fn median_difference(mut differences: Vec<f64>) -> Option<(f64, Option<[f64; 2]>)> {
    differences.sort_by(f64::total_cmp);
    let pairs = differences.len();
    let middle = pairs.checked_sub(1)? / 2;
    let median = f64::midpoint(differences[middle], differences[pairs / 2]);
    // Leaves out as many at each end as the test rejects.
    let count = u32::try_from(pairs).ok()?;
    let left_out =
        (0..count / 2).take_while(|&fewer| sign_test(count - fewer, fewer) <= 0.05).last();
    let interval = left_out.map(|fewer| fewer as usize);
    Some((median, interval.map(|from| [differences[from], differences[pairs - 1 - from]])))
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
    /// Of ten pairs, the second and the ninth bound the median with a confidence of 1 - 22 / 1,024 (any table of the
    /// binomial distribution).
    #[test]
    fn the_interval_of_the_median_leaves_out_what_the_test_rejects() {
        let ten = (1..=10).rev().map(f64::from).collect();
        assert_eq!(median_difference(ten), Some((5.5, Some([2.0, 9.0]))));
        assert_eq!(median_difference(vec![3.0; 6]), Some((3.0, Some([3.0, 3.0]))));
        assert_eq!(median_difference(vec![1.0, 4.0, 2.0]), Some((2.0, None)));
        assert_eq!(median_difference(Vec::new()), None);
    }
}
