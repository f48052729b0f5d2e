//! Robustness of a champion: the same genome in many slightly perturbed trials.

use super::evaluator::Evaluator;
use super::exam::exam_ends;
use super::run_control::{Cancelled, RunControl};
use snakes_core::evolve::Champion;
use snakes_core::score::{Endings, PerturbationRange, varied};

/// Results of a champion in perturbed trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Robustness {
    /// Number of trials.
    pub trials: u32,
    /// Number of trials in which the snake was disqualified.
    pub disqualified: u32,
    /// Number of trials that ended at least one step high, at least two steps high, and so on.
    pub reached: Vec<u32>,
    /// How the trials ended.
    pub endings: Endings,
}

/// Simulates a champion in `trials` perturbed trials, which are drawn from `seed`.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn robustness(
    champion: &Champion,
    range: &PerturbationRange,
    trials: u32,
    seed: u64,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Robustness, Cancelled> {
    let trial = &champion.trial;
    control.set_done(0);
    let ends =
        exam_ends(&champion.genome, &varied(trial, range, trials, seed), evaluator, control)?;
    let reached = |steps: u32| ends.iter().filter(|end| end.steps >= steps).count() as u32;
    Ok(Robustness {
        trials,
        disqualified: ends.iter().filter(|end| end.is_disqualified).count() as u32,
        reached: (1..=trial.stairs.steps).map(reached).collect(),
        endings: Endings::of(ends.iter().map(|end| &end.ending)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::LocalPool;
    use snakes_core::save::shipped_champion;
    use snakes_core::score::EndingKind;

    #[test]
    fn only_perturbed_trials_differ_from_the_record() {
        let champion = shipped_champion().expect("well formed").champion;
        let measured = |range: &PerturbationRange, threads| {
            let pool = LocalPool::new(threads).expect("threads");
            robustness(&champion, range, 12, 1, &pool, &RunControl::default())
                .expect("not cancelled")
        };
        let none = PerturbationRange {
            friction: 0.0,
            rise: 0.0,
            density: 0.0,
            start_m: 0.0,
            turn_deg: 0.0,
            ..PerturbationRange::default()
        };
        let still = measured(&none, 1);
        assert_eq!((still.disqualified, still.reached[0], still.reached[9]), (0, 12, 12));
        assert_eq!(still.endings.count(EndingKind::Landed), 12);
        let shaken = measured(&PerturbationRange::default(), 1);
        assert_eq!(shaken, measured(&PerturbationRange::default(), 3), "for any number of threads");
        assert_ne!(shaken, still);
        assert!(shaken.reached.windows(2).all(|pair| pair[1] <= pair[0]));
    }
}
