//! A rollout looked through on a thread of its own, for a window that must not wait.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use super::caught;
use crate::genome::Genome;
use crate::score::{History, Trial};

/// A history that is on its way, or there. Dropping it ends the work.
#[derive(Default)]
pub struct Lookahead {
    /// Behind a lock so that a window may keep this where several threads can see it.
    coming: Option<Mutex<Receiver<Option<History>>>>,
    history: Option<Arc<History>>,
    watch: Arc<Watch>,
}

#[derive(Default)]
struct Watch {
    steps_done: AtomicU32,
    is_unwanted: AtomicBool,
}

impl Lookahead {
    /// Begins to work out what will happen to a genome in a trial. Both must have passed their checks. Where no thread
    /// can be started, or the program fails on it, there will be no history.
    pub fn begin(genome: &Genome, trial: &Trial) -> Self {
        let watch = Arc::new(Watch::default());
        let (sender, coming) = channel();
        let (genome, trial, watched) = (genome.clone(), trial.clone(), Arc::clone(&watch));
        let started = thread::Builder::new().name("lookahead".to_owned()).spawn(move || {
            let goes_on = |step| {
                watched.steps_done.store(step, Ordering::Relaxed);
                !watched.is_unwanted.load(Ordering::Relaxed)
            };
            let history = caught(|| History::of(&genome, &trial, goes_on)).ok().flatten();
            // A send fails only when nobody waits any more.
            drop(sender.send(history));
        });
        Self { coming: started.is_ok().then_some(Mutex::new(coming)), history: None, watch }
    }

    /// Takes the history in if it is there.
    pub fn poll(&mut self) {
        self.take_in(|coming| coming.try_recv().map_err(|error| error == TryRecvError::Empty));
    }

    /// Waits until the history is there, for somebody who has time.
    pub fn wait(&mut self) {
        self.take_in(|coming| coming.recv().map_err(|_| false));
    }

    /// `receive` says in its error whether the history may still come.
    fn take_in(
        &mut self,
        receive: impl FnOnce(&Receiver<Option<History>>) -> Result<Option<History>, bool>,
    ) {
        let Some(coming) = &self.coming else { return };
        let received = receive(&coming.lock().unwrap_or_else(PoisonError::into_inner));
        if matches!(received, Err(true)) {
            return;
        }
        self.coming = None;
        self.history = received.ok().flatten().map(Arc::new);
    }

    /// What will happen, once it is known.
    pub fn history(&self) -> Option<&Arc<History>> {
        self.history.as_ref()
    }

    /// How many steps are worked out, while it is on its way.
    pub fn steps_done(&self) -> Option<u32> {
        self.coming.as_ref().map(|_| self.watch.steps_done.load(Ordering::Relaxed))
    }
}

impl Drop for Lookahead {
    fn drop(&mut self) {
        self.watch.is_unwanted.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use std::time::{Duration, Instant};

    #[test]
    fn a_history_comes_by_itself_and_one_that_is_dropped_is_worked_out_no_further() {
        let champion = shipped_champion().expect("well formed").champion;
        let mut lookahead = Lookahead::begin(&champion.genome, &champion.trial);
        lookahead.wait();
        let history = lookahead.history().expect("worked out");
        assert_eq!(*history.evaluation(), champion.evaluation);
        assert_eq!(lookahead.steps_done(), None);

        let long = Trial { duration_s: 600.0, ..champion.trial };
        let lookahead = Lookahead::begin(&champion.genome, &long);
        let watch = Arc::clone(&lookahead.watch);
        drop(lookahead);
        let started = Instant::now();
        // Its thread lets go of the watch when it ends.
        while Arc::strong_count(&watch) > 1 {
            assert!(started.elapsed() < Duration::from_secs(60), "it goes on and on");
            thread::sleep(Duration::from_millis(1));
        }
        assert!(watch.steps_done.load(Ordering::Relaxed) < long.steps());
    }
}
