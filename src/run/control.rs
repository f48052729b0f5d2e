//! How the outside steers workers: progress out, pause and cancel in.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// A run was cancelled before its generation was finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Shared between the workers of a run and whoever watches it.
///
/// Workers pass a gate before each evaluation. Pausing and cancelling therefore take effect within
/// one evaluation (some milliseconds with the shipped presets), and cannot change a result: they decide
/// when an evaluation happens, not what it is.
#[derive(Debug, Default)]
pub struct Control {
    done: AtomicU32,
    gate: Mutex<Gate>,
    gate_moved: Condvar,
}

#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
enum Gate {
    #[default]
    Open,
    Paused,
    Cancelled,
}

impl Control {
    /// Evaluations of the current generation that are finished.
    pub fn done(&self) -> u32 {
        self.done.load(Ordering::Relaxed)
    }

    /// Lets the workers go on, unless the run is cancelled.
    pub fn resume(&self) {
        self.move_gate(Gate::Open);
    }

    /// Holds the workers before their next evaluation.
    pub fn pause(&self) {
        self.move_gate(Gate::Paused);
    }

    /// Whether the workers are held.
    pub fn is_paused(&self) -> bool {
        *self.gate() == Gate::Paused
    }

    /// Ends the run, for good.
    pub fn cancel(&self) {
        self.move_gate(Gate::Cancelled);
    }

    /// Whether the run was ended.
    pub(super) fn is_cancelled(&self) -> bool {
        *self.gate() == Gate::Cancelled
    }

    /// Waits while paused; then whether to go on.
    pub(super) fn pass(&self) -> Result<(), Cancelled> {
        let held = self.gate_moved.wait_while(self.gate(), |gate| *gate == Gate::Paused);
        match *held.unwrap_or_else(PoisonError::into_inner) {
            Gate::Cancelled => Err(Cancelled),
            Gate::Open | Gate::Paused => Ok(()),
        }
    }

    /// Waits while paused, until `is_wanted` for something else; then whether to go on, or to do that first. Whoever
    /// wants something calls [`Self::nudge`] after it has said so.
    pub(super) fn pass_unless(&self, is_wanted: impl Fn() -> bool) -> Result<bool, Cancelled> {
        let waits = |gate: &mut Gate| *gate == Gate::Paused && !is_wanted();
        let held = self.gate_moved.wait_while(self.gate(), waits);
        match *held.unwrap_or_else(PoisonError::into_inner) {
            Gate::Cancelled => Err(Cancelled),
            Gate::Open | Gate::Paused => Ok(!is_wanted()),
        }
    }

    /// Lets who waits look whether something is wanted.
    pub(super) fn nudge(&self) {
        // Between its look and its wait nobody else has the lock: no nudge is lost.
        drop(self.gate());
        self.gate_moved.notify_all();
    }

    pub(super) fn start_generation(&self) {
        self.done.store(0, Ordering::Relaxed);
    }

    pub(super) fn count_one(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    fn move_gate(&self, to: Gate) {
        let mut gate = self.gate();
        if *gate != Gate::Cancelled {
            *gate = to;
        }
        drop(gate);
        self.gate_moved.notify_all();
    }

    /// A panic elsewhere cannot leave a `Copy` value half-changed, so poison is no concern.
    fn gate(&self) -> MutexGuard<'_, Gate> {
        self.gate.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::mpsc;
    use std::time::Duration;

    #[test]
    fn a_paused_worker_waits_until_it_is_resumed() {
        let control = Arc::new(Control::default());
        control.pause();
        let (passed, result) = mpsc::channel();
        let worker = Arc::clone(&control);
        std::thread::spawn(move || passed.send(worker.pass()));
        assert!(result.recv_timeout(Duration::from_millis(50)).is_err(), "still held");
        control.resume();
        assert_eq!(result.recv_timeout(Duration::from_secs(10)), Ok(Ok(())));
    }

    #[test]
    fn cancelling_frees_a_paused_worker_and_lasts() {
        let control = Control::default();
        control.pause();
        control.cancel();
        control.resume();
        assert_eq!(control.pass(), Err(Cancelled));
    }
}
