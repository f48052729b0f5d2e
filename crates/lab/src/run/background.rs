//! A run on a separate thread, for a window that must not wait.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, TryRecvError, unbounded};

use super::evaluator::Evaluator;
use super::experiment::Experiment;
use super::lineage::{Ancestor, Ancestry, Generation};
use super::recorder::{RecordedRun, RunRecorder, RunSource};
use super::report::GenerationReport;
use super::run_control::{Cancelled, RunControl};
use snakes_core::evolve::{Archive, Champion, Front, RunPlan, SettingChange, StairsTree};
use snakes_core::schema::SettingValue;

/// News about a run in the background, sent by its thread.
#[derive(Debug, Clone, PartialEq)]
pub enum RunEvent {
    /// The run's folder is open.
    Opened(Box<OpenedRun>),
    /// A setting was changed. The change takes effect with the generation that begins next.
    SettingChanged {
        /// Change of a setting that the run makes with its next generation.
        change: SettingChange,
        /// The plan that includes this change and all earlier ones.
        plan_now: Box<RunPlan>,
    },
    /// A requested change of a setting was not made.
    SettingNotChanged {
        /// Full dotted name of the setting.
        field: String,
        /// Reason, as one line.
        reason: String,
    },
    /// The run's folder cannot be opened, so nothing is evolved. Holds the reason.
    Refused(String),
    /// Results besides champions: sent after a run with finished generations was opened, and before each [`Self::Generation`].
    Explored(Box<Exploration>),
    /// A generation is finished.
    Generation(Box<GenerationReport>),
    /// All generations are finished.
    Finished {
        /// Hash over the whole run.
        run_hash: u64,
    },
    /// The generation could not be saved. Holds the reason. The run is paused; resuming it saves again.
    NotSaved(String),
    /// The simulation of an individual panicked. Holds a line about it. The run continues.
    Crashed(String),
    /// The evaluator reported results that cannot be trusted. Holds the reason as one line. Earlier generations, even saved ones,
    /// may be wrong. No more events follow.
    Untrusted(String),
    /// The run's thread panicked. No more events follow.
    Failed,
}

/// A run whose folder was opened.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenedRun {
    /// Plan with which the run began.
    pub plan_at_start: RunPlan,
    /// Plan with all changes that were made so far.
    pub plan_now: RunPlan,
    /// Reports of the finished generations, the first one first.
    pub reports: Vec<GenerationReport>,
}

/// Results of a run besides its champions.
#[derive(Debug, Clone, PartialEq)]
pub struct Exploration {
    /// Front of the individuals that no other individual beats in both distance and energy.
    pub front: Front,
    /// Archive of elites, if the strategy has one.
    pub archive: Option<Archive>,
    /// Tree of stairs, if stairs evolve.
    pub stairs: Option<Arc<StairsTree>>,
    /// Best individuals of the latest generation, the best first. Empty if an earlier session finished that generation.
    pub leaders: Vec<Champion>,
    /// The latest generation. `None` if an earlier session finished it.
    pub generation: Option<Arc<Generation>>,
    /// Known parents of the next generation, each with its number of children.
    pub parents: Vec<(Arc<Ancestor>, u32)>,
    /// Ancestry of the best individual so far.
    pub ancestry: Ancestry,
}

impl Exploration {
    /// Collects the results of an experiment so far.
    pub fn of(experiment: &Experiment) -> Self {
        Self {
            front: experiment.front().clone(),
            archive: experiment.archive(),
            stairs: experiment.stairs_tree().map(Arc::new),
            leaders: experiment.leaders().to_vec(),
            generation: experiment.generation().cloned(),
            parents: experiment.parents(),
            ancestry: experiment.ancestry(),
        }
    }
}

/// A run on a background thread. Dropping it cancels the run, and waits briefly for files that are being written.
#[derive(Debug)]
pub struct BackgroundRun {
    shared: Arc<BackgroundState>,
    events: Receiver<RunEvent>,
    has_ended: AtomicBool,
}

/// Longest time that dropping a run waits for its thread. Writing a file takes much less.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(2);

/// State that the run's thread shares with its [`BackgroundRun`].
#[derive(Debug)]
struct BackgroundState {
    control: RunControl,
    pause_after_generation: AtomicBool,
    /// Number of individuals in the generation in progress. Some strategies change it.
    population: AtomicU32,
    /// Requested changes of settings: their full dotted names and values.
    requests: Mutex<VecDeque<(String, SettingValue)>>,
    /// Evaluator of the next generation.
    evaluator: Mutex<Arc<dyn Evaluator>>,
}

impl BackgroundState {
    fn requests(&self) -> MutexGuard<'_, VecDeque<(String, SettingValue)>> {
        self.requests.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn evaluator(&self) -> MutexGuard<'_, Arc<dyn Evaluator>> {
        self.evaluator.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl BackgroundRun {
    /// Opens a run and pauses it before its first evaluation: see [`Self::resume`]. Makes the `requests` first, as
    /// [`Self::request_changes`] does, so that more generations continue even a finished run. If `before` is given, cancels that run
    /// and waits on the new thread until it has ended, because it may still use the folder.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(
        source: RunSource,
        evaluator: Arc<dyn Evaluator>,
        requests: impl IntoIterator<Item = (String, SettingValue)>,
        before: Option<Self>,
    ) -> std::io::Result<Self> {
        let shared = Arc::new(BackgroundState {
            control: RunControl::default(),
            pause_after_generation: AtomicBool::new(false),
            population: AtomicU32::new(source.plan.settings.evolution.population),
            requests: Mutex::new(requests.into_iter().collect()),
            evaluator: Mutex::new(evaluator),
        });
        shared.control.pause();
        if let Some(before) = &before {
            before.shared.control.cancel();
        }
        let (sender, events) = unbounded();
        let worker = RunWorker { shared: Arc::clone(&shared), events: sender };
        thread::Builder::new().name("experiment".to_owned()).spawn(move || {
            if let Some(before) = before {
                before.wait_for_end();
            }
            if worker.shared.control.is_cancelled() {
                return;
            }
            match source.open("the studio") {
                Ok(run) => worker.work(run),
                Err(error) => worker.send(RunEvent::Refused(error.to_string())),
            }
        })?;
        Ok(Self { shared, events, has_ended: AtomicBool::new(false) })
    }

    /// Continues the run until it is paused or finished.
    pub fn resume(&self) {
        self.shared.pause_after_generation.store(false, Ordering::SeqCst);
        self.shared.control.resume();
    }

    /// Continues the run to the end of the current generation, then pauses it.
    pub fn run_single_generation(&self) {
        self.shared.pause_after_generation.store(true, Ordering::SeqCst);
        self.shared.control.resume();
    }

    /// Returns whether the run will pause after the current generation.
    pub fn is_single_generation(&self) -> bool {
        self.shared.pause_after_generation.load(Ordering::SeqCst)
    }

    /// Pauses the workers before their next evaluation.
    pub fn pause(&self) {
        self.shared.control.pause();
    }

    /// Requests changes of settings by their full dotted names. They are made before the next generation begins; while the run is
    /// paused between two generations, at once. Each is answered by [`RunEvent::SettingChanged`] or
    /// [`RunEvent::SettingNotChanged`], unless the setting already has the value.
    pub fn request_changes(&self, changes: impl IntoIterator<Item = (String, SettingValue)>) {
        self.shared.requests().extend(changes);
        self.shared.control.wake();
    }

    /// Replaces the evaluator from the next generation on. The results stay the same.
    pub fn set_evaluator(&self, evaluator: Arc<dyn Evaluator>) {
        *self.shared.evaluator() = evaluator;
    }

    /// Returns whether the workers are paused.
    pub fn is_paused(&self) -> bool {
        self.shared.control.is_paused()
    }

    /// Returns the number of finished evaluations of the current generation, and the number of all its evaluations.
    pub fn progress(&self) -> (u32, u32) {
        let population = self.shared.population.load(Ordering::Relaxed);
        // Between two generations, the counter and the size may be read on different sides of the change.
        (self.shared.control.done().min(population), population)
    }

    /// Returns the next event, or `None` if there is none.
    pub fn poll(&self) -> Option<RunEvent> {
        match self.events.try_recv() {
            Ok(event) => {
                let is_last = matches!(
                    event,
                    RunEvent::Finished { .. } | RunEvent::Refused(_) | RunEvent::Untrusted(_)
                );
                self.has_ended.fetch_or(is_last, Ordering::Relaxed);
                Some(event)
            }
            Err(TryRecvError::Empty) => None,
            // The thread has ended. If it sent no last event, it panicked.
            Err(TryRecvError::Disconnected) => {
                (!self.has_ended.swap(true, Ordering::Relaxed)).then_some(RunEvent::Failed)
            }
        }
    }

    /// Blocks until this run, which must be cancelled, has released its folder.
    fn wait_for_end(self) {
        // The thread drops the sending end of the channel last.
        self.events.iter().for_each(drop);
    }
}

impl Drop for BackgroundRun {
    fn drop(&mut self) {
        self.shared.control.cancel();
        let deadline = Instant::now() + SHUTDOWN_TIMEOUT;
        // The channel is disconnected when the thread has ended.
        while self.events.recv_deadline(deadline) != Err(RecvTimeoutError::Disconnected)
            && Instant::now() < deadline
        {}
    }
}

/// State of the run's thread.
struct RunWorker {
    shared: Arc<BackgroundState>,
    events: Sender<RunEvent>,
}

impl RunWorker {
    /// Sends an event. This fails only when the receiver was dropped, which also cancels the run.
    fn send(&self, event: RunEvent) {
        drop(self.events.send(event));
    }

    fn work(&self, run: RecordedRun) {
        let RecordedRun { plan_at_start, mut experiment, mut recorder, reports } = run;
        let control = &self.shared.control;
        let explored =
            |experiment: &Experiment| RunEvent::Explored(Box::new(Exploration::of(experiment)));
        self.shared.population.store(experiment.population(), Ordering::Relaxed);
        let plan_now = experiment.plan_now().into_owned();
        self.send(RunEvent::Opened(Box::new(OpenedRun { plan_at_start, plan_now, reports })));
        if experiment.finished() > 0 {
            self.send(explored(&experiment));
        }
        let mut used: Option<Arc<dyn Evaluator>> = None;
        loop {
            // Requests are served first, because a change can make even a finished run longer.
            self.serve_requests(&mut experiment, &mut recorder);
            if experiment.is_over() {
                break;
            }
            match control.wait_while_paused_unless(|| !self.shared.requests().is_empty()) {
                Ok(true) => {}
                Ok(false) => continue,
                Err(Cancelled) => return,
            }
            let evaluator = Arc::clone(&self.shared.evaluator());
            // The previous evaluator may have found a fault since, while it checked its last results.
            let before = used.replace(Arc::clone(&evaluator));
            let before = before.filter(|before| !Arc::ptr_eq(before, &evaluator));
            if self.reports_fault(before.as_deref()) {
                return;
            }
            let record = |generation, individual, evaluation: &_| {
                recorder.record_evaluation(generation, individual, evaluation);
            };
            let report = experiment.run_generation_recording(&*evaluator, control, record);
            let Ok(report) = report else {
                // An evaluator with a fault cancels its batches by itself.
                if !control.is_cancelled() {
                    self.reports_fault(Some(&*evaluator));
                }
                return;
            };
            let crashes = loop {
                match recorder.record_generation(&experiment, &report) {
                    Ok(crashes) => break crashes,
                    Err(error) => {
                        control.pause();
                        self.send(RunEvent::NotSaved(error.to_string()));
                    }
                }
                if control.wait_while_paused().is_err() {
                    return;
                }
            };
            if self.shared.pause_after_generation.swap(false, Ordering::SeqCst) {
                control.pause();
            }
            crashes.into_iter().for_each(|crash| self.send(RunEvent::Crashed(crash)));
            self.send(explored(&experiment));
            self.send(RunEvent::Generation(Box::new(report)));
        }
        if !self.reports_fault(used.as_deref()) {
            self.send(RunEvent::Finished { run_hash: experiment.run_hash() });
        }
    }

    /// Reports a fault of an evaluator, if it has one. Returns whether it has one.
    fn reports_fault(&self, evaluator: Option<&dyn Evaluator>) -> bool {
        let fault = evaluator.and_then(Evaluator::fault);
        let is_wrong = fault.is_some();
        fault.into_iter().for_each(|reason| self.send(RunEvent::Untrusted(reason)));
        is_wrong
    }

    /// Carries out the requested changes of settings.
    fn serve_requests(&self, experiment: &mut Experiment, recorder: &mut RunRecorder) {
        loop {
            self.show_next_generation(experiment);
            let Some((field, value)) = self.shared.requests().pop_front() else { return };
            let event = match recorder.change_setting(experiment, &field, value) {
                Ok(None) => continue,
                Ok(Some(change)) => {
                    let plan_now = Box::new(experiment.plan_now().into_owned());
                    RunEvent::SettingChanged { change, plan_now }
                }
                Err(error) => RunEvent::SettingNotChanged { field, reason: error.to_string() },
            };
            // The progress is updated before the event is sent, so that the receiver sees the generation that the change affects.
            self.show_next_generation(experiment);
            self.send(event);
        }
    }

    /// Shows the progress of the next generation, of which nothing is done yet. After the last generation, its progress stays.
    fn show_next_generation(&self, experiment: &Experiment) {
        if !experiment.is_over() {
            self.shared.control.set_done(0);
        }
        self.shared.population.store(experiment.population(), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests;
