//! Evaluating a generation. The results are in the order of its candidates.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::run::evaluator::{EvaluationResult, Evaluator, Job, evaluate_caught};
use crate::run::generation_trials::GenerationTrials;
use crate::run::run_control::{Cancelled, RunControl};
use snakes_core::evolve::Candidate;
use snakes_core::learn::Episode;
use snakes_core::score::{Evaluation, Scored};

/// Results of a generation. All lists are in the order of the candidates.
pub struct GenerationResults {
    /// Evaluations. The evaluation of a simulation that panicked is void.
    pub evaluations: Vec<Evaluation>,
    /// Episodes from which the strategy learns; `None` where it learns from none.
    pub episodes: Vec<Option<Episode>>,
    /// Messages of panics; `None` for individuals without a panic.
    pub messages: Vec<Option<String>>,
}

/// Evaluates the candidates without a known result, and calls `record` with each new evaluation.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn evaluate(
    candidates: &[Candidate],
    trials: &GenerationTrials,
    known: &BTreeMap<u32, Evaluation>,
    evaluator: &dyn Evaluator,
    control: &RunControl,
    record: &(dyn Fn(u32, &Evaluation) + Sync),
) -> Result<GenerationResults, Cancelled> {
    let result_of = |index: usize| match known.get(&(index as u32)) {
        Some(known) => OnceLock::from(Ok(Scored { evaluation: *known, episode: None })),
        None => OnceLock::new(),
    };
    let results: Vec<OnceLock<EvaluationResult>> = (0..candidates.len()).map(result_of).collect();
    let unknown: Vec<usize> =
        (0..candidates.len()).filter(|&index| results[index].get().is_none()).collect();
    (unknown.len()..candidates.len()).for_each(|_| control.count_one());
    let store = |index: usize, result: EvaluationResult| {
        let evaluation = result.as_ref().ok().map(|scored| scored.evaluation);
        if results[index].set(result).is_err() {
            return;
        }
        // A crash is not recorded: a resumed run tries the simulation again, perhaps with a corrected program.
        if let Some(evaluation) = evaluation {
            record(index as u32, &evaluation);
        }
        control.count_one();
    };
    let genome = |index: usize| &candidates[index].genome;
    let job = |&index: &usize| Job { genome: genome(index), trial: trials.index_of(index) };
    let jobs: Vec<Job<'_>> = unknown.iter().map(job).collect();
    evaluator.evaluate_jobs(&trials.all, &jobs, control, &|job, result| {
        if let Some(&index) = unknown.get(job) {
            store(index, result);
        }
    })?;
    for &index in &unknown {
        if results[index].get().is_none() {
            control.wait_while_paused()?;
            store(index, evaluate_caught(genome(index), trials.of(index)));
        }
    }
    Ok(GenerationResults::of(results.into_iter().filter_map(OnceLock::into_inner)))
}

impl GenerationResults {
    fn of(results: impl Iterator<Item = EvaluationResult>) -> Self {
        let (mut evaluations, mut episodes, mut messages) = (Vec::new(), Vec::new(), Vec::new());
        for result in results {
            let (scored, message) = match result {
                Ok(scored) => (scored, None),
                Err(message) => {
                    (Scored { evaluation: Evaluation::void(), episode: None }, Some(message))
                }
            };
            evaluations.push(scored.evaluation);
            episodes.push(scored.episode);
            messages.push(message);
        }
        Self { evaluations, episodes, messages }
    }
}
