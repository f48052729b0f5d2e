//! Pauses and cancels work on other threads, such as the evaluations of a run, and counts its progress.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Error when work was cancelled before it was finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Control of work in the background, such as a run, which its workers share with the user interface.
///
/// Workers of a run pass a gate before each evaluation. Pausing and cancelling therefore take effect within
/// one evaluation (some milliseconds with the shipped presets), and cannot change a result: they decide
/// when an evaluation happens, not its value.
#[derive(Debug, Default)]
pub struct RunControl {
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

impl RunControl {
    /// Returns the number of finished items. For a run, these are the evaluations of the current generation.
    pub fn done(&self) -> u32 {
        self.done.load(Ordering::Relaxed)
    }

    /// Lets the workers continue, unless the work was cancelled.
    pub fn resume(&self) {
        self.move_gate(Gate::Open);
    }

    /// Pauses the workers before their next evaluation.
    pub fn pause(&self) {
        self.move_gate(Gate::Paused);
    }

    /// Returns whether the workers are paused.
    pub fn is_paused(&self) -> bool {
        *self.gate() == Gate::Paused
    }

    /// Cancels the work permanently.
    pub fn cancel(&self) {
        self.move_gate(Gate::Cancelled);
    }

    /// Returns whether the work was cancelled.
    pub fn is_cancelled(&self) -> bool {
        *self.gate() == Gate::Cancelled
    }

    /// Blocks while the work is paused.
    ///
    /// # Errors
    /// [`Cancelled`], if the work was cancelled.
    pub fn wait_while_paused(&self) -> Result<(), Cancelled> {
        self.wait_while_paused_unless(|| false).map(drop)
    }

    /// Blocks while the work is paused and `has_request` is false. Returns whether to continue (`true`) or to serve a request
    /// first. After making a request, call [`Self::wake`].
    pub(super) fn wait_while_paused_unless(
        &self,
        has_request: impl Fn() -> bool,
    ) -> Result<bool, Cancelled> {
        let waits = |gate: &mut Gate| *gate == Gate::Paused && !has_request();
        let held = self.gate_moved.wait_while(self.gate(), waits);
        match *held.unwrap_or_else(PoisonError::into_inner) {
            Gate::Cancelled => Err(Cancelled),
            Gate::Open | Gate::Paused => Ok(!has_request()),
        }
    }

    /// Wakes waiting workers, so that they check for requests.
    pub(super) fn wake(&self) {
        // Taking the lock ensures that no worker is between its check and its wait, so that none misses the wake-up.
        drop(self.gate());
        self.gate_moved.notify_all();
    }

    /// Sets the number of finished items.
    pub fn set_done(&self, done: u32) {
        self.done.store(done, Ordering::Relaxed);
    }

    /// Counts one more finished item.
    pub fn count_one(&self) {
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

    /// Locks the gate. Poison is harmless, because a panic cannot leave a `Copy` value half-changed.
    fn gate(&self) -> MutexGuard<'_, Gate> {
        self.gate.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossbeam_channel::bounded;
    use std::sync::Arc;
    use std::time::Duration;

    #[test]
    fn a_paused_worker_waits_until_it_is_resumed() {
        let control = Arc::new(RunControl::default());
        control.pause();
        let (passed, result) = bounded(1);
        let worker = Arc::clone(&control);
        std::thread::spawn(move || passed.send(worker.wait_while_paused()));
        assert!(result.recv_timeout(Duration::from_millis(50)).is_err(), "still held");
        control.resume();
        assert_eq!(result.recv_timeout(Duration::from_secs(10)), Ok(Ok(())));
    }

    #[test]
    fn cancelling_releases_a_paused_worker_and_is_final() {
        let control = RunControl::default();
        control.pause();
        control.cancel();
        control.resume();
        assert_eq!(control.wait_while_paused(), Err(Cancelled));
    }
}
