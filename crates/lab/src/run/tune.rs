//! Tuning the controller of a snake to its body with few evaluations: a (1+4) evolution strategy whose step size adapts by the
//! one-fifth rule (Rechenberg, Evolutionsstrategie, 1973).

use super::panics::caught;
use super::run_control::RunControl;
use snakes_core::genome::{Genome, GenomeSpace};
use snakes_core::rng::{Purpose, stream};
use snakes_core::score::{Evaluation, Trial, evaluate};

/// Number of children of each parent.
const CHILDREN: usize = 4;
/// First standard deviation of the changes, as a share of each gene's range.
const FIRST_STEP: f64 = 0.1;
/// Factor on the step size after a generation with an improvement.
const GROWTH: f64 = 1.5;
/// Factor on the step size after a generation without an improvement: `GROWTH` to the power of -1/4, so that the size stays equal
/// if one generation in five improves.
const SHRINKAGE: f64 = 0.9036;

/// A snake whose controller was tuned.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// The genome. Its body is unchanged.
    pub genome: Genome,
    /// Evaluation of the tuned snake.
    pub evaluation: Evaluation,
    /// Evaluation of the snake before tuning.
    pub before: Evaluation,
}

/// Returns a key to compare results: healthy ones come first, by fitness; disqualified ones follow, by the steps they lasted.
fn worth(evaluation: &Evaluation) -> (bool, f32) {
    let is_healthy = evaluation.disqualified.is_none();
    (is_healthy, if is_healthy { evaluation.fitness } else { evaluation.steps as f32 })
}

/// Tunes only the genes of the controller, with this number of evaluations, including one of the given genome. Returns the best.
/// Each `attempt` tries other genes. Ends early when cancelled. Returns `None` if the first evaluation panics.
pub fn tune_controller(
    genome: &Genome,
    trial: &Trial,
    (evaluations, attempt): (usize, u32),
    control: &RunControl,
) -> Option<Tuned> {
    let evaluated = |genome: &Genome| caught(|| evaluate(genome, trial)).ok();
    let before = evaluated(genome)?;
    let space = GenomeSpace::default().widened_for(genome);
    let (mut best, mut best_evaluation, mut step) = (genome.clone(), before, FIRST_STEP);
    control.set_done(1);
    for first in (1..evaluations).step_by(CHILDREN) {
        let parent = best.clone();
        let mut has_improved = false;
        for number in first..(first + CHILDREN).min(evaluations) {
            if control.is_cancelled() {
                return Some(Tuned { genome: best, evaluation: best_evaluation, before });
            }
            let mut rng = stream(genome.hash(), attempt, number as u32, Purpose::Study);
            let mut child = space.with_small_changes(&parent, step, &mut rng);
            child.body.clone_from(&genome.body);
            if let Some(found) = evaluated(&child)
                && worth(&found) > worth(&best_evaluation)
            {
                (best, best_evaluation, has_improved) = (child, found, true);
            }
            control.count_one();
        }
        step *= if has_improved { GROWTH } else { SHRINKAGE };
    }
    Some(Tuned { genome: best, evaluation: best_evaluation, before })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tuning_keeps_the_body_and_never_loses() {
        let champion = snakes_core::save::shipped_champion().expect("shipped").champion;
        let trial = Trial { duration_s: 2.0, ..champion.trial.clone() };
        let own = trial.with_own_blocks(&champion.genome).expect("a gait");
        let mut changed = own.clone();
        changed.body.segments[1].length_m = 1.2;
        let control = RunControl::default();
        let tuned = tune_controller(&changed, &trial, (13, 1), &control).expect("it simulates");
        assert_eq!(control.done(), 13);
        assert_eq!(tuned.genome.body, changed.body);
        assert!(worth(&tuned.evaluation) >= worth(&tuned.before));
        assert_eq!(evaluate(&tuned.genome, &trial), tuned.evaluation);
        let again = tune_controller(&changed, &trial, (13, 1), &RunControl::default());
        assert_eq!(again, Some(tuned), "the same each time");
    }
}
