//! Examining a champion on worker threads.

use super::evaluator::LocalPool;
use super::panics::caught;
use super::run_control::{Cancelled, RunControl};
use crate::evolve::Champion;
use crate::score::{ExamCondition, ExamEnd, ExamSuite, SuiteResult};

/// Number of trials that the suites take for a champion, the undisturbed ones included.
pub fn exam_trials(champion: &Champion, suites: &[ExamSuite]) -> u32 {
    let suites = suites.iter().filter(|suite| suite.concerns(&champion.genome));
    let trials = suites.map(|suite| suite.conditions(&champion.trial).len() as u32);
    trials.filter(|&conditions| conditions > 0).map(|conditions| conditions + 1).sum()
}

/// Examines a champion in each suite that has conditions for it: without steps none can be higher, and a controller
/// without senses loses nothing with them.
///
/// # Errors
/// [`Cancelled`], if `control` was.
pub fn examine(
    champion: &Champion,
    suites: &[ExamSuite],
    pool: &LocalPool,
    control: &RunControl,
) -> Result<Vec<SuiteResult>, Cancelled> {
    control.start_generation();
    let suites = suites.iter().filter(|suite| suite.concerns(&champion.genome));
    let suites = suites.map(|suite| (*suite, suite.conditions(&champion.trial)));
    let result = |(suite, mut conditions): (ExamSuite, Vec<ExamCondition>)| {
        let first = conditions.len();
        conditions.push(suite.undisturbed(&champion.trial));
        let mut ends = exam_ends(champion, &conditions, pool, control)?;
        let own = ends.remove(first);
        conditions.truncate(first);
        Ok(SuiteResult::of(suite, &own, &conditions, &ends))
    };
    suites.filter(|(_, conditions)| !conditions.is_empty()).map(result).collect()
}

/// How a champion ends in each condition. A trial whose simulation panics counts as disqualified.
///
/// # Errors
/// [`Cancelled`], if `control` was.
pub fn exam_ends(
    champion: &Champion,
    conditions: &[ExamCondition],
    pool: &LocalPool,
    control: &RunControl,
) -> Result<Vec<ExamEnd>, Cancelled> {
    pool.map(conditions.len(), |index| {
        control.wait_while_paused()?;
        let end = caught(|| ExamEnd::of(&champion.genome, &conditions[index]));
        control.count_one();
        let disqualified = ExamEnd {
            steps: 0,
            way: 0.0,
            landed_s: None,
            has_landed: false,
            is_disqualified: true,
        };
        Ok(end.unwrap_or(disqualified))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;

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
    }
}
