//! The state of a coordinator: tasks without a result, batches in transit, workers, and checks of their results.
//!
//! The ledger does no input or output. Its methods take events, and return the actions to be carried out.

mod audits;
mod batches;
mod staff;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;
use std::time::Instant;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::hello::WorkerNotice;
use crate::outcome::Outcome;
use crate::wire::{ResultBatch, TaskKind, TaskText, WorkBatch, task_key};
use audits::Audits;
pub use audits::{AuditTask, Checker};
pub use batches::LOST_AFTER;
use staff::Staff;
use staff::Standing;

/// Maximum number of results that are kept although no call has requested them yet. They come from an earlier
/// coordinator.
const MOST_EARLY: usize = 4096;

/// The number of a call of the evaluator.
pub type CallId = u64;

/// An action that the ledger requests.
#[derive(Debug, Clone, PartialEq)]
pub enum LedgerAction {
    /// Publish a batch.
    Publish(WorkBatch),
    /// Remove all batches from the server, also those that are still being published.
    Withdraw,
    /// Report an outcome to a call: the number of the call, the task's index in it, the outcome.
    Deliver(CallId, usize, Outcome),
    /// Compute a task once more, to compare the outcomes.
    Audit(AuditTask),
    /// Print a line for the user.
    Say(String),
    /// A worker sent wrong results after right ones, so that delivered results may be wrong. Holds the message.
    Taint(String),
}

/// A task without a result.
#[derive(Debug)]
struct Pending {
    text: Arc<str>,
    kind: TaskKind,
    shared: u64,
    /// The calls that wait for this task, each with the task's index in the call.
    waiting: Vec<(CallId, usize)>,
    /// Number of batches in transit and of the coordinator's threads that hold this task.
    copies: u8,
}

impl Pending {
    /// Returns the check that computes the task with this key once more.
    fn audit(&self, key: u64, checker: Checker) -> AuditTask {
        let task = TaskText { key, text: Arc::clone(&self.text) };
        AuditTask { kind: self.kind, shared: self.shared, task, checker }
    }
}

/// A batch in transit: published, but without results so far.
#[derive(Debug)]
struct OnItsWay {
    keys: Vec<u64>,
    since: Instant,
}

/// The state of a coordinator: see the module.
#[derive(Debug)]
pub struct Ledger {
    run: String,
    proof: String,
    largest_message: usize,
    tasks: BTreeMap<u64, Pending>,
    /// Keys of the tasks that no batch holds, in order.
    queue: VecDeque<u64>,
    batches: BTreeMap<u64, OnItsWay>,
    next_batch: u64,
    /// Paused calls, whose tasks are held back.
    paused: BTreeSet<CallId>,
    /// The workers.
    pub staff: Staff,
    audits: Audits,
    /// Results that no call has requested yet, by key: the worker's name and the outcome's text.
    early: BTreeMap<u64, (String, Arc<str>)>,
    /// Whether batches were withdrawn and are held back, because workers wait to store results.
    makes_room: bool,
    /// Moving average of the time of an evaluation on a worker, in s. `None` before the first result.
    evaluation_s: Option<f64>,
    /// Number of results that were delivered.
    pub results: u64,
    rng: ChaCha8Rng,
}

impl Ledger {
    /// Creates an empty ledger. `first_batch` separates its batch numbers from those of an earlier coordinator. `rng`
    /// chooses the results that are checked, and cannot change a result.
    pub fn new(
        run: &str,
        proof: &str,
        largest_message: usize,
        first_batch: u64,
        rng: ChaCha8Rng,
    ) -> Self {
        Self {
            run: run.to_owned(),
            proof: proof.to_owned(),
            largest_message,
            tasks: BTreeMap::new(),
            queue: VecDeque::new(),
            batches: BTreeMap::new(),
            next_batch: first_batch,
            paused: BTreeSet::new(),
            staff: Staff::default(),
            audits: Audits::default(),
            early: BTreeMap::new(),
            makes_room: false,
            evaluation_s: None,
            results: 0,
            rng,
        }
    }

    /// Returns the number of tasks without a result.
    pub fn pending(&self) -> usize {
        self.tasks.len()
    }

    /// Returns the number of results that are being checked.
    pub fn audits(&self) -> usize {
        self.audits.len()
    }

    /// Begins a call with these tasks. The index of a task is its position in `texts`.
    pub fn open(
        &mut self,
        call: CallId,
        kind: TaskKind,
        shared: u64,
        texts: Vec<Arc<str>>,
        now: Instant,
    ) -> Vec<LedgerAction> {
        for (index, text) in texts.into_iter().enumerate() {
            let key = task_key(shared, &text);
            if let Some(pending) = self.tasks.get_mut(&key) {
                pending.waiting.push((call, index));
                continue;
            }
            let waiting = vec![(call, index)];
            self.tasks.insert(key, Pending { text, kind, shared, waiting, copies: 0 });
            self.queue.push_back(key);
        }
        let mut actions = Vec::new();
        // Uses results that were computed for an earlier coordinator of this run.
        let early: Vec<u64> =
            self.early.keys().filter(|key| self.tasks.contains_key(key)).copied().collect();
        for key in early {
            if let Some((worker, line)) = self.early.remove(&key) {
                actions.extend(self.take(&worker, vec![TaskText { key, text: line }], now));
                // Such a task needs no batch, unless its worker turns out to be wrong.
                self.queue.retain(|queued| *queued != key);
            }
        }
        actions.extend(self.publish(now));
        actions
    }

    /// Pauses or continues a call.
    pub fn pause(&mut self, call: CallId, is_paused: bool, now: Instant) -> Vec<LedgerAction> {
        match is_paused {
            true => self.paused.insert(call),
            false => self.paused.remove(&call),
        };
        self.publish(now)
    }

    /// Ends a call, even if results are missing.
    pub fn close(&mut self, call: CallId) {
        self.paused.remove(&call);
        for pending in self.tasks.values_mut() {
            pending.waiting.retain(|(of, _)| *of != call);
        }
        self.tasks.retain(|_, pending| !pending.waiting.is_empty());
        let tasks = &self.tasks;
        self.queue.retain(|key| tasks.contains_key(key));
        self.batches.retain(|_, batch| batch.keys.iter().any(|key| tasks.contains_key(key)));
    }

    /// Handles a notice of a worker.
    pub fn on_notice(&mut self, notice: WorkerNotice, now: Instant) -> Vec<LedgerAction> {
        let lines = self.staff.on_notice(notice, &self.proof, now);
        let mut actions: Vec<_> = lines.into_iter().map(LedgerAction::Say).collect();
        actions.extend(self.make_room());
        actions.extend(self.start_first_audits());
        actions.extend(self.publish(now));
        actions
    }

    /// Handles results that arrived.
    pub fn on_results(&mut self, results: ResultBatch, now: Instant) -> Vec<LedgerAction> {
        let batch = self.batches.remove(&results.batch);
        if batch.is_some() {
            let each_s = results.elapsed_s / results.outcomes.len().max(1) as f64;
            let known = self.evaluation_s.unwrap_or(each_s);
            self.evaluation_s = Some(known + (each_s - known) * 0.2);
        }
        let mut actions = self.take(&results.worker, results.outcomes, now);
        self.release(batch.iter().flat_map(|batch| &batch.keys).copied());
        actions.extend(self.publish(now));
        actions
    }

    /// Restarts the silence of all workers, because the server itself could not be heard.
    pub fn excuse_silence(&mut self, now: Instant) {
        self.staff.excuse_silence(now);
    }

    /// Handles the passing of time: sends late batches again, and forgets silent workers.
    pub fn on_tick(&mut self, now: Instant) -> Vec<LedgerAction> {
        let mut actions = Vec::new();
        for (line, keys) in self.staff.forget_silent(now) {
            actions.extend(line.map(LedgerAction::Say));
            keys.into_iter().for_each(|key| self.requeue(key));
        }
        self.make_room();
        for number in self.late_batches(now, LOST_AFTER) {
            if let Some(batch) = self.batches.remove(&number) {
                self.release(batch.keys.into_iter());
            }
        }
        actions.extend(self.start_first_audits());
        actions.extend(self.publish(now));
        actions.extend(self.repeat_late(now));
        actions
    }

    /// Takes a task from the end of the queue for a thread of the coordinator. Returns its key, kind, hash of what it
    /// shares, and text.
    pub fn take_for_local(&mut self) -> Option<(u64, TaskKind, u64, Arc<str>)> {
        let place = self.queue.iter().rposition(|key| !self.is_held(*key))?;
        let key = self.queue.remove(place)?;
        let pending = self.tasks.get_mut(&key)?;
        pending.copies += 1;
        Some((key, pending.kind, pending.shared, Arc::clone(&pending.text)))
    }

    /// Refuses the tasks of a batch that is larger than the server accepts. The coordinator's caller computes them.
    pub fn on_too_large(&mut self, batch: &WorkBatch) -> Vec<LedgerAction> {
        self.batches.remove(&batch.batch);
        let refused = || Outcome::Refused("the task is larger than the server takes".to_owned());
        batch.tasks.iter().flat_map(|task| self.deliver(task.key, refused())).collect()
    }

    /// Takes outcomes from a worker. Those of a proven worker are delivered; those of a new worker are held until it is
    /// proven.
    fn take(&mut self, worker: &str, outcomes: Vec<TaskText>, now: Instant) -> Vec<LedgerAction> {
        let mut actions = Vec::new();
        for outcome in outcomes {
            if !self.tasks.contains_key(&outcome.key) {
                // The task was computed twice, or belongs to an earlier coordinator.
                if self.early.len() < MOST_EARLY && self.results == 0 {
                    self.early.insert(outcome.key, (worker.to_owned(), outcome.text));
                }
                continue;
            }
            match self.staff.standing(worker) {
                Standing::Proven => actions.extend(self.accept(worker, outcome)),
                Standing::New => self.staff.hold(worker, outcome, now),
                // The task was taken from the queue for a batch, and returns there when the batch is released.
                Standing::Foreign | Standing::SetAside => {}
            }
        }
        actions.extend(self.start_first_audits());
        actions
    }

    /// Accepts an outcome of a proven worker, and chooses one in a hundred to be checked.
    fn accept(&mut self, worker: &str, outcome: TaskText) -> Vec<LedgerAction> {
        let Some(pending) = self.tasks.get(&outcome.key) else { return Vec::new() };
        let TaskText { key, text: line } = outcome;
        let read = Outcome::read(&line);
        let read = read.and_then(|read| read.check_kind(pending.kind).map(|()| read));
        let read = match read {
            Ok(read) => read,
            Err(error) => return self.set_aside(worker, &format!("sent {error}")),
        };
        let mut actions = Vec::new();
        if self.rng.random_ratio(1, audits::ONE_IN) {
            let checker = self.staff.other_proven(worker, &mut self.rng);
            let checker = checker.map_or(Checker::Coordinator, Checker::Worker);
            let audit = self.audits.start(pending.audit(key, checker), worker, line);
            actions.extend(audit.map(LedgerAction::Audit));
        }
        self.staff.count_result(worker);
        actions.extend(self.deliver(key, read));
        actions
    }

    /// Reports the outcome of a task to the calls that wait for it.
    pub fn deliver(&mut self, key: u64, outcome: Outcome) -> Vec<LedgerAction> {
        let Some(pending) = self.tasks.remove(&key) else { return Vec::new() };
        self.results += 1;
        self.early.clear();
        let each = pending.waiting.into_iter();
        each.map(|(call, index)| LedgerAction::Deliver(call, index, outcome.clone())).collect()
    }

    /// For each new worker with results, has the coordinator compute one of them again, before any of the worker's
    /// results count.
    fn start_first_audits(&mut self) -> Vec<LedgerAction> {
        let mut actions = Vec::new();
        for (worker, held) in self.staff.to_be_proven(&mut self.rng) {
            let Some(pending) = self.tasks.get(&held.key) else {
                // Another worker delivered this task first.
                self.staff.drop_held(&worker, held.key);
                continue;
            };
            let audit = pending.audit(held.key, Checker::Coordinator);
            // If this task is being checked already, another task of the worker is chosen at one of the next calls.
            if let Some(audit) = self.audits.start(audit, &worker, held.text) {
                self.staff.begin_proof(&worker);
                actions.push(LedgerAction::Audit(audit));
            }
        }
        actions
    }

    /// Handles the answer to a check: the outcome that the checker computed, or `None` if it did not answer.
    pub fn on_audit(
        &mut self,
        key: u64,
        line: Option<Arc<str>>,
        now: Instant,
    ) -> Vec<LedgerAction> {
        use audits::Finding::{Equal, Repeat, Wrong};
        let mut actions = match self.audits.on_answer(key, line) {
            None => Vec::new(),
            Some(Repeat(task)) => vec![LedgerAction::Audit(task)],
            Some(Equal(suspect)) => {
                let held = self.staff.prove(&suspect);
                let accept = |outcome: TaskText| match self.staff.standing(&suspect) {
                    Standing::Proven => self.accept(&suspect, outcome),
                    _ => {
                        self.requeue(outcome.key);
                        Vec::new()
                    }
                };
                held.into_iter().flat_map(accept).collect()
            }
            Some(Wrong(workers)) => {
                let words = "computes other bits than this machine";
                workers.iter().flat_map(|worker| self.set_aside(worker, words)).collect()
            }
        };
        actions.extend(self.start_first_audits());
        actions.extend(self.publish(now));
        actions
    }

    /// Sets a worker aside: its results count from now on for nothing, and its held results are computed again.
    fn set_aside(&mut self, worker: &str, reason: &str) -> Vec<LedgerAction> {
        let Some(member) = self.staff.set_aside(worker) else { return Vec::new() };
        for outcome in &member.held {
            self.requeue(outcome.key);
        }
        let line = format!(
            "worker {worker} on {} {reason}: it is set aside, and its {} results in this run are computed again",
            member.host(),
            member.held.len() as u64 + member.results,
        );
        match member.results {
            0 => vec![LedgerAction::Say(line)],
            _ => vec![LedgerAction::Taint(line)],
        }
    }
}
