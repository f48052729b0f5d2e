//! The sign test of paired results.

/// The probability, from 0 to 1, that of `more + fewer` pairs without a tie the counts of both signs differ by at least as
/// much as here, if both signs are equally likely: the exact two-sided sign test (Dixon and Mood, The statistical sign
/// test, Journal of the American Statistical Association 41 (1946)). Ties are left out beforehand.
pub fn sign_test(more: u32, fewer: u32) -> f64 {
    let pairs = more + fewer;
    // The probability of each count follows from that of the count before; in logarithms, because those of thousands of
    // pairs are too small for a number.
    let mut log_chance = -f64::from(pairs) * std::f64::consts::LN_2;
    let mut tail = 0.0;
    for count in 0..=more.min(fewer) {
        tail += libm::exp(log_chance);
        log_chance += libm::log(f64::from(pairs - count) / f64::from(count + 1));
    }
    (2.0 * tail).min(1.0)
}

/// How the first of paired values compares with the second.
#[derive(Debug, Clone, PartialEq)]
pub struct PairedDifference {
    /// Number of pairs whose first value is larger.
    pub more: u32,
    /// Number of pairs whose second value is larger.
    pub fewer: u32,
    /// Number of pairs.
    pub pairs: usize,
    /// Probability of the sign test.
    pub p: f64,
    /// Median difference and its interval, over the pairs in which both values are known.
    pub median: Option<(f64, Option<[f64; 2]>)>,
}

impl PairedDifference {
    /// Compares pairs. An unknown value, that of a failed run, is lower than any other.
    pub fn of(pairs: &[[Option<f64>; 2]]) -> Self {
        let or_lowest = |value: Option<f64>| value.unwrap_or(f64::NEG_INFINITY);
        let count = |first: usize, second: usize| {
            let is_more =
                |pair: &&[Option<f64>; 2]| or_lowest(pair[first]) > or_lowest(pair[second]);
            pairs.iter().filter(is_more).count() as u32
        };
        let (more, fewer) = (count(0, 1), count(1, 0));
        let known = pairs.iter().filter_map(|[a, b]| Some((*a)? - (*b)?));
        Self {
            more,
            fewer,
            pairs: pairs.len(),
            p: sign_test(more, fewer),
            median: median_difference(known.collect()),
        }
    }

    /// The comparison in words: "higher with 8 of 10 seeds (sign test p = 0.109), median difference +0.100 (95 % interval
    /// -0.010 to +0.300)".
    pub fn words(&self) -> String {
        let p = if self.p < 0.001 { "< 0.001".to_owned() } else { format!("= {:.3}", self.p) };
        let median = match self.median {
            None => String::new(),
            Some((median, None)) => {
                format!(", median difference {median:+.3} (no interval below 6 seeds)")
            }
            Some((median, Some([from, to]))) => {
                format!(", median difference {median:+.3} (95 % interval {from:+.3} to {to:+.3})")
            }
        };
        format!("higher with {} of {} seeds (sign test p {p}){median}", self.more, self.pairs)
    }
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

    #[test]
    fn thousands_of_pairs_do_not_vanish() {
        assert_eq!(sign_test(1000, 1000), 1.0);
        assert!(sign_test(2500, 2400) > 0.1, "{}", sign_test(2500, 2400));
        let (median, interval) =
            median_difference((0..4000).map(f64::from).collect()).expect("pairs");
        let [from, to] = interval.expect("many");
        // The interval is 1.96 times the square root of the number wide, half of it to either side.
        assert!((from - (median - 62.0)).abs() < 3.0 && (to - (median + 62.0)).abs() < 3.0);
    }

    #[test]
    fn a_failed_run_is_lower_than_any_other() {
        let found = PairedDifference::of(&[
            [Some(1.0), None],
            [None, Some(-9.0)],
            [None, None],
            [Some(3.0), Some(1.0)],
        ]);
        assert_eq!((found.more, found.fewer, found.pairs), (2, 1, 4));
        assert_eq!(found.median, Some((2.0, None)));
        assert!(found.words().starts_with("higher with 2 of 4 seeds (sign test p = 1.000)"));
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
