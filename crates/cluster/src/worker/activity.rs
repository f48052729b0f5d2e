//! Messages of a worker to its user: for which runs it computes, and that it waits for work.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::hello::RunNotice;

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
    /// Reasons for which runs wait, by the names of the runs, from the runs' notices.
    troubles: BTreeMap<String, String>,
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
    /// Records the notice of a run. Returns a line if the run waits for its server since this notice, or no longer.
    pub fn hear(&self, RunNotice { run, host, trouble, .. }: &RunNotice) -> Option<String> {
        let mut state = self.state();
        if state.hosts.len() >= MOST_RUNS && !state.hosts.contains_key(run) {
            return None;
        }
        state.hosts.insert(run.clone(), host.clone());
        let before = match trouble {
            Some(trouble) => state.troubles.insert(run.clone(), trouble.clone()),
            None => state.troubles.remove(run),
        };
        let words = match trouble {
            _ if before == *trouble => return None,
            Some(trouble) => trouble.clone(),
            None => format!("over: {}", before.unwrap_or_default()),
        };
        Some(format!("run {run} on {host}: {words}"))
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
            (state.hosts, state.troubles) = Default::default();
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
    use crate::hello::tests::run_notice;

    fn notice(trouble: Option<&str>) -> RunNotice {
        let trouble = trouble.map(str::to_owned);
        RunNotice { trouble, ..run_notice("climb", "lab-1") }
    }

    #[test]
    fn f3_a_worker_tells_once_that_a_run_waits_for_its_server_and_that_this_is_over() {
        let activity = WorkerActivity::default();
        assert_eq!(activity.hear(&notice(None)), None);
        let line = activity.hear(&notice(Some("work cannot be stored: full")));
        assert_eq!(line.as_deref(), Some("run climb on lab-1: work cannot be stored: full"));
        assert_eq!(activity.hear(&notice(Some("work cannot be stored: full"))), None);
        let line = activity.hear(&notice(None));
        assert_eq!(line.as_deref(), Some("run climb on lab-1: over: work cannot be stored: full"));
        assert_eq!(activity.hear(&notice(None)), None);
    }

    #[test]
    fn a_worker_tells_of_each_run_once_and_that_it_waits_once() {
        let activity = WorkerActivity::default();
        let now = Instant::now();
        let news = |seconds| activity.news(now + Duration::from_secs(seconds), 70);
        assert_eq!(news(60), None);
        activity.begin("climb");
        assert_eq!(news(60), None, "its computer is not known yet");
        assert_eq!(activity.hear(&notice(None)), None);
        assert_eq!(news(60), Some("computing for climb on lab-1".to_owned()));
        assert_eq!(news(60), None, "a long batch");
        activity.end();
        activity.begin("climb");
        activity.end();
        assert_eq!(news(5), None);
        assert_eq!(news(60), Some("waiting for work; 70 evaluations so far".to_owned()));
        assert_eq!(news(120), None);
        assert_eq!(activity.hear(&notice(None)), None);
        activity.begin("climb");
        assert_eq!(news(121), Some("computing for climb on lab-1".to_owned()));
    }
}
