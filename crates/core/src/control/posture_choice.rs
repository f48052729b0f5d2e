//! The choice of a posture in a decision, by the known values of all postures.
//!
//! A decision always takes another posture than the one before. If a snake could keep a posture, it would decide alike for ever in a
//! situation that does not change. Learning would hardly prevent this: a pause costs only a few percent of the value of the future, less
//! than the noise of the learned values.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Returns the posture of the largest value other than the present one, the lowest index among equal ones. A posture with an unknown value
/// comes last.
pub fn best_posture(worths: &[Option<f32>], present: usize) -> usize {
    best_postures(worths, present).first().copied().unwrap_or(present)
}

/// Returns the posture that an explorer takes: the best one, a random one among equal ones; with probability `epsilon` (0 to 1) any
/// posture other than the present one. It always draws two numbers, so that its stream does not depend on what it has learned.
pub fn explored_posture(
    worths: &[Option<f32>],
    present: usize,
    epsilon: f32,
    rng: &mut ChaCha8Rng,
) -> usize {
    let (is_random, place) = (rng.random::<f32>() < epsilon, rng.random::<f32>());
    let among: Vec<usize> = match is_random {
        true => (0..worths.len()).filter(|posture| *posture != present).collect(),
        false => best_postures(worths, present),
    };
    let index = (place * among.len() as f32) as usize;
    among.get(index).or(among.last()).copied().unwrap_or(present)
}

/// Returns all postures of the largest value other than the present one, in ascending order.
fn best_postures(worths: &[Option<f32>], present: usize) -> Vec<usize> {
    let worth = |posture: usize| worths[posture].unwrap_or(f32::NEG_INFINITY);
    let others = || (0..worths.len()).filter(|posture| *posture != present);
    let best = others().map(worth).fold(f32::NEG_INFINITY, f32::max);
    others().filter(|posture| worth(*posture) >= best).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    #[test]
    fn the_best_other_posture_is_taken() {
        let worths = [Some(1.0), Some(3.0), None, Some(2.0), Some(2.0)];
        assert_eq!([0, 1].map(|present| best_posture(&worths, present)), [1, 3]);
        assert_eq!(best_posture(&[None, Some(-1.0), None], 0), 1, "what is unknown comes last");
        assert_eq!([0, 2].map(|present| best_posture(&[None; 3], present)), [1, 0]);
        assert_eq!(best_posture(&[], 4), 4);
    }

    #[test]
    fn explorers_take_any_other_posture_and_draw_equally_often() {
        let worths = [Some(1.0), Some(3.0), None, Some(3.0)];
        let mut rng = stream(1, 0, 0, Purpose::Explore);
        let mut counts = |epsilon| {
            let mut counts = [0; 4];
            (0..3000).for_each(|_| counts[explored_posture(&worths, 0, epsilon, &mut rng)] += 1);
            counts
        };
        let [none, one, unknown, other] = counts(0.0);
        assert!(none == 0 && unknown == 0 && one > 1400 && other > 1400);
        let [none, rest @ ..] = counts(1.0);
        assert!(none == 0 && rest.iter().all(|count| (900..1100).contains(count)), "{rest:?}");
        let [mut one, mut other] = [(); 2].map(|()| stream(1, 0, 0, Purpose::Explore));
        explored_posture(&worths, 0, 1.0, &mut one);
        explored_posture(&[None; 3], 1, 0.0, &mut other);
        assert_eq!(one, other);
    }
}
