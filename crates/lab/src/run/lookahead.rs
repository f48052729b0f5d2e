//! Simulates a rollout to its end in the background, for a window that must not wait.

use std::sync::Arc;

use super::background_task::BackgroundTask;
use snakes_core::genome::Genome;
use snakes_core::score::{KeyframeHistory, Rollout, Trial};

/// History of a rollout, in progress or complete. Dropping it ends the simulation.
#[derive(Default)]
pub struct Lookahead {
    task: Option<BackgroundTask<Option<KeyframeHistory>>>,
    history: Option<Arc<KeyframeHistory>>,
}

impl Lookahead {
    /// Starts to simulate a genome in a trial, both of which must have passed their checks. If no thread can be started, or the
    /// simulation panics, the history stays `None`.
    pub fn begin(genome: &Genome, trial: &Trial) -> Self {
        let (genome, trial) = (genome.clone(), trial.clone());
        Self::run(trial.steps(), move || Rollout::new(&genome, &trial))
    }

    /// Starts to simulate a rollout, which must be at its start.
    pub fn of(rollout: Rollout) -> Self {
        Self::run(rollout.last_step(), || rollout)
    }

    /// Returns a copy with the history, if it is complete. Simulates nothing.
    pub fn kept(&self) -> Self {
        Self { task: None, history: self.history.clone() }
    }

    fn run(steps: u32, begin: impl FnOnce() -> Rollout + Send + 'static) -> Self {
        let task = BackgroundTask::start_counted(steps as usize, move |control| {
            let goes_on = |step: u32| {
                control.set_done(step);
                !control.is_cancelled()
            };
            KeyframeHistory::of_rollout(begin(), goes_on)
        });
        Self { task: task.ok(), history: None }
    }

    /// Stores the history if the simulation has ended.
    pub fn poll(&mut self) {
        let ended = self.task.as_ref().and_then(BackgroundTask::poll);
        ended.into_iter().for_each(|result| self.finish(result));
    }

    /// Blocks until the simulation has ended, and stores the history.
    pub fn wait(&mut self) {
        let ended = self.task.as_ref().map(BackgroundTask::wait);
        ended.into_iter().for_each(|result| self.finish(result));
    }

    fn finish(&mut self, result: Result<Option<KeyframeHistory>, String>) {
        self.task = None;
        self.history = result.ok().flatten().map(Arc::new);
    }

    /// Returns the history, or `None` if it is not complete.
    pub fn history(&self) -> Option<&Arc<KeyframeHistory>> {
        self.history.as_ref()
    }

    /// Returns the number of steps simulated so far, or `None` when the work has ended.
    pub fn steps_done(&self) -> Option<u32> {
        self.task.as_ref().map(|task| task.done() as u32)
    }
}

impl Drop for Lookahead {
    fn drop(&mut self) {
        self.task.iter().for_each(BackgroundTask::cancel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::shipped_champion;
    use std::time::{Duration, Instant};

    #[test]
    fn a_history_is_completed_unless_it_is_dropped_before() {
        let champion = shipped_champion().expect("well formed").champion;
        let mut lookahead = Lookahead::begin(&champion.genome, &champion.trial);
        lookahead.wait();
        let history = lookahead.history().expect("complete");
        assert!(history.evaluation().agrees_with(&champion.evaluation));
        assert_eq!(lookahead.steps_done(), None);

        let long = Trial { duration_s: 600.0, ..champion.trial };
        let lookahead = Lookahead::begin(&champion.genome, &long);
        let control = Arc::clone(&lookahead.task.as_ref().expect("a thread").control);
        drop(lookahead);
        let started = Instant::now();
        // The thread releases its handle when it ends.
        while Arc::strong_count(&control) > 1 {
            assert!(started.elapsed() < Duration::from_secs(60), "the work goes on");
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(control.done() < long.steps());
    }
}
