//! Runs for a comparison by eye: side by side, generation by generation, kept nowhere.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use super::{Control, Experiment, GenerationReport, pool};
use crate::evolve::RunPlan;

/// What runs side by side have to tell. `run` is the place of the run among them; the first is 0.
#[derive(Debug, Clone, PartialEq)]
pub enum Told {
    /// A generation is finished.
    Generation {
        /// Which run.
        run: usize,
        /// What it was like.
        report: Box<GenerationReport>,
    },
    /// All generations of a run are finished.
    Finished {
        /// Which run.
        run: usize,
        /// Hash over the whole run.
        run_hash: u64,
    },
    /// They broke off, and will say no more.
    BrokeOff(String),
}

/// Runs that are evolved on a thread of their own, in turn a generation each. Dropping it cancels them.
#[derive(Debug)]
pub struct SideBySide {
    control: Arc<Control>,
    /// Behind a lock so that a window may keep this where several threads can see it.
    told: Mutex<Receiver<Told>>,
}

impl SideBySide {
    /// Begins these runs, each on so many worker threads of its own.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(plans: Vec<(RunPlan, usize)>) -> std::io::Result<Self> {
        let control = Arc::new(Control::default());
        let (sender, told) = channel();
        thread::Builder::new().name("side by side".to_owned()).spawn({
            let control = Arc::clone(&control);
            move || {
                if let Err(problem) = work(plans, &control, &sender) {
                    // A send fails only when nobody listens any more.
                    drop(sender.send(Told::BrokeOff(problem)));
                }
            }
        })?;
        Ok(Self { control, told: Mutex::new(told) })
    }

    /// What is to be told next, if there is something.
    pub fn poll(&self) -> Option<Told> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner).try_recv().ok()
    }
}

impl Drop for SideBySide {
    fn drop(&mut self) {
        self.control.cancel();
    }
}

/// Evolves a generation of each in turn until all are over.
fn work(
    plans: Vec<(RunPlan, usize)>,
    control: &Control,
    sender: &Sender<Told>,
) -> Result<(), String> {
    let mut runs = Vec::new();
    for (plan, threads) in plans {
        let workers = pool(threads).map_err(|error| error.to_string())?;
        runs.push((Experiment::new(plan), workers));
    }
    while runs.iter().any(|(experiment, _)| !experiment.is_over()) {
        for (run, (experiment, workers)) in runs.iter_mut().enumerate() {
            if experiment.is_over() {
                continue;
            }
            let Ok(report) = experiment.run_generation(workers, control) else { return Ok(()) };
            let tell = |told| sender.send(told).is_ok();
            if !tell(Told::Generation { run, report: Box::new(report) }) {
                return Ok(());
            }
            if experiment.is_over() {
                tell(Told::Finished { run, run_hash: experiment.run_hash() });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use std::time::Duration;

    fn plan(seed: u64) -> RunPlan {
        let mut settings = Settings::default();
        settings.evolution.population = 6;
        settings.evolution.generations = 2;
        settings.trial.duration_s = 0.5;
        RunPlan::new("test", seed, settings)
    }

    #[test]
    fn the_same_run_twice_on_one_thread_and_on_two_has_one_hash_and_another_seed_another() {
        let plans = vec![(plan(1), 1), (plan(1), 2), (plan(2), 1)];
        let runs = SideBySide::start(plans).expect("a thread");
        let mut hashes = [None; 3];
        let mut generations = [0; 3];
        for _ in 0..3000 {
            match runs.poll() {
                Some(Told::Generation { run, report }) => {
                    generations[run] += 1;
                    assert_eq!(report.generation, generations[run], "in turn");
                }
                Some(Told::Finished { run, run_hash }) => hashes[run] = Some(run_hash),
                Some(Told::BrokeOff(problem)) => panic!("{problem}"),
                None if hashes.iter().all(Option::is_some) => break,
                None => thread::sleep(Duration::from_millis(10)),
            }
        }
        assert_eq!(generations, [2; 3]);
        assert!(hashes[0].is_some() && hashes[0] == hashes[1] && hashes[0] != hashes[2]);
    }
}
