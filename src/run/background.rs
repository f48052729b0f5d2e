//! An experiment on a thread of its own, for a window that must not wait.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use rayon::ThreadPool;

use super::{Control, Experiment, GenerationReport, Keeper};

/// What an experiment in the background has to tell.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// A generation is finished.
    Generation(Box<GenerationReport>),
    /// All generations are finished.
    Finished {
        /// Hash over the whole run.
        run_hash: u64,
    },
    /// The best champion could not be saved; the run goes on.
    NotSaved(String),
    /// The run broke off by an error of the program, and will say no more.
    BrokeOff,
}

/// An experiment that goes on in the background. Dropping it cancels it; its thread ends by itself
/// after the evaluations that are under way.
#[derive(Debug)]
pub struct Background {
    control: Arc<Control>,
    pause_after_generation: Arc<AtomicBool>,
    /// Behind a lock so that a window may keep this where several threads can see it.
    events: Mutex<Receiver<Event>>,
    population: u32,
    has_ended: AtomicBool,
}

impl Background {
    /// Starts an experiment on `pool`, held before its first evaluation: see [`Self::resume`].
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(
        experiment: Experiment,
        pool: Arc<ThreadPool>,
        keeper: Keeper,
    ) -> std::io::Result<Self> {
        let control = Arc::new(Control::default());
        control.pause();
        let pause_after_generation = Arc::new(AtomicBool::new(false));
        let population = experiment.settings().evolution.population;
        let (sender, events) = channel();
        thread::Builder::new().name("experiment".to_owned()).spawn({
            let (control, pause_after) =
                (Arc::clone(&control), Arc::clone(&pause_after_generation));
            move || work(experiment, &pool, keeper, &control, &pause_after, &sender)
        })?;
        let events = Mutex::new(events);
        Ok(Self {
            control,
            pause_after_generation,
            events,
            population,
            has_ended: AtomicBool::new(false),
        })
    }

    /// Goes on until paused or finished.
    pub fn resume(&self) {
        self.pause_after_generation.store(false, Ordering::SeqCst);
        self.control.resume();
    }

    /// Goes on to the end of the current generation, then pauses.
    pub fn run_single_generation(&self) {
        self.pause_after_generation.store(true, Ordering::SeqCst);
        self.control.resume();
    }

    /// Holds the workers.
    pub fn pause(&self) {
        self.control.pause();
    }

    /// Whether the workers are held.
    pub fn is_paused(&self) -> bool {
        self.control.is_paused()
    }

    /// Finished evaluations of the current generation, and how many there will be.
    pub fn progress(&self) -> (u32, u32) {
        (self.control.done(), self.population)
    }

    /// The next event, if there is one.
    pub fn poll(&self) -> Option<Event> {
        match self.events.lock().unwrap_or_else(PoisonError::into_inner).try_recv() {
            Ok(event) => {
                let is_last = matches!(event, Event::Finished { .. });
                self.has_ended.fetch_or(is_last, Ordering::Relaxed);
                Some(event)
            }
            Err(TryRecvError::Empty) => None,
            // The thread is gone. Unless it has said that it finished, it did not get there.
            Err(TryRecvError::Disconnected) => {
                (!self.has_ended.swap(true, Ordering::Relaxed)).then_some(Event::BrokeOff)
            }
        }
    }
}

impl Drop for Background {
    fn drop(&mut self) {
        self.control.cancel();
    }
}

fn work(
    mut experiment: Experiment,
    pool: &ThreadPool,
    mut keeper: Keeper,
    control: &Control,
    pause_after_generation: &AtomicBool,
    events: &Sender<Event>,
) {
    // A send fails only when nobody listens any more; the run is cancelled then anyway.
    while !experiment.is_over() {
        let Ok(report) = experiment.run_generation(pool, control) else { return };
        if pause_after_generation.swap(false, Ordering::SeqCst) {
            control.pause();
        }
        if let Err(error) = keeper.keep(&experiment, report.champion.as_ref()) {
            let _ = events.send(Event::NotSaved(error.to_string()));
        }
        let _ = events.send(Event::Generation(Box::new(report)));
    }
    let _ = events.send(Event::Finished { run_hash: experiment.run_hash() });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::run::pool;
    use crate::save::SavesFolder;
    use std::time::Duration;

    fn experiment() -> Experiment {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.evolution.generations = 3;
        settings.trial.duration_s = 0.5;
        Experiment::new("test", 1, settings)
    }

    fn start(folder: &tempfile::TempDir) -> Background {
        let pool = Arc::new(pool(2).expect("a pool"));
        let keeper = Keeper::new(SavesFolder::find(Some(folder.path())));
        Background::start(experiment(), pool, keeper).expect("a thread")
    }

    fn next(background: &Background) -> Event {
        let events = background.events.lock().expect("no panic");
        events.recv_timeout(Duration::from_secs(60)).expect("an event in time")
    }

    #[test]
    fn it_waits_until_it_is_told_to_go_and_pauses_after_a_single_generation() {
        let folder = tempfile::tempdir().expect("a folder");
        let background = start(&folder);
        thread::sleep(Duration::from_millis(30));
        assert_eq!((background.poll(), background.progress()), (None, (0, 8)));
        background.run_single_generation();
        assert!(matches!(next(&background), Event::Generation(report) if report.generation == 1));
        assert!(background.is_paused());
        thread::sleep(Duration::from_millis(30));
        assert_eq!(background.poll(), None, "nothing more until it is told");
    }

    #[test]
    fn a_run_whose_thread_is_gone_says_so_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let background = start(&folder);
        background.control.cancel();
        let event = std::iter::from_fn(|| {
            thread::sleep(Duration::from_millis(5));
            Some(background.poll())
        });
        assert_eq!(event.take(2000).flatten().next(), Some(Event::BrokeOff));
        assert_eq!(background.poll(), None);
    }

    #[test]
    fn in_the_background_a_run_has_the_same_hash() {
        let folder = tempfile::tempdir().expect("a folder");
        let background = start(&folder);
        background.resume();
        let run_hash = loop {
            if let Event::Finished { run_hash } = next(&background) {
                break run_hash;
            }
        };
        let mut experiment = experiment();
        let pool = pool(1).expect("a pool");
        while !experiment.is_over() {
            experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        }
        assert_eq!(run_hash, experiment.run_hash());
        let saved = std::fs::read_dir(folder.path()).expect("a folder").count();
        assert!(saved > 0, "the best was saved");
    }
}
