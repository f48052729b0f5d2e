//! Whole runs in parallel, each on one worker, so that no run waits for the slowest evaluation of a generation.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::evaluator::{Evaluator, WorkersError};
use super::headless::HeadlessError;
use super::run_control::{Cancelled, RunControl};

/// Calls `work` for each index below `count`, with an evaluator of a single worker. As many calls run at the same time as
/// `evaluator` has workers. Calls `done` with each result, one at a time.
///
/// # Errors
/// `control` was cancelled, workers could not be started, or `done` failed.
pub(crate) fn whole_runs<T: Send>(
    count: usize,
    evaluator: &dyn Evaluator,
    control: &RunControl,
    work: impl Fn(usize, &dyn Evaluator) -> Result<T, Cancelled> + Sync,
    done: impl FnMut(T) -> Result<(), HeadlessError> + Send,
) -> Result<(), HeadlessError> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(done);
    let worker = || -> Result<(), HeadlessError> {
        let single = evaluator.with_workers(1)?;
        loop {
            let index = next.fetch_add(1, Ordering::SeqCst);
            if index >= count {
                return Ok(());
            }
            let result = work(index, &*single);
            let result = result.map_err(|Cancelled| HeadlessError::Cancelled { kept: None })?;
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            if let Err(error) = done(result) {
                // If this result cannot be stored, those of other runs could not be stored either.
                control.cancel();
                return Err(error);
            }
        }
    };
    thread::scope(|scope| {
        let start = |number| {
            let named = thread::Builder::new().name(format!("runs-{number}"));
            named.spawn_scoped(scope, worker).inspect_err(|_| control.cancel())
        };
        let workers: Vec<_> = (0..evaluator.workers().min(count)).map(start).collect();
        let results = workers.into_iter().map(|worker| {
            let worker = worker.map_err(WorkersError::from)?;
            worker.join().unwrap_or(Err(HeadlessError::Cancelled { kept: None }))
        });
        // The cause is reported instead of the cancellations that followed from it.
        let mut errors: Vec<HeadlessError> = results.filter_map(Result::err).collect();
        errors.sort_by_key(|error| matches!(error, HeadlessError::Cancelled { .. }));
        errors.into_iter().next().map_or(Ok(()), Err)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::LocalPool;
    use std::io;

    #[test]
    fn every_index_is_worked_on_once_and_a_failure_to_store_ends_the_others() {
        let pool = LocalPool::new(3).expect("threads");
        let (control, mut seen) = (RunControl::default(), Vec::new());
        let work = |index, single: &dyn Evaluator| {
            assert_eq!(single.workers(), 1);
            Ok(index)
        };
        let store = |index| {
            seen.push(index);
            Ok(())
        };
        whole_runs(40, &pool, &control, work, store).expect("not cancelled");
        seen.sort_unstable();
        assert_eq!(seen, (0..40).collect::<Vec<usize>>());
        let fails = |_| Err(HeadlessError::Output(io::Error::other("full")));
        let error = whole_runs(40, &pool, &control, work, fails).expect_err("refused");
        assert!(error.to_string().contains("full"), "{error}");
        assert!(control.is_cancelled());
    }
}
