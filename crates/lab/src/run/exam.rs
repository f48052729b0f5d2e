//! Examining a champion with an evaluator.

use std::sync::OnceLock;

use super::evaluator::{Evaluator, examine_caught};
use super::run_control::{Cancelled, RunControl};
use snakes_core::evolve::Champion;
use snakes_core::genome::Genome;
use snakes_core::score::{ExamCondition, ExamEnd, ExamSuite, StairsGrid, SuiteResult};

/// Returns the number of trials that these suites take for a champion, including one undisturbed trial per suite.
pub fn exam_trials(champion: &Champion, suites: &[ExamSuite]) -> u32 {
    let suites = suites.iter().filter(|suite| suite.concerns(&champion.genome));
    let trials = suites.map(|suite| suite.conditions(&champion.trial).len() as u32);
    trials.filter(|&conditions| conditions > 0).map(|conditions| conditions + 1).sum()
}

/// Examines a champion in each suite that has conditions for it. A suite may have none: without steps, for example, no step can be
/// higher.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn examine(
    champion: &Champion,
    suites: &[ExamSuite],
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<SuiteResult>, Cancelled> {
    control.set_done(0);
    let suites = suites.iter().filter(|suite| suite.concerns(&champion.genome));
    let suites = suites.map(|suite| (*suite, suite.conditions(&champion.trial)));
    let result = |(suite, mut conditions): (ExamSuite, Vec<ExamCondition>)| {
        let first = conditions.len();
        conditions.push(suite.undisturbed(&champion.trial));
        let mut ends = exam_ends(&champion.genome, &conditions, evaluator, control)?;
        let own = ends.remove(first);
        conditions.truncate(first);
        Ok(SuiteResult::of(suite, &own, &conditions, &ends))
    };
    suites.filter(|(_, conditions)| !conditions.is_empty()).map(result).collect()
}

/// Returns the number of trials that [`examine_on_stairs`] takes for a champion.
pub fn stairs_trials(champion: &Champion) -> u32 {
    stairs_conditions(champion).iter().map(|(_, conditions)| conditions.len() as u32).sum()
}

/// Examines a champion on 100 other stairs, and once more without senses if its controller has any.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn examine_on_stairs(
    champion: &Champion,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<StairsGrid>, Cancelled> {
    control.set_done(0);
    let grid = |(suite, conditions): (ExamSuite, Vec<ExamCondition>)| {
        let ends = exam_ends(&champion.genome, &conditions, evaluator, control)?;
        Ok(StairsGrid::of(suite, &champion.trial, &conditions, &ends))
    };
    stairs_conditions(champion).into_iter().map(grid).collect()
}

/// Returns the suites of other stairs that concern a champion, with their conditions.
fn stairs_conditions(champion: &Champion) -> Vec<(ExamSuite, Vec<ExamCondition>)> {
    let suites = ExamSuite::OF_STAIRS.into_iter();
    let suites = suites.filter(|suite| suite.concerns(&champion.genome));
    suites.map(|suite| (suite, suite.conditions(&champion.trial))).collect()
}

/// Returns the end of a genome's trial in each condition. A trial whose simulation panics counts as disqualified.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn exam_ends(
    genome: &Genome,
    conditions: &[ExamCondition],
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<ExamEnd>, Cancelled> {
    let ends: Vec<OnceLock<ExamEnd>> = conditions.iter().map(|_| OnceLock::new()).collect();
    let store = |index: usize, end: ExamEnd| {
        if ends.get(index).is_some_and(|place| place.set(end).is_ok()) {
            control.count_one();
        }
    };
    evaluator.examine_batch(genome, conditions, control, &store)?;
    // Conditions that the evaluator did not report are simulated on this thread.
    for (index, condition) in conditions.iter().enumerate() {
        if ends[index].get().is_none() {
            control.wait_while_paused()?;
            store(index, examine_caught(genome, condition));
        }
    }
    Ok(ends.into_iter().filter_map(OnceLock::into_inner).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::LocalPool;
    use snakes_core::genome::ControllerKind;
    use snakes_core::rng::{Purpose, stream};
    use snakes_core::save::{load_preset, shipped_champion};
    use snakes_core::score::evaluate;

    #[test]
    fn an_exam_has_the_same_result_for_any_number_of_threads_and_can_be_cancelled() {
        let champion = shipped_champion().expect("well formed").champion;
        let suites = [ExamSuite::StepRate];
        let examined = |threads| {
            let pool = LocalPool::new(threads).expect("threads");
            let control = RunControl::default();
            let results = examine(&champion, &suites, &pool, &control).expect("not cancelled");
            assert_eq!(control.done(), exam_trials(&champion, &suites));
            results
        };
        let results = examined(1);
        assert_eq!(results, examined(3));
        assert_eq!((results[0].trials, results[0].each.len()), (5, 5));
        assert_eq!(results[0].each[0], ("60 Hz".to_owned(), 1.0), "its own step rate");
        let control = RunControl::default();
        control.cancel();
        let pool = LocalPool::new(1).expect("threads");
        assert!(examine(&champion, &suites, &pool, &control).is_err());
        assert!(examine_on_stairs(&champion, &pool, &control).is_err());
    }

    #[test]
    fn only_a_champion_that_senses_is_also_examined_without_senses() {
        let mut champion = shipped_champion().expect("well formed").champion;
        assert_eq!(stairs_trials(&champion), 100, "a gait");
        let mut settings = load_preset("climb").expect("shipped").settings;
        settings.genome.controller = ControllerKind::Reflex;
        let mut rng = stream(1, 1, 3, Purpose::Birth);
        champion.genome = settings.genome.random_genome(settings.trial.genome_shape(), &mut rng);
        assert_eq!(stairs_trials(&champion), 200);
    }

    #[test]
    #[ignore = "takes about ten seconds: cargo test --release -p snakes-lab a_typical_trial -- --ignored"]
    fn a_typical_trial_of_a_cell_ends_as_in_the_exam_when_it_is_simulated_again() {
        let champion = shipped_champion().expect("well formed").champion;
        let pool = LocalPool::new(2).expect("threads");
        let control = RunControl::default();
        let grids = examine_on_stairs(&champion, &pool, &control).expect("not cancelled");
        assert_eq!((grids.len(), grids[0].trials(), control.done()), (1, 100, 100));
        let suite = examine(&champion, &[ExamSuite::Stairs], &pool, &control);
        assert_eq!(grids[0].landed(), suite.expect("not cancelled")[0].landed);
        for cell in &grids[0].cells {
            let evaluation = evaluate(&champion.genome, &cell.typical);
            let has_landed = evaluation.is_on_landing(&cell.typical.stairs);
            assert_eq!(has_landed, cell.typical_end.has_landed, "{cell:?}");
            assert_eq!(has_landed, cell.landed * 2 > cell.trials, "{cell:?}");
        }
    }
}
