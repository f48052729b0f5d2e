//! A coordinator: evaluates on the workers of a server, and on threads of its own if it is told to.

mod actor;
mod ledger;
mod local;
mod traffic;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::atomic::Ordering::SeqCst;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, unbounded};

use super::broker::Broker;
use super::compute::Compute;
use super::error::ClusterError;
use super::names::check_name;
use super::outcome::Outcome;
use super::wire::{TaskKind, line_of, shared_hash};
use actor::{CoordinatorCommand, run_actor};
use ledger::CallId;
use snakes_core::genome::Genome;
use snakes_core::score::{ExamCondition, ExamEnd, Trial};
use snakes_lab::run::headless::say;
use snakes_lab::run::{Cancelled, EvaluationResult, Evaluator, Job, RunControl, WorkersError};

/// How a coordinator works.
#[derive(Debug, Clone)]
pub struct CoordinatorOptions {
    /// The name of its run: letters, digits and hyphens. The same run has the same name when it is continued.
    pub run: String,
    /// The proof of its engine: see [`super::proof`].
    pub proof: String,
    /// Number of workers that it waits for before it begins.
    pub expect_workers: usize,
    /// Number of its own threads that compute, too.
    pub local_threads: usize,
    /// Computes outcomes on this computer.
    pub compute: Arc<dyn Compute>,
}

/// Evaluates on the workers of a server.
pub struct Coordinator {
    inner: Arc<Inner>,
    /// Whether this evaluator makes one run of several: see [`Evaluator::with_workers`].
    is_single: bool,
}

struct Inner {
    commands: tokio::sync::mpsc::UnboundedSender<CoordinatorCommand>,
    next_call: AtomicU64,
    /// Whether as many workers as expected have been there.
    has_begun: AtomicBool,
    status: Arc<Mutex<Status>>,
    shared: Arc<SharedTexts>,
    actor: Mutex<Option<thread::JoinHandle<()>>>,
    local: Mutex<Vec<thread::JoinHandle<()>>>,
    options: CoordinatorOptions,
    /// The command that starts a worker.
    worker_command: String,
    /// The flags that name the server.
    flags: String,
}

/// State of the coordinator, for the calls that wait.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Status {
    workers: usize,
    threads: usize,
    /// Number of results that are being checked.
    audits: usize,
    /// Why earlier results cannot be trusted any more.
    taint: Option<String>,
}

/// Texts that tasks share, by hash: the latest ones.
#[derive(Debug, Default)]
pub struct SharedTexts(Mutex<BTreeMap<u64, (u64, Arc<str>)>>);

/// Maximum number of texts that are kept after the calls that used them.
const MOST_SHARED: usize = 256;
/// Maximum number of calls of one batch at the same time.
const MOST_CALLS: usize = 32;
/// Interval at which a waiting call looks at its control.
const CONTROL_INTERVAL: Duration = Duration::from_millis(50);
/// How long the end of a run waits for checks of its last results.
const LONGEST_CHECK: Duration = Duration::from_secs(60);
/// How long a coordinator waits for workers before it says so.
const PATIENCE: Duration = Duration::from_secs(3);

impl SharedTexts {
    /// Keeps a text; `number` grows with each call.
    fn keep(&self, hash: u64, number: u64, text: Arc<str>) {
        let mut texts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        texts.insert(hash, (number, text));
        if texts.len() > MOST_SHARED {
            let oldest = texts.iter().min_by_key(|(_, (number, _))| *number);
            if let Some(oldest) = oldest.map(|(hash, _)| *hash) {
                texts.remove(&oldest);
            }
        }
    }

    /// The text with this hash.
    pub fn get(&self, hash: u64) -> Option<Arc<str>> {
        let texts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        texts.get(&hash).map(|(_, text)| Arc::clone(text))
    }
}

impl Coordinator {
    /// Connects the run with the workers on a server.
    ///
    /// # Errors
    /// The name of the run is not allowed, or the server refuses the run.
    pub fn start(broker: Broker, options: CoordinatorOptions) -> Result<Self, ClusterError> {
        check_name("run", &options.run)?;
        let (commands, received) = tokio::sync::mpsc::unbounded_channel();
        let status = Arc::new(Mutex::new(Status::default()));
        let shared = Arc::new(SharedTexts::default());
        let (worker_command, flags) = (broker.worker_command(), broker.flags());
        let broker = Arc::new(broker);
        let actor = actor::Actor::start(
            Arc::clone(&broker),
            &options,
            Arc::clone(&shared),
            Arc::clone(&status),
            commands.clone(),
        )?;
        let running = thread::Builder::new()
            .name("coordinator".to_owned())
            .spawn(move || run_actor(&broker, actor, received))?;
        let mut local = Vec::new();
        for number in 0..options.local_threads {
            let (commands, shared) = (commands.clone(), Arc::clone(&shared));
            let compute = Arc::clone(&options.compute);
            let name = format!("local-{number}");
            let thread = thread::Builder::new().name(name);
            local.push(thread.spawn(move || local::compute(&commands, &shared, &compute))?);
        }
        let inner = Inner {
            commands,
            next_call: AtomicU64::new(1),
            has_begun: AtomicBool::new(false),
            status,
            shared,
            actor: Mutex::new(Some(running)),
            local: Mutex::new(local),
            options,
            worker_command,
            flags,
        };
        Ok(Self { inner: Arc::new(inner), is_single: false })
    }

    fn status(&self) -> Status {
        self.inner.status.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Waits until there are as many workers as the run expects. Says how many there are, if that takes long.
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was.
    fn wait_for_workers(&self, control: &RunControl) -> Result<(), Cancelled> {
        let expected = self.inner.options.expect_workers;
        let (began, mut told) = (Instant::now(), None);
        loop {
            control.wait_while_paused()?;
            let Status { workers, .. } = self.status();
            if workers >= expected {
                return Ok(());
            }
            if told != Some(workers) && began.elapsed() > PATIENCE {
                told = Some(workers);
                say(&format!(
                    "{workers} of {expected} workers; waiting (start one with: {})",
                    self.inner.worker_command
                ));
            }
            thread::sleep(CONTROL_INTERVAL);
        }
    }

    /// Has tasks computed, and calls `report` with the index and the outcome of each. One that no worker can compute is
    /// left out.
    fn call(
        &self,
        kind: TaskKind,
        shared: String,
        tasks: Vec<String>,
        control: &RunControl,
        report: &dyn Fn(usize, Outcome),
    ) -> Result<(), Cancelled> {
        let left = tasks.len();
        if left == 0 {
            return Ok(());
        }
        if !self.inner.has_begun.load(SeqCst) {
            self.wait_for_workers(control)?;
            self.inner.has_begun.store(true, SeqCst);
        }
        let number = self.inner.next_call.fetch_add(1, SeqCst);
        let hash = shared_hash(kind, &shared);
        self.inner.shared.keep(hash, number, shared.into());
        let (sender, outcomes) = unbounded();
        let tasks = tasks.into_iter().map(Into::into).collect();
        self.send(CoordinatorCommand::Open { call: number, kind, shared: hash, tasks, sender });
        let result = self.collect(number, left, &outcomes, control, report);
        self.send(CoordinatorCommand::Close(number));
        result
    }

    fn collect(
        &self,
        call: CallId,
        mut left: usize,
        outcomes: &Receiver<(usize, Outcome)>,
        control: &RunControl,
        report: &dyn Fn(usize, Outcome),
    ) -> Result<(), Cancelled> {
        let (mut is_paused, mut waits_since) = (false, Instant::now());
        let mut has_said = false;
        while left > 0 {
            if control.is_paused() != is_paused {
                is_paused = control.is_paused();
                self.send(CoordinatorCommand::Pause(call, is_paused));
            }
            if control.is_cancelled() || self.status().taint.is_some() {
                return Err(Cancelled);
            }
            match outcomes.recv_timeout(CONTROL_INTERVAL) {
                Ok((index, outcome)) => {
                    left -= 1;
                    (waits_since, has_said) = (Instant::now(), false);
                    report(index, outcome);
                }
                // The coordinator's thread has ended: its caller computes the rest.
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
                Err(RecvTimeoutError::Timeout) => {
                    let Status { workers, .. } = self.status();
                    let is_alone = workers == 0 && self.inner.options.local_threads == 0;
                    if is_alone && !is_paused && !has_said && waits_since.elapsed() > PATIENCE {
                        has_said = true;
                        say(&format!(
                            "no worker is there; waiting (start one with: {})",
                            self.inner.worker_command
                        ));
                    }
                }
            }
        }
        Ok(())
    }

    fn send(&self, command: CoordinatorCommand) {
        // It fails only after the coordinator's thread has ended, which the caller notices by itself.
        let _ = self.inner.commands.send(command);
    }
}

impl fmt::Debug for Coordinator {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Coordinator").field("options", &self.inner.options).finish()
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        let _ = self.commands.send(CoordinatorCommand::End);
        let actor = self.actor.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        let local = std::mem::take(self.local.get_mut().unwrap_or_else(PoisonError::into_inner));
        for thread in actor.into_iter().chain(local) {
            let _ = thread.join();
        }
    }
}

impl Evaluator for Coordinator {
    /// Opens a call for each trial, several at the same time, so that workers need not wait for the last job of a trial.
    fn evaluate_jobs(
        &self,
        trials: &[Trial],
        jobs: &[Job<'_>],
        control: &RunControl,
        report: &(dyn Fn(usize, EvaluationResult) + Sync),
    ) -> Result<(), Cancelled> {
        let mut of_trial: Vec<Vec<usize>> = vec![Vec::new(); trials.len()];
        for (index, job) in jobs.iter().enumerate() {
            of_trial[job.trial].push(index);
        }
        let evaluate = |(trial, indices): (&Trial, &Vec<usize>)| {
            let tasks = indices.iter().map(|&index| line_of(jobs[index].genome)).collect();
            self.call(TaskKind::Score, line_of(trial), tasks, control, &|task, outcome| {
                if let (Some(&index), Outcome::Scored(result)) = (indices.get(task), outcome) {
                    report(index, result);
                }
            })
        };
        let calls: Vec<_> = trials.iter().zip(&of_trial).collect();
        for calls in calls.chunks(MOST_CALLS) {
            match calls {
                &[call] => evaluate(call)?,
                calls => thread::scope(|scope| {
                    let running: Vec<_> =
                        calls.iter().map(|&call| scope.spawn(move || evaluate(call))).collect();
                    // A call that panicked has reported nothing, and its genomes are evaluated by the caller.
                    running.into_iter().try_for_each(|call| call.join().unwrap_or(Ok(())))
                })?,
            }
        }
        Ok(())
    }

    fn examine_batch(
        &self,
        genome: &Genome,
        conditions: &[ExamCondition],
        control: &RunControl,
        report: &(dyn Fn(usize, ExamEnd) + Sync),
    ) -> Result<(), Cancelled> {
        let tasks = conditions.iter().map(line_of).collect();
        self.call(TaskKind::Examine, line_of(genome), tasks, control, &|index, outcome| {
            if let Outcome::Examined(end) = outcome {
                report(index, end);
            }
        })
    }

    fn workers(&self) -> usize {
        let threads = self.status().threads + self.inner.options.local_threads;
        // Several runs at the same time: while one chooses its champion, the others use the workers.
        if self.is_single { 1 } else { (2 * threads).clamp(4, 64) }
    }

    fn with_workers(&self, workers: usize) -> Result<Arc<dyn Evaluator>, WorkersError> {
        Ok(Arc::new(Self { inner: Arc::clone(&self.inner), is_single: workers == 1 }))
    }

    fn place(&self) -> String {
        match self.inner.options.local_threads {
            0 => "on other computers".to_owned(),
            1 => "on other computers and 1 thread here".to_owned(),
            threads => format!("on other computers and {threads} threads here"),
        }
    }

    fn flags(&self) -> String {
        let local = match self.inner.options.local_threads {
            0 => String::new(),
            threads => format!(" --local-threads {threads}"),
        };
        format!(" {}{local}", self.inner.flags)
    }

    fn fault(&self) -> Option<String> {
        // The last results may still be being checked.
        let began = Instant::now();
        loop {
            let Status { taint, audits, .. } = self.status();
            if taint.is_some() || audits == 0 || began.elapsed() > LONGEST_CHECK {
                return taint;
            }
            thread::sleep(CONTROL_INTERVAL);
        }
    }
}
