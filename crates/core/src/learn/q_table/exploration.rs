//! How much each actor of a generation explores.

/// The exploration ladder: the shares of random actions decrease from generation to generation, and within a generation from actor 1 to
/// the last. All shares are from 0 to 1.
///
/// The shares are powers, after Horgan and others ("Distributed prioritized experience replay", ICLR 2018), of a base that decreases over
/// the generations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExplorationLadder {
    /// Share of random actions of the boldest actor in generation 0.
    pub first: f32,
    /// Factor on the boldest actor's share per generation.
    pub decay: f32,
    /// Least share of the boldest actor in any generation.
    pub least_of_boldest: f32,
}

/// Least share of random actions of an exploring actor. Without exploration, an actor whose table does not change can stay in a loop for a
/// whole episode.
const LEAST: f32 = 0.02;
/// The share of the last actor is the share of the boldest to the power of 1 + `SPREAD`.
const SPREAD: f64 = 3.0;

/// Returns the share of random actions, from 0 to 1, of actor number `actor` (from 0) of `actors` in generation number `generation` (from
/// 0).
///
/// Actor 0 is greedy, to show how well the table acts. Actor i from 1 has the share max([`LEAST`], e^(1 + [`SPREAD`] · (i - 1) / (`actors`
/// - 2))) with e = max(`least_of_boldest`, `first` · `decay`^`generation`).
pub fn epsilon(generation: u32, actor: u32, actors: u32, ladder: &ExplorationLadder) -> f32 {
    let Some(rung) = actor.checked_sub(1) else { return 0.0 };
    let fallen =
        f64::from(ladder.first) * libm::pow(f64::from(ladder.decay), f64::from(generation));
    let boldest = fallen.max(f64::from(ladder.least_of_boldest));
    // A single explorer has the share of the boldest.
    let last_rung = actors.saturating_sub(2).max(1);
    let height = f64::from(rung) / f64::from(last_rung);
    let share = libm::pow(boldest, 1.0 + SPREAD * height);
    share.max(f64::from(LEAST)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    const LADDER: ExplorationLadder =
        ExplorationLadder { first: 0.6, decay: 0.985, least_of_boldest: 0.1 };

    fn close(a: f32, b: f32) -> bool {
        (a - b).abs() < 1e-6
    }

    #[test]
    fn a_generation_spans_greedy_bold_and_careful_actors() {
        let shares: Vec<f32> = (0..32).map(|actor| epsilon(0, actor, 32, &LADDER)).collect();
        assert_eq!(shares[0], 0.0);
        assert!(close(shares[1], 0.6), "{shares:?}");
        // The expected shares are 0.6^(1 + 3 · 15/30) and 0.6^4.
        assert!(close(shares[16], 0.278_854_8) && close(shares[31], 0.129_6), "{shares:?}");
        assert!(shares[1..].windows(2).all(|pair| pair[0] > pair[1]), "{shares:?}");
    }

    #[test]
    fn shares_fall_over_the_generations_to_their_least() {
        // The expected share is 0.6 · 0.985^50.
        assert!(close(epsilon(50, 1, 32, &LADDER), 0.281_814_4), "{}", epsilon(50, 1, 32, &LADDER));
        for generation in [200, u32::MAX] {
            assert!(close(epsilon(generation, 1, 32, &LADDER), 0.1));
            assert!(close(epsilon(generation, 31, 32, &LADDER), 0.02));
            assert_eq!(epsilon(generation, 0, 32, &LADDER), 0.0);
        }
    }

    #[test]
    fn few_actors_and_extreme_settings_still_have_a_share() {
        assert!(close(epsilon(0, 1, 2, &LADDER), 0.6));
        assert!(close(epsilon(0, 1, 3, &LADDER), 0.6) && close(epsilon(0, 2, 3, &LADDER), 0.1296));
        let none = ExplorationLadder { first: 0.0, least_of_boldest: 0.0, ..LADDER };
        for (actor, actors) in [(0, 0), (1, 0), (5, 1), (u32::MAX, u32::MAX)] {
            assert!((0.0..=1.0).contains(&epsilon(3, actor, actors, &LADDER)));
            let least = if actor == 0 { 0.0 } else { LEAST };
            assert_eq!(epsilon(3, actor, actors, &none), least);
        }
    }
}
