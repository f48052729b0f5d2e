//! The state of a coordinator: tasks without a result, batches on their way, workers, and checks of their results.
//!
//! The ledger does no input and no output. It is told what happened, and says what is to be done.

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
use batches::LOST_AFTER;
use staff::Staff;
use staff::Standing;

/// Maximum number of results that were made for a predecessor and are kept until they are asked for.
const MOST_EARLY: usize = 4096;

/// The number of a call of the evaluator.
pub type CallId = u64;

/// A step that the ledger asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum LedgerAction {
    /// Publish a batch.
    Publish(WorkBatch),
    /// Give an outcome to a call: its index there.
    Deliver(CallId, usize, Outcome),
    /// Compute a task once more, to compare.
    Audit(AuditTask),
    /// Tell the user.
    Say(String),
    /// A worker sent wrong results after right ones: what was delivered earlier may be wrong.
    Taint(String),
}

/// A task without a result.
#[derive(Debug)]
struct Pending {
    text: Arc<str>,
    kind: TaskKind,
    shared: u64,
    /// The calls that wait for it, with their indices.
    waiting: Vec<(CallId, usize)>,
    /// Number of batches on their way that hold it.
    copies: u8,
}

impl Pending {
    /// The order to compute the task with this key once more.
    fn audit(&self, key: u64, checker: Checker) -> AuditTask {
        let task = TaskText { key, text: Arc::clone(&self.text) };
        AuditTask { kind: self.kind, shared: self.shared, task, checker }
    }
}

/// A batch on its way.
#[derive(Debug)]
struct OnItsWay {
    keys: Vec<u64>,
    since: Instant,
}

/// See the module.
#[derive(Debug)]
pub struct Ledger {
    run: String,
    proof: String,
    largest_message: usize,
    tasks: BTreeMap<u64, Pending>,
    /// Tasks that no batch holds, in order.
    queue: VecDeque<u64>,
    batches: BTreeMap<u64, OnItsWay>,
    next_batch: u64,
    /// The calls that hold their tasks back.
    paused: BTreeSet<CallId>,
    staff: Staff,
    audits: Audits,
    /// Results that no call has asked for yet.
    early: BTreeMap<u64, (String, Arc<str>)>,
    /// Mean time of an evaluation on a worker, in s; none before the first result.
    evaluation_s: Option<f64>,
    results: u64,
    rng: ChaCha8Rng,
}

impl Ledger {
    /// An empty ledger. `first_batch` keeps the numbers of batches apart from those of a predecessor, and `rng` chooses
    /// the results that are checked: it cannot change a result.
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
            evaluation_s: None,
            results: 0,
            rng,
        }
    }

    /// Number of tasks without a result.
    pub fn pending(&self) -> usize {
        self.tasks.len()
    }

    /// Number of results that were delivered.
    pub fn results(&self) -> u64 {
        self.results
    }

    /// Number of results that are being checked.
    pub fn audits(&self) -> usize {
        self.audits.len()
    }

    /// The workers.
    pub fn staff(&self) -> &Staff {
        &self.staff
    }

    /// A call begins: its tasks, whose index is their place in `texts`.
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
        // Results that were made for a coordinator that was killed.
        let early: Vec<u64> =
            self.early.keys().filter(|key| self.tasks.contains_key(key)).copied().collect();
        for key in early {
            if let Some((worker, line)) = self.early.remove(&key) {
                actions.extend(self.take(&worker, vec![TaskText { key, text: line }], now));
                // No batch is needed for it, unless its worker turns out to be wrong.
                self.queue.retain(|queued| *queued != key);
            }
        }
        actions.extend(self.publish(now));
        actions
    }

    /// A call holds or continues.
    pub fn pause(&mut self, call: CallId, is_paused: bool, now: Instant) -> Vec<LedgerAction> {
        match is_paused {
            true => self.paused.insert(call),
            false => self.paused.remove(&call),
        };
        self.publish(now)
    }

    /// A call ends, also before it has all its results.
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

    /// A worker told of itself.
    pub fn on_notice(&mut self, notice: WorkerNotice, now: Instant) -> Vec<LedgerAction> {
        let lines = self.staff.on_notice(notice, &self.proof, now);
        let mut actions: Vec<_> = lines.into_iter().map(LedgerAction::Say).collect();
        actions.extend(self.start_first_audits());
        actions.extend(self.publish(now));
        actions
    }

    /// Results arrived.
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

    /// The server has lost what it stored: the batches on their way are sent again.
    pub fn on_store_lost(&mut self, now: Instant) -> Vec<LedgerAction> {
        let lost = std::mem::take(&mut self.batches);
        let line =
            format!("the server has lost what it stored: {} batches are sent again", lost.len());
        // Each is put in front of the others.
        self.release(lost.into_values().rev().flat_map(|batch| batch.keys.into_iter().rev()));
        let mut actions = vec![LedgerAction::Say(line)];
        actions.extend(self.publish(now));
        actions
    }

    /// No worker could be heard until now.
    pub fn excuse_silence(&mut self, now: Instant) {
        self.staff.excuse_silence(now);
    }

    /// Time passed: late batches are sent again, silent workers forgotten.
    pub fn on_tick(&mut self, now: Instant) -> Vec<LedgerAction> {
        let mut actions = Vec::new();
        for (line, keys) in self.staff.forget_silent(now) {
            actions.extend(line.map(LedgerAction::Say));
            keys.into_iter().for_each(|key| self.requeue(key));
        }
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

    /// A thread of the coordinator is free: a task for it.
    pub fn take_for_local(&mut self) -> Option<(u64, TaskKind, u64, Arc<str>)> {
        let place = self.queue.iter().rposition(|key| !self.is_held(*key))?;
        let key = self.queue.remove(place)?;
        let pending = self.tasks.get_mut(&key)?;
        pending.copies += 1;
        Some((key, pending.kind, pending.shared, Arc::clone(&pending.text)))
    }

    /// A batch is larger than the server takes: its tasks stay for the coordinator.
    pub fn on_too_large(&mut self, batch: &WorkBatch) -> Vec<LedgerAction> {
        self.batches.remove(&batch.batch);
        let refused = || Outcome::Refused("the task is larger than the server takes".to_owned());
        batch.tasks.iter().flat_map(|task| self.deliver(task.key, refused())).collect()
    }

    /// Takes outcomes of a worker: holds them until it is proven, delivers them if it is.
    fn take(&mut self, worker: &str, outcomes: Vec<TaskText>, now: Instant) -> Vec<LedgerAction> {
        let mut actions = Vec::new();
        for outcome in outcomes {
            if !self.tasks.contains_key(&outcome.key) {
                // Computed twice, or asked for by a predecessor.
                if self.early.len() < MOST_EARLY && self.results == 0 {
                    self.early.insert(outcome.key, (worker.to_owned(), outcome.text));
                }
                continue;
            }
            match self.staff.standing(worker) {
                Standing::Proven => actions.extend(self.accept(worker, outcome)),
                Standing::New => self.staff.hold(worker, outcome, now),
                // Its batch was taken from the queue, and returns there.
                Standing::Foreign | Standing::SetAside => {}
            }
        }
        actions.extend(self.start_first_audits());
        actions
    }

    /// Accepts an outcome of a proven worker, and chooses one in a hundred for a check.
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

    /// Gives the outcome of a task to the calls that wait for it.
    pub fn deliver(&mut self, key: u64, outcome: Outcome) -> Vec<LedgerAction> {
        let Some(pending) = self.tasks.remove(&key) else { return Vec::new() };
        self.results += 1;
        self.early.clear();
        let each = pending.waiting.into_iter();
        each.map(|(call, index)| LedgerAction::Deliver(call, index, outcome.clone())).collect()
    }

    /// The first result of a worker that has not been checked is computed once more here, before any of them counts.
    fn start_first_audits(&mut self) -> Vec<LedgerAction> {
        let mut actions = Vec::new();
        for (worker, held) in self.staff.to_be_proven(&mut self.rng) {
            let Some(pending) = self.tasks.get(&held.key) else {
                // Another worker was faster.
                self.staff.drop_held(&worker, held.key);
                continue;
            };
            let audit = pending.audit(held.key, Checker::Coordinator);
            // If this task is being checked already, another one will be, soon.
            if let Some(audit) = self.audits.start(audit, &worker, held.text) {
                self.staff.begin_proof(&worker);
                actions.push(LedgerAction::Audit(audit));
            }
        }
        actions
    }

    /// The answer to an audit: the outcome that the checker computed, none if it did not answer.
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

    /// Sets a worker aside: nothing that it sends counts any more, and what is held of it is computed again.
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
