//! Numbers of offspring: how many members of the next generation each species produces.

/// Divides `total` into whole numbers in proportion to `shares`, by the method of the largest remainder. Of equal remainders the first
/// gets more. Shares that are negative or not finite count as 0. If all shares are 0, the numbers are equal.
pub fn offspring_numbers(shares: &[f64], total: usize) -> Vec<usize> {
    let clean = |share: &f64| if share.is_finite() { share.max(0.0) } else { 0.0 };
    let mut shares: Vec<f64> = shares.iter().map(clean).collect();
    // The shares are first divided by the largest, because the sum of finite numbers may be infinite.
    let largest = shares.iter().fold(0.0, |largest: f64, &share| largest.max(share));
    shares.iter_mut().for_each(|share| *share = if largest > 0.0 { *share / largest } else { 1.0 });
    let sum = shares.iter().fold(0.0, |sum, share| sum + share);
    let exact: Vec<f64> = shares.iter().map(|share| share / sum * total as f64).collect();
    let mut numbers: Vec<usize> = exact.iter().map(|part| part.floor() as usize).collect();
    let mut order: Vec<usize> = (0..exact.len()).collect();
    let remainder = |i: &usize| exact.get(*i).map_or(0.0, |part| part - part.floor());
    order.sort_by(|a, b| remainder(b).total_cmp(&remainder(a)).then(a.cmp(b)));
    let given = numbers.iter().sum::<usize>();
    for &i in order.iter().cycle().take(total.saturating_sub(given)) {
        if let Some(number) = numbers.get_mut(i) {
            *number += 1;
        }
    }
    numbers
}

/// Scales fitness values to numbers from 0 to 1 that can be shared: subtracts the smallest if it is negative, and divides by the largest.
/// Values that are not finite count as the smallest.
pub fn sharable(fitness: &[f64]) -> Vec<f64> {
    let finite = comparable(fitness);
    let smallest = finite.iter().fold(0.0, |smallest: f64, &x| smallest.min(x));
    let largest = finite.iter().fold(0.0, |largest: f64, &x| largest.max(x - smallest));
    let scaled = |x: &f64| if largest > 0.0 { (x - smallest) / largest } else { 0.0 };
    finite.iter().map(scaled).collect()
}

/// Makes fitness values comparable. Values that are not finite become the smallest of the others, or 0. All are limited to ±1e300, so that
/// neither a difference nor a sum is infinite.
pub fn comparable(fitness: &[f64]) -> Vec<f64> {
    let finite = fitness.iter().copied().filter(|x| x.is_finite());
    let smallest = finite.min_by(f64::total_cmp).unwrap_or(0.0);
    let comparable = |&x: &f64| if x.is_finite() { x } else { smallest };
    fitness.iter().map(comparable).map(|x| x.clamp(-1e300, 1e300)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offspring_numbers_are_those_of_the_largest_remainder() {
        for (shares, total, expected) in [
            (vec![1.0, 1.0, 1.0], 10, vec![4, 3, 3]),
            (vec![0.47, 0.16, 0.158, 0.12, 0.061, 0.031], 100, vec![47, 16, 16, 12, 6, 3]),
            (vec![0.0, 0.0], 5, vec![3, 2]),
            (vec![f64::NAN, 1.0, -3.0], 5, vec![0, 5, 0]),
            (vec![f64::MAX, f64::MAX], 4, vec![2, 2]),
            (vec![], 4, vec![]),
        ] {
            assert_eq!(offspring_numbers(&shares, total), expected, "{shares:?}");
        }
    }

    #[test]
    fn offspring_numbers_add_up() {
        for species in 1..40_u32 {
            let shares: Vec<f64> = (0..species).map(|i| 1.0 / f64::from(i * i % 17 + 1)).collect();
            for total in [1, 2, 7, 150, 1000] {
                assert_eq!(offspring_numbers(&shares, total).iter().sum::<usize>(), total);
            }
        }
    }

    #[test]
    fn fitness_is_shifted_only_if_some_is_negative() {
        assert_eq!(sharable(&[1.0, 4.0, 2.0]), [0.25, 1.0, 0.5]);
        assert_eq!(sharable(&[-1.0, 3.0, f64::NAN]), [0.0, 1.0, 0.0]);
        assert_eq!(sharable(&[f64::MAX, f64::MIN]), [1.0, 0.0]);
        assert_eq!(sharable(&[0.0, f64::INFINITY]), [0.0, 0.0]);
        assert_eq!(comparable(&[f64::MAX, f64::NAN, -1.0]), [1e300, -1.0, -1.0]);
    }
}
