//! Runs for a visual comparison: evolved side by side, a generation of each in turn, and not saved.

use std::sync::Arc;
use std::thread;

use crossbeam_channel::{Receiver, Sender, unbounded};

use super::evaluator::LocalPool;
use super::experiment::Experiment;
use super::report::GenerationReport;
use super::run_control::RunControl;
use snakes_core::evolve::RunPlan;

/// News about parallel runs.
#[derive(Debug, Clone, PartialEq)]
pub enum ParallelRunsEvent {
    /// A generation of a run is finished.
    Generation {
        /// Index of the run.
        run: usize,
        /// Results of the generation.
        report: Box<GenerationReport>,
    },
    /// All generations of a run are finished.
    Finished {
        /// Index of the run.
        run: usize,
        /// Hash over the whole run.
        run_hash: u64,
    },
    /// All runs ended by an error. Holds the reason. No more events follow.
    Failed(String),
}

/// Runs on a background thread, which evolves a generation of each in turn. Dropping them cancels them.
#[derive(Debug)]
pub struct ParallelRuns {
    control: Arc<RunControl>,
    events: Receiver<ParallelRunsEvent>,
}

impl ParallelRuns {
    /// Starts runs, each given by its plan and its number of worker threads.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(plans: Vec<(RunPlan, usize)>) -> std::io::Result<Self> {
        let control = Arc::new(RunControl::default());
        let (sender, events) = unbounded();
        thread::Builder::new().name("parallel runs".to_owned()).spawn({
            let control = Arc::clone(&control);
            move || {
                if let Err(problem) = work(plans, &control, &sender) {
                    // Sending fails only when the receiver was dropped.
                    drop(sender.send(ParallelRunsEvent::Failed(problem)));
                }
            }
        })?;
        Ok(Self { control, events })
    }

    /// Returns the next event, or `None` if there is none.
    pub fn poll(&self) -> Option<ParallelRunsEvent> {
        self.events.try_recv().ok()
    }
}

impl Drop for ParallelRuns {
    fn drop(&mut self) {
        self.control.cancel();
    }
}

/// Evolves a generation of each run in turn until all are over.
fn work(
    plans: Vec<(RunPlan, usize)>,
    control: &RunControl,
    sender: &Sender<ParallelRunsEvent>,
) -> Result<(), String> {
    let mut runs = Vec::new();
    for (plan, threads) in plans {
        let evaluator = LocalPool::new(threads).map_err(|error| error.to_string())?;
        runs.push((Experiment::new(plan), evaluator));
    }
    while runs.iter().any(|(experiment, _)| !experiment.is_over()) {
        for (run, (experiment, evaluator)) in runs.iter_mut().enumerate() {
            if experiment.is_over() {
                continue;
            }
            let Ok(report) = experiment.run_generation(evaluator, control) else { return Ok(()) };
            let send = |event| sender.send(event).is_ok();
            if !send(ParallelRunsEvent::Generation { run, report: Box::new(report) }) {
                return Ok(());
            }
            if experiment.is_over() {
                let run_hash = experiment.run_hash();
                send(ParallelRunsEvent::Finished { run, run_hash });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::Settings;
    use std::time::Duration;

    fn plan(seed: u64) -> RunPlan {
        let mut settings = Settings::default();
        settings.evolution.population = 6;
        settings.evolution.generations = 2;
        settings.trial.duration_s = 0.5;
        RunPlan::new("test", seed, settings)
    }

    #[test]
    fn a_run_has_the_same_hash_on_one_thread_and_on_two_and_another_seed_has_another() {
        let plans = vec![(plan(1), 1), (plan(1), 2), (plan(2), 1)];
        let runs = ParallelRuns::start(plans).expect("a thread");
        let mut hashes = [None; 3];
        let mut generations = [0; 3];
        for _ in 0..3000 {
            match runs.poll() {
                Some(ParallelRunsEvent::Generation { run, report }) => {
                    generations[run] += 1;
                    assert_eq!(report.generation, generations[run], "in turn");
                }
                Some(ParallelRunsEvent::Finished { run, run_hash }) => hashes[run] = Some(run_hash),
                Some(ParallelRunsEvent::Failed(problem)) => panic!("{problem}"),
                None if hashes.iter().all(Option::is_some) => break,
                None => thread::sleep(Duration::from_millis(10)),
            }
        }
        assert_eq!(generations, [2; 3]);
        assert!(hashes[0].is_some() && hashes[0] == hashes[1] && hashes[0] != hashes[2]);
    }
}
