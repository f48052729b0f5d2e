//! Names on the NATS server: streams, subjects and consumers.

use std::time::Duration;

use snakes_core::check::{Invalid, quoted};

/// The stream of batches that wait for a worker.
pub const WORK_STREAM: &str = "SNAKES_WORK";
/// The stream of results that wait for their coordinator.
pub const RESULT_STREAM: &str = "SNAKES_RESULTS";
/// Pattern of all subjects of batches.
pub const WORK_SUBJECTS: &str = "snakes.work.>";
/// Pattern of all subjects of results.
pub const RESULT_SUBJECTS: &str = "snakes.result.>";
/// Subject on which each worker sends a notice once a second.
pub const WORKER_NOTICES: &str = "snakes.worker";
/// Subject on which each coordinator sends a notice once a second.
pub const RUN_NOTICES: &str = "snakes.run";

/// Interval between two notices of a worker or a coordinator.
pub const NOTICE_INTERVAL: Duration = Duration::from_secs(1);
/// A worker that sent no notice for this long is considered gone.
pub const SILENCE: Duration = Duration::from_secs(5);
/// The server delivers a batch again if it was neither acknowledged nor reported to be in progress for this long.
pub const ACKNOWLEDGEMENT_WAIT: Duration = Duration::from_secs(6);
/// Interval at which a worker reports that a batch is in progress.
pub const PROGRESS_INTERVAL: Duration = Duration::from_millis(1500);
/// How long a request for messages stays on the server. A restarted server forgets it, but receives the next request.
pub const PULL_WAIT: Duration = Duration::from_secs(2);
/// The server removes messages that nobody fetched for this long.
pub const MESSAGE_AGE: Duration = Duration::from_secs(24 * 3600);

/// Returns the subject of a run's batches. Only workers with this proof receive them.
pub fn work_subject(proof: &str, run: &str) -> String {
    format!("snakes.work.{proof}.{run}")
}

/// Returns the subject of a run's results.
pub fn result_subject(run: &str) -> String {
    format!("snakes.result.{run}")
}

/// Returns the subject on which a coordinator sends the trial or the genome that tasks share.
pub fn shared_subject(run: &str, hash: &str) -> String {
    format!("snakes.shared.{run}.{hash}")
}

/// Returns the subject on which a worker receives requests to check a result of another worker.
pub fn audit_subject(worker: &str) -> String {
    format!("snakes.audit.{worker}")
}

/// Returns the name of the consumer that all workers with this proof share.
pub fn worker_consumer(proof: &str) -> String {
    format!("workers-{proof}")
}

/// Checks the name of a run or of a worker, which becomes part of a subject: 1 to 100 letters, digits and hyphens.
///
/// # Errors
/// The name has another form.
pub fn check_name(field: &str, name: &str) -> Result<(), Invalid> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
    if (1..=100).contains(&name.len()) && name.chars().all(is_plain) {
        return Ok(());
    }
    Err(Invalid::new(field, quoted(name), "1 to 100 letters, digits and hyphens"))
}
