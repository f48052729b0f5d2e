//! Novelty of stairs: how much their ranking of the agents of a run differs from that of other stairs (PATA-EC, Wang et al., "Enhanced
//! POET", 2020).

/// Number of nearest stairs whose mean distance is the novelty.
const NEAREST: usize = 5;

/// Returns the centred ranks of scores that are clipped to the minimal criterion: -0.5 for the least, 0.5 for the greatest. Equal scores
/// share the mean of their ranks, because stairs that are too hard for several agents do not order these agents.
pub fn ranks(scores: &[f32], least: f32, most: f32) -> Vec<f32> {
    let clipped: Vec<f32> = scores.iter().map(|score| score.clamp(least, most)).collect();
    let last = clipped.len().saturating_sub(1).max(1) as f32;
    let rank = |score: &f32| {
        let below = clipped.iter().filter(|other| *other < score).count() as f32;
        let equal = clipped.iter().filter(|other| *other == score).count() as f32;
        (below + (equal - 1.0) / 2.0) / last - 0.5
    };
    clipped.iter().map(rank).collect()
}

/// Returns the mean distance of ranks to their [`NEAREST`] nearest among `known`; 0 if `known` is empty.
pub fn distance(ranks: &[f32], known: &[Vec<f32>]) -> f32 {
    let between = |other: &Vec<f32>| {
        let squares: f32 = ranks.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
        squares.sqrt()
    };
    let mut distances: Vec<f32> = known.iter().map(between).collect();
    distances.sort_by(f32::total_cmp);
    distances.truncate(NEAREST);
    distances.iter().sum::<f32>() / distances.len().max(1) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_centred_and_what_is_outside_the_criterion_is_equal() {
        assert_eq!(ranks(&[0.2, 0.9, 0.5, 1.0, 0.1], 0.15, 0.85), [-0.25, 0.375, 0.0, 0.375, -0.5]);
        assert_eq!(ranks(&[0.0, 0.1, 0.05], 0.15, 0.85), [0.0; 3]);
        assert_eq!(ranks(&[0.3], 0.15, 0.85), [-0.5]);
        assert!(ranks(&[], 0.15, 0.85).is_empty());
    }

    #[test]
    fn stairs_that_rank_the_agents_in_another_order_are_newer() {
        let known = [vec![-0.5, 0.0, 0.5], vec![-0.5, 0.0, 0.5]];
        assert_eq!(distance(&[-0.5, 0.0, 0.5], &known), 0.0);
        assert!(distance(&[0.5, 0.0, -0.5], &known) > distance(&[-0.5, 0.5, 0.0], &known));
        assert_eq!(distance(&[0.5], &[]), 0.0);
    }
}
