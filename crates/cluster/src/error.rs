//! Errors of the connection to a server and of the work on it. Each message is one line.

use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use super::trouble::Trouble;
use snakes_core::check::Invalid;
use snakes_core::save::SaveError;
use snakes_lab::run::headless::say;

/// Why the cluster cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ClusterError {
    /// An address, a name or a value is not allowed.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// A file with credentials or a certificate cannot be read.
    #[error(transparent)]
    File(#[from] SaveError),
    /// A file contains no credentials.
    #[error("{}: neither credentials nor the seed of an NKey: {problem}", path.display())]
    Credentials {
        /// Path of the file.
        path: PathBuf,
        /// Description of the problem with the file.
        problem: String,
    },
    /// A file contains no certificate. Holds its path.
    #[error("{}: has no certificate in PEM format", .0.display())]
    NoCertificate(PathBuf),
    /// The server cannot be reached.
    #[error("{url}: cannot connect: {trouble}")]
    Unreachable {
        /// Address of the server.
        url: String,
        /// Why the connection failed.
        trouble: Trouble,
    },
    /// The server has no JetStream, which keeps the queues.
    #[error("{url}: the server has no JetStream; start it with: nats-server -js")]
    NoJetStream {
        /// Address of the server.
        url: String,
    },
    /// The server accepts only messages that are too small for a batch.
    #[error(
        "{url}: the server takes messages of at most {most} bytes; set max_payload in its settings to {least} or more"
    )]
    SmallMessages {
        /// Address of the server.
        url: String,
        /// Size of the largest message that it accepts, in bytes.
        most: usize,
        /// Smallest allowed value of `most`, in bytes.
        least: usize,
    },
    /// A request to the server failed.
    #[error("{url}: {task} failed: {trouble}")]
    Refused {
        /// Address of the server.
        url: String,
        /// Name of the request, in a few words.
        task: &'static str,
        /// Why it failed.
        trouble: Trouble,
    },
    /// The server refuses for good what a coordinator needs. Holds the reason as one line.
    #[error("{0}")]
    Ended(String),
    /// The coordinators on this server compute with another engine.
    #[error(
        "run {run} on {host} needs {wanted}, and this program computes with {own}; use the same version of Snakes & \
         Stairs and the same kind of processor on all machines"
    )]
    OtherEngine {
        /// Name of a run with another engine.
        run: String,
        /// Name of the computer on which the run's coordinator works.
        host: String,
        /// Engine of the run.
        wanted: String,
        /// Engine of this program.
        own: String,
    },
    /// This machine failed the check of the engine that every worker must pass. Holds the reason.
    #[error("the check of the engine failed: {0}")]
    NoProof(String),
    /// The operating system could not start a thread or a runtime.
    #[error("threads: cannot be started: {0}")]
    Threads(#[from] std::io::Error),
    /// A thread of the worker panicked.
    #[error("a worker thread ended unexpectedly")]
    ThreadEnded,
}

impl ClusterError {
    /// Returns why a request or the connection failed, if that is the error.
    fn trouble(&self) -> Option<&Trouble> {
        match self {
            Self::Unreachable { trouble, .. } | Self::Refused { trouble, .. } => Some(trouble),
            _ => None,
        }
    }

    /// Returns whether the server refuses for good what the attempt needs, so that repeating it is useless.
    pub fn is_final(&self) -> bool {
        matches!(self, Self::Ended(_)) || matches!(self.trouble(), Some(Trouble::Never(_)))
    }
}

/// Repeats an attempt that failed because the server lacked room, until it succeeds or `waits` returns `false`, which it does
/// after a pause otherwise. Meanwhile the server may also be away, because a restart can be what makes room.
///
/// # Errors
/// The error of the last attempt.
pub fn patiently<T>(
    mut waits: impl FnMut(&ClusterError) -> bool,
    mut attempt: impl FnMut() -> Result<T, ClusterError>,
) -> Result<T, ClusterError> {
    let mut has_waited = false;
    loop {
        let error = match attempt() {
            Ok(value) => return Ok(value),
            Err(error) => error,
        };
        let can_pass = match error.trouble() {
            Some(Trouble::Full(_)) => true,
            Some(Trouble::NoAnswer | Trouble::Refused(_)) => has_waited,
            Some(Trouble::Never(_)) | None => false,
        };
        if !can_pass || !waits(&error) {
            return Err(error);
        }
        has_waited = true;
    }
}

/// Pause before an attempt is repeated for which the server lacked room.
const PAUSE: Duration = Duration::from_secs(1);

/// Repeats an attempt until the server has room for it, and prints each lack once. Gives up when `is_interrupted` returns `true`.
///
/// # Errors
/// Returns the error of the last attempt.
pub fn when_there_is_room<T>(
    is_interrupted: impl Fn() -> bool,
    attempt: impl FnMut() -> Result<T, ClusterError>,
) -> Result<T, ClusterError> {
    let mut told = None;
    let waits = |error: &ClusterError| {
        let line = format!("{error}; waiting");
        if told.as_ref() != Some(&line) {
            say(&line);
            told = Some(line);
        }
        thread::sleep(PAUSE);
        !is_interrupted()
    };
    patiently(waits, attempt)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f3_only_a_lack_of_room_is_waited_for_and_then_also_a_server_that_restarts() {
        let attempts = |troubles: &[fn(String) -> Trouble]| {
            let mut troubles = troubles.iter();
            let (mut told, mut made) = (0, 0);
            let waits = |_: &ClusterError| {
                told += 1;
                true
            };
            let result = patiently(waits, || {
                made += 1;
                troubles.next().map_or(Ok(()), |trouble| {
                    let (url, trouble) = ("nats://a".to_owned(), trouble(String::new()));
                    Err(ClusterError::Unreachable { url, trouble })
                })
            });
            (result.is_ok(), told, made)
        };
        use Trouble::{Full, Never, Refused};
        assert_eq!(attempts(&[]), (true, 0, 1));
        assert_eq!(attempts(&[Refused, Full]), (false, 0, 1), "no server is there");
        assert_eq!(attempts(&[Full, Refused, Full]), (true, 3, 4));
        assert_eq!(attempts(&[Full, Never, Full]), (false, 1, 2));
    }
}
