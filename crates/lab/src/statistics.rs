//! Statistics over runs and trials: quartiles, shares, paired differences and effect sizes, each with an interval.

use std::cmp::Ordering;

/// The 97.5th percentile of the standard normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// Median and quartiles of some values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quartiles {
    /// Lower quartile: a quarter of the values is below.
    pub low: f64,
    /// Median: half of the values is below.
    pub median: f64,
    /// Upper quartile: three quarters of the values are below.
    pub high: f64,
}

impl Quartiles {
    /// Computes the quartiles of some values, interpolating linearly between them (definition 7 of Hyndman and Fan, The American
    /// Statistician 50 (1996)). Returns `None` without values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |share: f64| {
            let place = share * last as f64;
            let (below, part) = (place as usize, place - (place as usize) as f64);
            let (low, high) = (values[below], values[(below + 1).min(last)]);
            // The product of infinity and zero would be not a number.
            if part == 0.0 || low == high { low } else { low + (high - low) * part }
        };
        Some(Self { low: at(0.25), median: at(0.5), high: at(0.75) })
    }
}

/// A share, 0 to 1, and its 95 % confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// The observed share.
    pub seen: f64,
    /// Lower end of the interval.
    pub least: f64,
    /// Upper end of the interval.
    pub most: f64,
}

impl Share {
    /// Returns the share of `count` in `of`, with the score interval of Wilson (Probable inference, the law of succession, and
    /// statistical inference, 1927) at 95 %.
    pub fn of(count: u32, of: u32) -> Self {
        let n = f64::from(of.max(1));
        let seen = f64::from(count) / n;
        let middle = (seen + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (seen * (1.0 - seen) / n + Z * Z / (4.0 * n * n)).sqrt();
        Self { seen, least: (middle - half).max(0.0), most: (middle + half).min(1.0) }
    }
}

/// Returns the probability, from 0 to 1, that the counts of both signs among `more + fewer` pairs differ by at least `|more - fewer|`
/// if both signs are equally likely: the exact two-sided sign test (Dixon and Mood, The statistical sign test, Journal of the
/// American Statistical Association 41 (1946)). Ties must not be counted.
pub fn sign_test(more: u32, fewer: u32) -> f64 {
    let pairs = more + fewer;
    // The probability of each count follows from that of the count before. Logarithms are used because the probabilities of
    // thousands of pairs underflow.
    let mut log_chance = -f64::from(pairs) * std::f64::consts::LN_2;
    let mut tail = 0.0;
    for count in 0..=more.min(fewer) {
        tail += libm::exp(log_chance);
        log_chance += libm::log(f64::from(pairs - count) / f64::from(count + 1));
    }
    (2.0 * tail).min(1.0)
}

/// Comparison of the first with the second values of pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct PairedDifference {
    /// Number of pairs whose first value is larger.
    pub more: u32,
    /// Number of pairs whose second value is larger.
    pub fewer: u32,
    /// Number of pairs, including ties.
    pub pairs: usize,
    /// Probability of the sign test, 0 to 1.
    pub p: f64,
    /// Median difference and, with at least six pairs, its interval. Only pairs with two known values count; `None` if there are
    /// none.
    pub median: Option<(f64, Option<[f64; 2]>)>,
}

impl PairedDifference {
    /// Compares pairs. An unknown value, which stands for a failed run, counts as lower than any known value.
    pub fn of(pairs: &[[Option<f64>; 2]]) -> Self {
        let or_lowest = |value: Option<f64>| value.unwrap_or(f64::NEG_INFINITY);
        let count = |first: usize, second: usize| {
            let is_more =
                |pair: &&[Option<f64>; 2]| or_lowest(pair[first]) > or_lowest(pair[second]);
            pairs.iter().filter(is_more).count() as u32
        };
        let (more, fewer) = (count(0, 1), count(1, 0));
        let known = pairs.iter().filter_map(|[a, b]| Some((*a)? - (*b)?));
        // Two infinite values stand for events that never came, which do not differ.
        let known = known.map(|difference| if difference.is_nan() { 0.0 } else { difference });
        Self {
            more,
            fewer,
            pairs: pairs.len(),
            p: sign_test(more, fewer),
            median: median_difference(known.collect()),
        }
    }
}

/// Returns the median of paired differences, and its interval with a confidence of at least 95 %, between the order statistics that
/// the sign test does not reject. Fewer than six pairs have no interval. Returns `None` without pairs.
pub fn median_difference(mut differences: Vec<f64>) -> Option<(f64, Option<[f64; 2]>)> {
    differences.sort_by(f64::total_cmp);
    let pairs = differences.len();
    let middle = pairs.checked_sub(1)? / 2;
    let median = f64::midpoint(differences[middle], differences[pairs / 2]);
    // The interval leaves out as many values at each end as the sign test rejects.
    let count = u32::try_from(pairs).ok()?;
    let left_out =
        (0..count / 2).take_while(|&fewer| sign_test(count - fewer, fewer) <= 0.05).last();
    let interval = left_out.map(|fewer| fewer as usize);
    Some((median, interval.map(|from| [differences[from], differences[pairs - 1 - from]])))
}

/// Corrects the probabilities of several tests by the method of Holm (A simple sequentially rejective multiple test procedure,
/// Scandinavian Journal of Statistics 6 (1979)), and returns them in the given order. If all tests below 5 % are rejected, the
/// probability of any wrong rejection is at most 5 %.
pub fn holm(probabilities: &[f64]) -> Vec<f64> {
    let count = probabilities.len();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| probabilities[a].total_cmp(&probabilities[b]));
    let (mut corrected, mut greatest) = (vec![1.0; count], 0.0_f64);
    for (rank, index) in order.into_iter().enumerate() {
        greatest = greatest.max(probabilities[index] * (count - rank) as f64).min(1.0);
        corrected[index] = greatest;
    }
    corrected
}

/// Returns the effect size A of Vargha and Delaney (Journal of Educational and Behavioral Statistics 25 (2000)): the probability that
/// a value of one group is greater than a value of another, as a share of all pairs, in which equal values count half. The interval is
/// that of method 5 of Newcombe (Confidence intervals for an effect size measure based on the Mann-Whitney statistic, part 2,
/// Statistics in Medicine 25 (2006)). Returns `None` if a group is empty.
pub fn superiority(values: &[f64], others: &[f64]) -> Option<Share> {
    let pairs =
        values.iter().flat_map(|value| others.iter().map(move |other| value.total_cmp(other)));
    let points = pairs.map(|order| match order {
        Ordering::Greater => 1.0,
        Ordering::Equal => 0.5,
        Ordering::Less => 0.0,
    });
    let (count, other_count) = (values.len() as f64, others.len() as f64);
    let all = count * other_count;
    if all == 0.0 {
        return None;
    }
    let seen = points.sum::<f64>() / all;
    let half = f64::midpoint(count, other_count) - 1.0;
    let deviation = |share: f64| {
        let spread = 1.0 + half * (1.0 - share) / (2.0 - share) + half * share / (1.0 + share);
        (share * (1.0 - share) * spread / all).sqrt()
    };
    // Each end is a probability at which the observed share is just at the edge of the 95 % of the most likely samples.
    let end = |mut inside: f64, mut outside: f64| {
        for _ in 0..60 {
            let middle = f64::midpoint(inside, outside);
            if (seen - middle).abs() <= Z * deviation(middle) {
                inside = middle
            } else {
                outside = middle
            }
        }
        inside
    };
    Some(Share { seen, least: end(seen, 0.0), most: end(seen, 1.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_probabilities_are_those_of_fair_coins() {
        // Ten coins show no tails, at most one, or at most two with probabilities of 1, 11 and 56 in 1,024.
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
        // The interval reaches 0.98 times the square root of the number of pairs to either side.
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
        assert_eq!(found.p, 1.0);
    }

    /// The second and the ninth of ten differences bound the median with a confidence of 1 - 22 / 1,024 (any table of the binomial
    /// distribution).
    #[test]
    fn the_interval_of_the_median_leaves_out_what_the_test_rejects() {
        let ten = (1..=10).rev().map(f64::from).collect();
        assert_eq!(median_difference(ten), Some((5.5, Some([2.0, 9.0]))));
        assert_eq!(median_difference(vec![3.0; 6]), Some((3.0, Some([3.0, 3.0]))));
        assert_eq!(median_difference(vec![1.0, 4.0, 2.0]), Some((2.0, None)));
        assert_eq!(median_difference(Vec::new()), None);
    }

    #[test]
    fn quartiles_are_those_of_definition_7() {
        let quartiles = Quartiles::of([4.0, 1.0, 3.0, 2.0]).expect("four values");
        assert_eq!((quartiles.low, quartiles.median, quartiles.high), (1.75, 2.5, 3.25));
        let with_infinity = Quartiles::of([1.0, 2.0, f64::INFINITY]).expect("three values");
        assert_eq!((with_infinity.low, with_infinity.median), (1.5, 2.0));
        assert_eq!(Quartiles::of([]), None);
    }

    #[test]
    fn the_interval_is_the_score_interval_of_wilson() {
        // Newcombe, Statistics in Medicine 17 (1998), table I: 81 of 263, and 15 of 148.
        for (count, of, least, most) in
            [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611)]
        {
            let share = Share::of(count, of);
            assert!((share.least - least).abs() < 5e-5, "{share:?}");
            assert!((share.most - most).abs() < 5e-5, "{share:?}");
        }
    }

    #[test]
    fn the_method_of_holm_multiplies_the_least_by_their_number() {
        // The example of Holm's method in R's documentation of p.adjust.
        let corrected = holm(&[0.01, 0.02, 0.03, 0.04, 0.05]);
        for (found, expected) in corrected.iter().zip([0.05, 0.08, 0.09, 0.09, 0.09]) {
            assert!((found - expected).abs() < 1e-12, "{corrected:?}");
        }
        assert_eq!(holm(&[0.9, 0.4]), [0.9, 0.8]);
        assert_eq!(holm(&[]), [0.0; 0]);
    }

    #[test]
    fn superiority_is_the_share_of_pairs_and_its_interval_holds_it() {
        let of = |values: &[f64], others: &[f64]| superiority(values, others).expect("values");
        let found = of(&[1.0, 2.0, 3.0], &[2.0, 0.0]);
        assert!((found.seen - 4.5 / 6.0).abs() < 1e-12, "{found:?}");
        assert!(found.least < found.seen && found.seen < found.most, "{found:?}");
        let apart = of(&[5.0; 10], &[1.0; 10]);
        assert_eq!((apart.seen, apart.most), (1.0, 1.0));
        // All 100 pairs agree, and so the lower end solves (1 - A)^2 = z^2 V(A).
        let (a, z) = (apart.least, 1.959_963_984_540_054_f64);
        let v = a * (1.0 - a) * (1.0 + 9.0 * (1.0 - a) / (2.0 - a) + 9.0 * a / (1.0 + a)) / 100.0;
        assert!(((1.0 - a) * (1.0 - a) - z * z * v).abs() < 1e-9, "{apart:?}");
        let (one, other) = (of(&[1.0, 4.0], &[2.0, 3.0, 9.0]), of(&[2.0, 3.0, 9.0], &[1.0, 4.0]));
        assert!((one.least - (1.0 - other.most)).abs() < 1e-9, "{one:?} {other:?}");
        assert_eq!(superiority(&[], &[1.0]), None);
    }
}
