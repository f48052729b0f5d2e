//! A coordinator: evaluates on the workers of a server, and optionally on threads of its own.

mod actor;
mod common;
mod ledger;
mod local;
mod traffic;

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::Ordering::SeqCst;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, unbounded};

use super::broker::Broker;
use super::error::ClusterError;
use super::names::check_name;
use super::outcome::Outcome;
use super::wire::{TaskKind, line_of, shared_hash};
use actor::{CoordinatorCommand, run_actor};
pub use common::CoordinatorOptions;
use common::{Common, Status};
use ledger::CallId;
use snakes_core::genome::Genome;
use snakes_core::score::{ExamCondition, ExamEnd, Trial};
use snakes_lab::run::headless::say;
use snakes_lab::run::{Cancelled, EvaluationResult, Evaluator, Job, RunControl, WorkersError};

/// An evaluator that uses the workers of a server.
pub struct Coordinator {
    inner: Arc<Inner>,
    /// Whether this evaluator is used for a single run instead of several at the same time: see
    /// [`Evaluator::with_workers`].
    is_single: bool,
}

struct Inner {
    commands: tokio::sync::mpsc::UnboundedSender<CoordinatorCommand>,
    next_call: AtomicU64,
    /// Whether as many workers as expected were present at some time.
    has_begun: AtomicBool,
    common: Arc<Common>,
    /// The coordinator's thread, and its threads that compute.
    threads: Vec<thread::JoinHandle<()>>,
    options: CoordinatorOptions,
    /// Command-line flags that name the server.
    flags: String,
}

/// Maximum number of calls that one batch of jobs has open at the same time.
const MOST_CALLS: usize = 32;
/// Interval at which a waiting call checks whether it is paused or cancelled.
const CONTROL_INTERVAL: Duration = Duration::from_millis(50);
/// Longest time that the end of a run waits for the checks of its last results.
const LONGEST_CHECK: Duration = Duration::from_secs(60);
/// How long a coordinator waits for workers before it tells the user.
const PATIENCE: Duration = Duration::from_secs(3);

impl Coordinator {
    /// Connects a run to the workers of a server.
    ///
    /// # Errors
    /// The name of the run is not allowed, or the server refuses the run.
    pub fn start(broker: Broker, options: CoordinatorOptions) -> Result<Self, ClusterError> {
        check_name("run", &options.run)?;
        let (commands, received) = tokio::sync::mpsc::unbounded_channel();
        let common = Arc::new(Common::new());
        let flags = broker.flags();
        let broker = Arc::new(broker);
        let actor = actor::Actor::start(
            Arc::clone(&broker),
            &options,
            Arc::clone(&common),
            commands.clone(),
        )?;
        let thread = |name: String| thread::Builder::new().name(name);
        let running = thread("coordinator".to_owned());
        let mut threads = vec![running.spawn(move || run_actor(&broker, actor, received))?];
        for number in 0..options.local_threads {
            let (commands, common) = (commands.clone(), Arc::clone(&common));
            let compute = Arc::clone(&options.compute);
            let local = thread(format!("local-{number}"));
            threads.push(local.spawn(move || local::compute(&commands, &common, &compute))?);
        }
        let inner = Inner {
            commands,
            next_call: AtomicU64::new(1),
            has_begun: AtomicBool::new(false),
            common,
            threads,
            options,
            flags,
        };
        Ok(Self { inner: Arc::new(inner), is_single: false })
    }

    fn status(&self) -> Status {
        self.inner.common.status().clone()
    }

    /// Returns [`Cancelled`] if calls are to be cancelled, because `control` was, or because they have become useless.
    fn check(&self, control: &RunControl) -> Result<(), Cancelled> {
        let Status { taint, refusal, .. } = self.status();
        let is_over = taint.is_some() || (refusal.is_some() && self.inner.options.ends_if_refused);
        if is_over || control.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Tells the user that workers are missing, with the command that starts a worker.
    fn say_that_it_waits(&self, present: &str) {
        say(&format!("{present}; waiting (start one with: snakes worker {})", self.inner.flags));
    }

    /// Waits until as many workers are present as the run expects. If this takes long, tells the user how many are
    /// present.
    ///
    /// # Errors
    /// [`Cancelled`]: see [`Self::check`].
    fn wait_for_workers(&self, control: &RunControl) -> Result<(), Cancelled> {
        let expected = self.inner.options.expect_workers;
        let (began, mut told) = (Instant::now(), None);
        loop {
            control.wait_while_paused()?;
            self.check(control)?;
            let Status { workers, .. } = self.status();
            if workers >= expected {
                return Ok(());
            }
            if told != Some(workers) && began.elapsed() > PATIENCE {
                told = Some(workers);
                self.say_that_it_waits(&format!("{workers} of {expected} workers"));
            }
            thread::sleep(CONTROL_INTERVAL);
        }
    }

    /// Has tasks computed, and calls `report` with the index and the outcome of each. No outcome is reported for tasks
    /// that remain when the coordinator's thread ends.
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
        self.inner.common.texts.keep(hash, shared.into());
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
            self.check(control)?;
            match outcomes.recv_timeout(CONTROL_INTERVAL) {
                Ok((index, outcome)) => {
                    left -= 1;
                    (waits_since, has_said) = (Instant::now(), false);
                    report(index, outcome);
                }
                // The coordinator's thread has ended. The caller of the evaluator computes the remaining tasks.
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
                Err(RecvTimeoutError::Timeout) => {
                    let Status { workers, .. } = self.status();
                    let is_alone = workers == 0 && self.inner.options.local_threads == 0;
                    if is_alone && !is_paused && !has_said && waits_since.elapsed() > PATIENCE {
                        has_said = true;
                        self.say_that_it_waits("no worker is there");
                    }
                }
            }
        }
        Ok(())
    }

    fn send(&self, command: CoordinatorCommand) {
        // Sending fails only after the coordinator's thread has ended, which the caller detects by itself.
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
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

impl Evaluator for Coordinator {
    /// Opens a call for each trial. Several calls are open at the same time, so that workers need not wait for the last
    /// job of a trial.
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
                    let start = |&call| {
                        let named = thread::Builder::new().name("call".to_owned());
                        named.spawn_scoped(scope, move || evaluate(call)).map_err(|_| call)
                    };
                    let running: Vec<_> = calls.iter().map(start).collect();
                    running.into_iter().try_for_each(|call| match call {
                        // A call that panicked may have reported nothing. Its caller then evaluates the missing genomes.
                        Ok(call) => call.join().unwrap_or(Ok(())),
                        // The system refused the call a thread of its own.
                        Err(call) => evaluate(call),
                    })
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
        // With several runs at the same time, workers stay busy while a run chooses its champion.
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
        // Checks of the last results may still be in progress.
        let began = Instant::now();
        loop {
            let Status { taint, audits, refusal, .. } = self.status();
            if taint.is_some()
                || refusal.is_some()
                || audits == 0
                || began.elapsed() > LONGEST_CHECK
            {
                return taint;
            }
            thread::sleep(CONTROL_INTERVAL);
        }
    }

    fn refusal(&self) -> Option<String> {
        self.status().refusal
    }
}
