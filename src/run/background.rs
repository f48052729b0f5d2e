//! An experiment on a thread of its own, for a window that must not wait.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rayon::ThreadPool;

use super::{
    Ancestor, Cancelled, Control, Descent, Experiment, Generation, GenerationReport, Keeper,
    KeptRun, RunSource,
};
use crate::evolve::{Archive, Champion, Front, SettingChange};

/// What an experiment in the background has to tell.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// The run's folder is open, and these generations are behind the run.
    Opened(Vec<GenerationReport>),
    /// These settings were changed before, the earliest first. Told once, of a run that was, before it is open.
    WasChanged(Vec<SettingChange>),
    /// A setting is changed, and takes effect with the generation that begins next.
    Changed(SettingChange),
    /// A setting stays as it is.
    NotChanged {
        /// Its full dotted name.
        field: String,
        /// Why, in a line.
        reason: String,
    },
    /// The run's folder cannot be opened: nothing is evolved.
    Refused(String),
    /// What has been found besides champions: after the generations behind the run, and before each further one.
    Explored(Box<Exploration>),
    /// A generation is finished.
    Generation(Box<GenerationReport>),
    /// All generations are finished.
    Finished {
        /// Hash over the whole run.
        run_hash: u64,
    },
    /// The generation could not be saved. The run is held; going on tries again.
    NotSaved(String),
    /// The program failed on a genome, in a line; the run goes on.
    Crashed(String),
    /// The run broke off by an error of the program, and will say no more.
    BrokeOff,
}

/// What a run has found besides its champions.
#[derive(Debug, Clone, PartialEq)]
pub struct Exploration {
    /// Who is beaten by nobody in distance and energy.
    pub front: Front,
    /// The best of every kind, if the strategy keeps such an archive.
    pub archive: Option<Archive>,
    /// The best of the latest generation, the best first; nobody of a generation that an earlier session finished.
    pub leaders: Vec<Champion>,
    /// The latest generation; none if an earlier session finished it.
    pub generation: Option<Arc<Generation>>,
    /// The parents of the next generation, each with how many children it will have, as far as they are known.
    pub parents: Vec<(Arc<Ancestor>, u32)>,
    /// The line of descent of the best so far.
    pub descent: Descent,
}

impl Exploration {
    /// Of an experiment, as it is.
    pub fn of(experiment: &Experiment) -> Self {
        Self {
            front: experiment.front().clone(),
            archive: experiment.archive().cloned(),
            leaders: experiment.leaders().to_vec(),
            generation: experiment.generation().cloned(),
            parents: experiment.parents(),
            descent: experiment.descent(),
        }
    }
}

/// An experiment that goes on in the background. Dropping it cancels it, and waits a moment for what is
/// being written.
#[derive(Debug)]
pub struct Background {
    control: Arc<Control>,
    pause_after_generation: Arc<AtomicBool>,
    /// Behind a lock so that a window may keep this where several threads can see it.
    events: Mutex<Receiver<Event>>,
    /// Size of the generation under way. Some strategies change it.
    population: Arc<AtomicU32>,
    /// Settings that are to be changed before the next generation, by full dotted names, with their values.
    wishes: Arc<Mutex<VecDeque<(String, String)>>>,
    /// The threads of the next generation.
    pool: Arc<Mutex<Arc<ThreadPool>>>,
    has_ended: AtomicBool,
}

/// How long dropping an experiment waits for its thread: much longer than a file takes to be written.
const LONGEST_FAREWELL: Duration = Duration::from_secs(2);

impl Background {
    /// Opens a run and starts it on `pool`, held before its first evaluation: see [`Self::resume`]. If its
    /// folder may still be in use by `before`, it waits until that has ended, in the background.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(
        source: RunSource,
        pool: Arc<ThreadPool>,
        before: Option<Self>,
    ) -> std::io::Result<Self> {
        let control = Arc::new(Control::default());
        control.pause();
        let pause_after_generation = Arc::new(AtomicBool::new(false));
        let population = Arc::new(AtomicU32::new(source.plan.settings.evolution.population));
        let wishes = Arc::default();
        let pool = Arc::new(Mutex::new(pool));
        let (sender, events) = channel();
        if let Some(before) = &before {
            before.control.cancel();
        }
        thread::Builder::new().name("experiment".to_owned()).spawn({
            let worker = Worker {
                control: Arc::clone(&control),
                pause_after_generation: Arc::clone(&pause_after_generation),
                population: Arc::clone(&population),
                wishes: Arc::clone(&wishes),
                pool: Arc::clone(&pool),
                events: sender,
            };
            move || {
                if let Some(before) = before {
                    before.wait_for_end();
                }
                if worker.control.is_cancelled() {
                    return;
                }
                match source.open("the studio") {
                    Ok(run) => worker.work(run),
                    Err(error) => worker.tell(Event::Refused(error.to_string())),
                }
            }
        })?;
        let events = Mutex::new(events);
        Ok(Self {
            control,
            pause_after_generation,
            events,
            population,
            wishes,
            pool,
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

    /// Whether it will pause after the current generation.
    pub fn is_single_generation(&self) -> bool {
        self.pause_after_generation.load(Ordering::SeqCst)
    }

    /// Holds the workers.
    pub fn pause(&self) {
        self.control.pause();
    }

    /// Changes settings, by their full dotted names, before the next generation begins; of a run that is held between
    /// two generations, at once. What comes of it is told: [`Event::Changed`], [`Event::NotChanged`], or nothing, if
    /// it is already so.
    pub fn amend(&self, changes: impl IntoIterator<Item = (String, String)>) {
        self.wishes.lock().unwrap_or_else(PoisonError::into_inner).extend(changes);
        self.control.nudge();
    }

    /// Takes other worker threads, from the next generation on. That changes no bit.
    pub fn set_pool(&self, pool: Arc<ThreadPool>) {
        *self.pool.lock().unwrap_or_else(PoisonError::into_inner) = pool;
    }

    /// Whether the workers are held.
    pub fn is_paused(&self) -> bool {
        self.control.is_paused()
    }

    /// Finished evaluations of the current generation, and how many there will be.
    pub fn progress(&self) -> (u32, u32) {
        let population = self.population.load(Ordering::Relaxed);
        // Between two generations one number may be read before and the other after.
        (self.control.done().min(population), population)
    }

    /// The next event, if there is one.
    pub fn poll(&self) -> Option<Event> {
        match self.events.lock().unwrap_or_else(PoisonError::into_inner).try_recv() {
            Ok(event) => {
                let is_last = matches!(event, Event::Finished { .. } | Event::Refused(_));
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

    /// Waits for as long as it takes until the folder of a cancelled experiment is free.
    fn wait_for_end(self) {
        let events = self.events.lock().unwrap_or_else(PoisonError::into_inner);
        // Until its end of the channel is gone.
        events.iter().for_each(drop);
    }
}

impl Drop for Background {
    fn drop(&mut self) {
        self.control.cancel();
        let events = self.events.get_mut().unwrap_or_else(PoisonError::into_inner);
        let deadline = Instant::now() + LONGEST_FAREWELL;
        // Its end of the channel is gone when the thread has ended.
        while events.recv_timeout(deadline.saturating_duration_since(Instant::now()))
            != Err(RecvTimeoutError::Disconnected)
            && Instant::now() < deadline
        {}
    }
}

/// What the experiment's thread shares with its [`Background`].
struct Worker {
    control: Arc<Control>,
    pause_after_generation: Arc<AtomicBool>,
    population: Arc<AtomicU32>,
    wishes: Arc<Mutex<VecDeque<(String, String)>>>,
    pool: Arc<Mutex<Arc<ThreadPool>>>,
    events: Sender<Event>,
}

impl Worker {
    /// A send fails only when nobody listens any more; the run is cancelled then anyway.
    fn tell(&self, event: Event) {
        drop(self.events.send(event));
    }

    fn work(&self, run: KeptRun) {
        let KeptRun { mut experiment, mut keeper, reports } = run;
        let control = &*self.control;
        let explored =
            |experiment: &Experiment| Event::Explored(Box::new(Exploration::of(experiment)));
        self.population.store(experiment.population(), Ordering::Relaxed);
        if !keeper.changes().is_empty() {
            self.tell(Event::WasChanged(keeper.changes().to_vec()));
        }
        self.tell(Event::Opened(reports));
        if experiment.finished() > 0 {
            self.tell(explored(&experiment));
        }
        loop {
            // Even one that is at its end can be made longer.
            self.fulfil_wishes(&mut experiment, &mut keeper);
            if experiment.is_over() {
                break;
            }
            match control.pass_unless(|| self.has_wishes()) {
                Ok(true) => {}
                Ok(false) => continue,
                Err(Cancelled) => return,
            }
            let pool = Arc::clone(&self.pool.lock().unwrap_or_else(PoisonError::into_inner));
            let note = |generation, individual, evaluation: &_| {
                keeper.note(generation, individual, evaluation);
            };
            let Ok(report) = experiment.run_generation_noting(&pool, control, note) else { return };
            let crashes = loop {
                match keeper.keep(&experiment, &report) {
                    Ok(crashes) => break crashes,
                    Err(error) => {
                        control.pause();
                        self.tell(Event::NotSaved(error.to_string()));
                    }
                }
                if control.pass().is_err() {
                    return;
                }
            };
            if self.pause_after_generation.swap(false, Ordering::SeqCst) {
                control.pause();
            }
            crashes.into_iter().for_each(|crash| self.tell(Event::Crashed(crash)));
            self.tell(explored(&experiment));
            self.tell(Event::Generation(Box::new(report)));
        }
        self.tell(Event::Finished { run_hash: experiment.run_hash() });
    }

    fn wishes(&self) -> MutexGuard<'_, VecDeque<(String, String)>> {
        self.wishes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn has_wishes(&self) -> bool {
        !self.wishes().is_empty()
    }

    /// Changes what is to be changed before the next generation.
    fn fulfil_wishes(&self, experiment: &mut Experiment, keeper: &mut Keeper) {
        loop {
            self.show_next_generation(experiment);
            let Some((field, text)) = self.wishes().pop_front() else { return };
            let event = match keeper.amend(experiment, &field, &text) {
                Ok(None) => continue,
                Ok(Some(change)) => Event::Changed(change),
                Err(error) => Event::NotChanged { field, reason: error.to_string() },
            };
            // Before it is told, so that whoever hears of it sees the generation that it counts for.
            self.show_next_generation(experiment);
            self.tell(event);
        }
    }

    /// Shows the progress of the generation that begins next, of which nobody is done; after the last one, of that one.
    fn show_next_generation(&self, experiment: &Experiment) {
        if !experiment.is_over() {
            self.control.start_generation();
        }
        self.population.store(experiment.population(), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests;
