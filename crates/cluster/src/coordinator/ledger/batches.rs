//! Batches: their size, when they are published, and when they are late.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::{CallId, Ledger, LedgerAction, OnItsWay};
use crate::wire::{MOST_TASKS, TaskText, WorkBatch};

/// Time that a batch should take on a worker.
const BATCH_TIME: Duration = Duration::from_millis(500);
/// Batches in transit for each thread of the workers: one in progress and one that waits.
const BATCHES_PER_THREAD: usize = 2;
/// A batch without results for this long is late, if its expected time times `LATE_FACTOR` has passed, too.
const LATE_AFTER: Duration = Duration::from_secs(2);
/// A batch is late only after its expected time multiplied by this factor.
const LATE_FACTOR: f64 = 3.0;
/// A batch without results for this long is given up and its tasks are queued again, because the server may have lost
/// it.
pub const LOST_AFTER: Duration = Duration::from_secs(30);
/// Maximum number of batches that hold the same task.
const MOST_COPIES: u8 = 3;
/// Size of the head of a message besides its keys, in bytes, at most.
const HEAD_SIZE: usize = 300;
/// Size of a task's key in the head of a message, in bytes.
const KEY_SIZE: usize = 20;

impl Ledger {
    pub(super) fn is_held(&self, key: u64) -> bool {
        let Some(pending) = self.tasks.get(&key) else { return true };
        let is_paused = |(call, _): &(CallId, usize)| self.paused.contains(call);
        pending.waiting.iter().all(is_paused)
    }

    /// Releases tasks from a batch that has ended, and queues those without a result again.
    pub(super) fn release(&mut self, keys: impl Iterator<Item = u64>) {
        for key in keys {
            if let Some(pending) = self.tasks.get_mut(&key) {
                pending.copies = pending.copies.saturating_sub(1);
                self.requeue(key);
            }
        }
    }

    /// Puts a task without a result back into the queue, unless a batch holds it or its result is held.
    pub(super) fn requeue(&mut self, key: u64) {
        let is_free = self.tasks.get(&key).is_some_and(|pending| pending.copies == 0);
        if is_free && !self.staff.holds(key) && !self.queue.contains(&key) {
            self.queue.push_front(key);
        }
    }

    /// Sends all batches in transit again, because the server has lost its store.
    pub fn on_store_lost(&mut self, now: Instant) -> Vec<LedgerAction> {
        let lost = self.release_all();
        let line = format!("the server has lost what it stored: {lost} batches are sent again");
        let mut actions = vec![LedgerAction::Say(line)];
        actions.extend(self.publish(now));
        actions
    }

    /// Releases all batches, and returns how many there were.
    fn release_all(&mut self) -> usize {
        let all = std::mem::take(&mut self.batches);
        let count = all.len();
        // Each task goes to the front of the queue, so the last one is released first.
        self.release(all.into_values().rev().flat_map(|batch| batch.keys.into_iter().rev()));
        count
    }

    /// Withdraws all batches when a worker begins to wait for its server, and holds them back until none waits. Otherwise
    /// batches could fill the server's store, and leave the results no room for ever.
    pub(super) fn make_room(&mut self) -> Option<LedgerAction> {
        let made_room = std::mem::replace(&mut self.makes_room, self.staff.has_waiting());
        let begins = self.makes_room && !made_room;
        begins.then(|| {
            self.release_all();
            LedgerAction::Withdraw
        })
    }

    /// Publishes batches while the workers have capacity for them.
    pub(super) fn publish(&mut self, now: Instant) -> Vec<LedgerAction> {
        let threads = if self.makes_room { 0 } else { self.staff.threads() };
        let mut actions = Vec::new();
        while self.batches.len() < threads * BATCHES_PER_THREAD {
            let keys = self.next_keys(threads);
            let Some(batch) = self.batch_of(keys, now) else { break };
            actions.push(LedgerAction::Publish(batch));
        }
        actions
    }

    /// Chooses the tasks of the next batch: as many as take half a second, and fewer towards the end of the queue, so
    /// that all workers finish at about the same time.
    fn next_keys(&mut self, threads: usize) -> Vec<u64> {
        let in_time = BATCH_TIME.as_secs_f64() / self.evaluation_s.unwrap_or(1.0).max(1e-6);
        let share = self.queue.len().div_ceil(BATCHES_PER_THREAD * threads.max(1));
        let most = (in_time as usize).min(share).clamp(1, MOST_TASKS);
        let (mut keys, mut bytes, mut at) = (Vec::new(), 0, 0);
        let mut group = None;
        while keys.len() < most && at < self.queue.len() {
            let key = self.queue[at];
            let Some(pending) = self.tasks.get(&key) else {
                self.queue.remove(at);
                continue;
            };
            let of = (pending.kind, pending.shared);
            let size = pending.text.len() + KEY_SIZE;
            let fits = keys.is_empty() || bytes + size + HEAD_SIZE < self.largest_message;
            if self.is_held(key) || *group.get_or_insert(of) != of || !fits {
                at += 1;
                continue;
            }
            bytes += size;
            keys.push(key);
            self.queue.remove(at);
        }
        keys
    }

    /// Makes a batch of these tasks and counts it as in transit. Returns `None` if there is no task.
    fn batch_of(&mut self, keys: Vec<u64>, now: Instant) -> Option<WorkBatch> {
        let first = self.tasks.get(keys.first()?)?;
        let (kind, shared) = (first.kind, first.shared);
        let mut tasks = Vec::with_capacity(keys.len());
        for key in &keys {
            let pending = self.tasks.get_mut(key)?;
            pending.copies += 1;
            tasks.push(TaskText { key: *key, text: Arc::clone(&pending.text) });
        }
        let number = self.next_batch;
        self.next_batch += 1;
        self.batches.insert(number, OnItsWay { keys, since: now });
        Some(WorkBatch { run: self.run.clone(), batch: number, kind, shared, tasks })
    }

    /// Sends tasks of late batches once more if the queue is empty, because their workers may be slow, frozen or gone.
    pub(super) fn repeat_late(&mut self, now: Instant) -> Vec<LedgerAction> {
        let (threads, mut actions) = (self.staff.threads(), Vec::new());
        for number in self.late_batches(now, LATE_AFTER) {
            let keys = self.batches.get(&number).map_or_else(Vec::new, |batch| batch.keys.clone());
            for key in keys {
                let may_repeat = self.tasks.get(&key).is_some_and(|of| of.copies < MOST_COPIES)
                    && !self.staff.holds(key);
                if self.queue.is_empty() && may_repeat && self.batches.len() < threads {
                    actions.extend(self.batch_of(vec![key], now).map(LedgerAction::Publish));
                }
            }
        }
        actions
    }

    /// Returns the expected time of a batch with this number of tasks.
    fn expected(&self, tasks: usize) -> Duration {
        Duration::from_secs_f64(self.evaluation_s.unwrap_or(1.0) * tasks as f64)
    }

    pub(super) fn late_batches(&self, now: Instant, after: Duration) -> Vec<u64> {
        let is_late = |batch: &OnItsWay| {
            let expected = self.expected(batch.keys.len()).mul_f64(LATE_FACTOR);
            now.duration_since(batch.since) > after.max(expected)
        };
        self.batches.iter().filter(|(_, batch)| is_late(batch)).map(|(number, _)| *number).collect()
    }
}
