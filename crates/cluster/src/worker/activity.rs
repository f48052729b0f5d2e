//! Messages of a worker to its user: for which runs it computes, and that it waits for work.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Maximum number of runs that are remembered.
const MOST_RUNS: usize = 256;
/// A worker without a batch for this long counts as waiting. The gap between two generations is much shorter.
const WAITS_AFTER: Duration = Duration::from_secs(10);

/// The activity of a worker's threads.
#[derive(Debug, Default)]
pub struct WorkerActivity(Mutex<ActivityState>);

#[derive(Debug, Default)]
struct ActivityState {
    /// Names of the computers of the runs, by the name of the run, from the runs' notices.
    hosts: BTreeMap<String, String>,
    /// Names of the runs for which batches were computed.
    computed: BTreeSet<String>,
    /// Names of the runs that were reported to the user.
    told: BTreeSet<String>,
    /// Number of batches that are being computed.
    busy: usize,
    /// When the last batch ended; `None` before the first.
    ended: Option<Instant>,
}

impl WorkerActivity {
    /// Records the notice of a run.
    pub fn hear(&self, run: &str, host: &str) {
        let mut state = self.state();
        if state.hosts.len() < MOST_RUNS || state.hosts.contains_key(run) {
            state.hosts.insert(run.to_owned(), host.to_owned());
        }
    }

    /// Records that a thread begins a batch.
    pub fn begin(&self, run: &str) {
        let mut state = self.state();
        state.busy += 1;
        if state.computed.len() < MOST_RUNS {
            state.computed.insert(run.to_owned());
        }
    }

    /// Records that a thread has computed a batch.
    pub fn end(&self) {
        let mut state = self.state();
        state.busy = state.busy.saturating_sub(1);
        state.ended = Some(Instant::now());
    }

    /// Returns the news since the last call as a line: that this worker computes for another run, or that it waits for
    /// work.
    pub fn news(&self, now: Instant, evaluations: u64) -> Option<String> {
        let mut state = self.state();
        let waits = state.busy == 0
            && state.ended.is_some_and(|at| now.saturating_duration_since(at) > WAITS_AFTER);
        if waits && !state.computed.is_empty() {
            state.computed.clear();
            state.told.clear();
            state.hosts.clear();
            return Some(format!("waiting for work; {evaluations} evaluations so far"));
        }
        // A run without a notice so far sends one within a second.
        let untold = state.computed.difference(&state.told);
        let new =
            untold.filter_map(|run| Some((run.clone(), state.hosts.get(run)?.clone()))).next();
        let (run, host) = new?;
        state.told.insert(run.clone());
        Some(format!("computing for {run} on {host}"))
    }

    fn state(&self) -> MutexGuard<'_, ActivityState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_worker_tells_of_each_run_once_and_that_it_waits_once() {
        let activity = WorkerActivity::default();
        let now = Instant::now();
        let news = |seconds| activity.news(now + Duration::from_secs(seconds), 70);
        assert_eq!(news(60), None);
        activity.begin("climb");
        assert_eq!(news(60), None, "its computer is not known yet");
        activity.hear("climb", "lab-1");
        assert_eq!(news(60), Some("computing for climb on lab-1".to_owned()));
        assert_eq!(news(60), None, "a long batch");
        activity.end();
        activity.begin("climb");
        activity.end();
        assert_eq!(news(5), None);
        assert_eq!(news(60), Some("waiting for work; 70 evaluations so far".to_owned()));
        assert_eq!(news(120), None);
        activity.hear("climb", "lab-1");
        activity.begin("climb");
        assert_eq!(news(121), Some("computing for climb on lab-1".to_owned()));
    }
}
