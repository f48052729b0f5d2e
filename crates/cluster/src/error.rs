//! Errors of the connection to a server and of the work on it. Each message is one line.

use std::path::PathBuf;

use snakes_core::check::Invalid;
use snakes_core::save::SaveError;

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
        /// What is wrong with the file.
        problem: String,
    },
    /// A file contains no certificate. Holds its path.
    #[error("{}: has no certificate in PEM format", .0.display())]
    NoCertificate(PathBuf),
    /// The server cannot be reached.
    #[error("{url}: cannot connect: {problem}")]
    Unreachable {
        /// Address of the server.
        url: String,
        /// Reason of the failure.
        problem: String,
    },
    /// The server has no JetStream, which keeps the queues.
    #[error("{url}: the server has no JetStream; start it with: nats-server -js")]
    NoJetStream {
        /// Address of the server.
        url: String,
    },
    /// The server refused a request.
    #[error("{url}: {task} failed: {problem}")]
    Refused {
        /// Address of the server.
        url: String,
        /// Name of the request, in a few words.
        task: &'static str,
        /// The server's answer.
        problem: String,
    },
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
