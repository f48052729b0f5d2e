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
    /// These settings were changed before, the earliest first. Told once, of a run that was.
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
        self.tell(Event::Opened(reports));
        if !keeper.changes().is_empty() {
            self.tell(Event::WasChanged(keeper.changes().to_vec()));
        }
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
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, Settings, with_field};
    use crate::run::pool;
    use crate::save::{Earlier, SavesFolder};

    fn plan() -> RunPlan {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.evolution.generations = 3;
        settings.trial.duration_s = 0.5;
        RunPlan::new("test", 1, settings)
    }

    fn start(folder: &tempfile::TempDir) -> Background {
        let background = start_after(folder, None);
        assert_eq!(next(&background), Event::Opened(Vec::new()));
        background
    }

    fn start_after(folder: &tempfile::TempDir, before: Option<Background>) -> Background {
        let pool = Arc::new(pool(2).expect("a pool"));
        let saves = SavesFolder::find(Some(folder.path()));
        let source = RunSource::in_saves(&saves, plan(), Earlier::Keep);
        Background::start(source, pool, before).expect("a thread")
    }

    /// The next event of any kind.
    fn next_of_all(background: &Background) -> Event {
        let events = background.events.lock().expect("no panic");
        events.recv_timeout(Duration::from_secs(60)).expect("an event in time")
    }

    /// The next event that is not about what was explored.
    fn next(background: &Background) -> Event {
        loop {
            match next_of_all(background) {
                Event::Explored(_) => {}
                event => return event,
            }
        }
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
    fn a_run_that_was_stopped_goes_on_once_the_one_before_has_let_go_of_its_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = start(&folder);
        first.run_single_generation();
        let Event::Generation(report) = next(&first) else { panic!("no generation") };
        let refused = next(&start_after(&folder, None));
        let owner = format!("in use by process {} (the studio)", std::process::id());
        assert!(matches!(refused, Event::Refused(text) if text.contains(&owner)));
        let second = start_after(&folder, Some(first));
        let Event::Opened(behind) = next(&second) else { panic!("not opened") };
        assert_eq!((behind.len(), &behind[0].champion), (1, &report.champion));
    }

    #[test]
    fn a_generation_that_cannot_be_saved_holds_the_run_and_is_saved_when_it_goes_on() {
        let folder = tempfile::tempdir().expect("a folder");
        let background = start(&folder);
        let saves = SavesFolder::find(Some(folder.path()));
        let in_the_way = saves.of_run(&plan()).join("generation-1.ron");
        std::fs::create_dir(&in_the_way).expect("created");
        background.resume();
        assert!(
            matches!(next(&background), Event::NotSaved(text) if text.contains("cannot be written"))
        );
        assert!(background.is_paused());
        std::fs::remove_dir(&in_the_way).expect("removed");
        background.resume();
        assert!(matches!(next(&background), Event::Generation(report) if report.generation == 1));
        assert!(in_the_way.is_file());
    }

    #[test]
    fn before_each_generation_it_tells_what_was_explored_and_of_a_run_that_goes_on_at_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = start(&folder);
        first.run_single_generation();
        let Event::Explored(explored) = next_of_all(&first) else { panic!("not explored") };
        assert_eq!(explored.archive, None, "the report's method keeps none");
        assert!(matches!(next_of_all(&first), Event::Generation(_)));
        let second = start_after(&folder, Some(first));
        assert!(matches!(next_of_all(&second), Event::Opened(behind) if behind.len() == 1));
        // Who else was in the generation is not kept.
        assert_eq!(explored.leaders.len(), 8);
        assert_eq!(explored.generation.as_ref().map(|of| of.genomes.len()), Some(8));
        let Event::Explored(known) = next_of_all(&second) else { panic!("not explored") };
        assert_eq!((known.leaders.len(), &known.generation), (0, &None));
        assert_eq!((&known.front, &known.archive), (&explored.front, &explored.archive));
        let places = |explored: &Exploration| -> Vec<_> {
            let parents = explored.parents.iter().map(|(parent, _)| parent.place);
            parents.chain(explored.descent.line.iter().map(|ancestor| ancestor.place)).collect()
        };
        assert_eq!(places(&known), places(&explored));
        assert_eq!(places(&known).len(), 4 + 1, "four parents, and the best");
    }

    #[test]
    fn progress_counts_the_generation_under_way_whatever_its_size() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut plan = plan();
        let changes = [("cma_es.newborns", "20"), ("strategy", "cma_es"), ("generations", "20")];
        for (field, value) in changes {
            let field = format!("evolution.{field}");
            plan.settings = with_field(&plan.settings, &field, value).expect("allowed");
        }
        let pool = Arc::new(pool(2).expect("a pool"));
        let saves = SavesFolder::find(Some(folder.path()));
        let source = RunSource::in_saves(&saves, plan, Earlier::Keep);
        let background = Background::start(source, pool, None).expect("a thread");
        assert!(matches!(next(&background), Event::Opened(_)));
        assert_eq!(background.progress(), (0, 20));
        // The newborns, then generations of the population.
        background.resume();
        while !matches!(next(&background), Event::Finished { .. }) {}
        assert_eq!(background.progress(), (8, 8));
    }

    #[test]
    fn a_change_counts_from_the_next_generation_on_and_at_once_while_the_run_is_held_between_two() {
        let folder = tempfile::tempdir().expect("a folder");
        let background = start(&folder);
        let wish = |field: &str, value: &str| (format!("evolution.{field}"), value.to_owned());
        background.run_single_generation();
        assert!(matches!(next(&background), Event::Generation(_)));
        background.amend([
            wish("halving.parents", "2"),
            wish("halving.parents", "2"),
            wish("halving.parents", "0"),
            wish("strategy", "ga"),
            wish("population", "5"),
            wish("generations", "4"),
        ]);
        let change = |generation, field: &str, value: &str| {
            let (field, value) = wish(field, value);
            Event::Changed(SettingChange { generation, field, value })
        };
        let is_refused = |event: Event, of: &str, why: &str| matches!(event, Event::NotChanged { field, reason } if field.ends_with(of) && reason.contains(why));
        assert_eq!(next(&background), change(2, "halving.parents", "2"));
        assert!(is_refused(next(&background), "parents", "is 0; allowed: 1 to"));
        assert!(is_refused(next(&background), "strategy", "means nothing to another method"));
        assert_eq!(next(&background), change(2, "population", "5"));
        assert_eq!(next(&background), change(2, "generations", "4"));
        assert_eq!(background.poll(), None, "and nothing more");
        assert!(background.is_paused());
        assert_eq!(background.progress(), (0, 5));
        background.set_pool(Arc::new(pool(1).expect("a pool")));
        background.resume();
        let mut reports = Vec::new();
        let run_hash = loop {
            match next(&background) {
                Event::Finished { run_hash } => break run_hash,
                Event::Generation(report) => reports.push(report.evaluations),
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(reports, [5, 5, 5]);
        // Opened again, it tells what was changed, and has the same end.
        let again = start_after(&folder, Some(background));
        assert!(matches!(next(&again), Event::Opened(behind) if behind.len() == 4));
        assert!(matches!(next(&again), Event::WasChanged(changes) if changes.len() == 3));
        assert_eq!(next(&again), Event::Finished { run_hash });
    }

    #[test]
    fn a_run_in_its_last_generation_can_be_made_longer() {
        let folder = tempfile::tempdir().expect("a folder");
        let background = start(&folder);
        for _ in 1..=2 {
            background.run_single_generation();
            assert!(matches!(next(&background), Event::Generation(_)));
        }
        background.amend([("evolution.generations".to_owned(), "5".to_owned())]);
        background.resume();
        let mut events = 0;
        while !matches!(next(&background), Event::Finished { .. }) {
            events += 1;
        }
        // The change, and generations 3 to 5.
        assert_eq!(events, 1 + 3);
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
        let mut experiment = Experiment::new(plan());
        let pool = pool(1).expect("a pool");
        while !experiment.is_over() {
            experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        }
        assert_eq!(run_hash, experiment.run_hash());
        let saved = std::fs::read_dir(folder.path()).expect("a folder").count();
        assert!(saved > 0, "the best was saved");
    }
}
