//! Names on the server: streams, subjects and consumers.

use std::time::Duration;

use snakes_core::check::{Invalid, quoted};

/// The stream of batches that wait for a worker.
pub const WORK_STREAM: &str = "SNAKES_WORK";
/// The stream of results that wait for their coordinator.
pub const RESULT_STREAM: &str = "SNAKES_RESULTS";
/// All subjects of the first stream.
pub const WORK_SUBJECTS: &str = "snakes.work.>";
/// All subjects of the second stream.
pub const RESULT_SUBJECTS: &str = "snakes.result.>";
/// The subject on which each worker tells of itself once a second.
pub const WORKER_NOTICES: &str = "snakes.worker";
/// The subject on which each coordinator tells of its run once a second.
pub const RUN_NOTICES: &str = "snakes.run";

/// Interval of the notices.
pub const NOTICE_INTERVAL: Duration = Duration::from_secs(1);
/// A machine that has been silent for this long is gone.
pub const SILENCE: Duration = Duration::from_secs(5);
/// The server delivers a batch again that was neither acknowledged nor reported to be in progress for this long.
pub const ACKNOWLEDGEMENT_WAIT: Duration = Duration::from_secs(6);
/// Interval at which a worker reports that a batch is in progress.
pub const PROGRESS_INTERVAL: Duration = Duration::from_millis(1500);
/// How long a request for a message stays on the server. After a restart of the server the next one arrives there.
pub const PULL_WAIT: Duration = Duration::from_secs(2);
/// Messages that nobody fetched are removed after this time.
pub const MESSAGE_AGE: Duration = Duration::from_secs(24 * 3600);

/// The subject of a run's batches. Only workers that proved the same engine receive them.
pub fn work_subject(proof: &str, run: &str) -> String {
    format!("snakes.work.{proof}.{run}")
}

/// The subject of a run's results.
pub fn result_subject(run: &str) -> String {
    format!("snakes.result.{run}")
}

/// The subject on which a coordinator answers with what the tasks of a batch share.
pub fn shared_subject(run: &str, hash: &str) -> String {
    format!("snakes.shared.{run}.{hash}")
}

/// The subject on which a worker checks the result of another.
pub fn audit_subject(worker: &str) -> String {
    format!("snakes.audit.{worker}")
}

/// The consumer that all workers with this proof share.
pub fn worker_consumer(proof: &str) -> String {
    format!("workers-{proof}")
}

/// Checks the name of a run or of a worker, which becomes part of a subject: 1 to 100 letters, digits and hyphens.
///
/// # Errors
/// Another name.
pub fn check_name(field: &str, name: &str) -> Result<(), Invalid> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
    if (1..=100).contains(&name.len()) && name.chars().all(is_plain) {
        return Ok(());
    }
    Err(Invalid::new(field, quoted(name), "1 to 100 letters, digits and hyphens"))
}
