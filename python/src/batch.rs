//! Evaluates many genomes on many threads, without Python's lock, until done or interrupted by the user.

use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::Builder;
use std::time::Duration;

use pyo3::prelude::*;
use snakes_core::genome::Genome;
use snakes_core::score::{Evaluation, Scored, Trial};
use snakes_lab::run::{
    Evaluator, LocalPool, RunControl, THREADS_RANGE, available_cores, evaluate_caught,
};

use crate::convert::whole_as;
use crate::errors::{crashed, no_threads};

/// Returns the requested number of threads; all cores for `None`.
pub fn threads_of(threads: Option<&Bound<'_, PyAny>>) -> PyResult<usize> {
    let (least, most) = (*THREADS_RANGE.start() as u64, *THREADS_RANGE.end() as u64);
    let Some(threads) = threads else { return Ok(available_cores().min(most as usize)) };
    let allowed = format!("None (all cores), or {least} to {most}");
    Ok(whole_as("threads", threads, least..=most, &allowed)? as usize)
}

/// Returns the result of a genome whose simulation panicked, as a run counts it.
fn void() -> Scored {
    Scored { evaluation: Evaluation::void(), episode: None }
}

/// Time between two checks for an interrupt. Python itself reacts within milliseconds.
const PATIENCE: Duration = Duration::from_millis(50);

/// Scores all genomes in a trial, and returns the results in their order. After an interrupt, the evaluations in progress are
/// finished, so it takes at most as long as the longest evaluation.
pub fn score_all(
    py: Python<'_>,
    genomes: &[Genome],
    trial: &Trial,
    threads: usize,
) -> PyResult<Vec<Scored>> {
    let control = RunControl::default();
    let results: Mutex<Vec<Option<Scored>>> = Mutex::new(vec![None; genomes.len()]);
    let pool = LocalPool::new(threads.min(genomes.len()).max(1)).map_err(no_threads)?;
    let store = |index: usize, scored: Scored| {
        if let Ok(mut results) = results.lock()
            && let Some(place) = results.get_mut(index)
        {
            *place = Some(scored);
        }
    };
    let failed = py.detach(|| {
        std::thread::scope(|scope| {
            let (done, finished) = channel::<()>();
            let (control, pool, store) = (&control, &pool, &store);
            let score = move || {
                let jobs: Vec<&Genome> = genomes.iter().collect();
                // Only an interrupt cancels the control.
                let _ = pool.evaluate_batch(trial, &jobs, control, &|index, result| {
                    store(index, result.unwrap_or_else(|_| void()));
                });
                drop(done);
            };
            if let Err(error) = Builder::new().spawn_scoped(scope, score) {
                return Some(no_threads(error.into()));
            }
            loop {
                match finished.recv_timeout(PATIENCE) {
                    Err(RecvTimeoutError::Timeout) => {
                        if let Err(interrupt) = Python::attach(|py| py.check_signals()) {
                            control.cancel();
                            return Some(interrupt);
                        }
                    }
                    _ => return None,
                }
            }
        })
    });
    if let Some(error) = failed {
        return Err(error);
    }
    // An interrupt may also have come during the last wait.
    py.check_signals()?;
    let results = results.into_inner().map_err(|_| crashed("a thread panicked".to_owned()))?;
    // Genomes that the evaluator left out are evaluated on this thread.
    let scored = results.into_iter().zip(genomes).map(|(scored, genome)| {
        scored.unwrap_or_else(|| evaluate_caught(genome, trial).unwrap_or_else(|_| void()))
    });
    Ok(scored.collect())
}
