//! Errors of the connection to a server and of the work through it. Each message is one line.

use std::path::PathBuf;

use snakes_core::check::Invalid;
use snakes_core::save::SaveError;

/// The cluster cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ClusterError {
    /// An address, a name or a file is not allowed.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// A file with credentials or a certificate cannot be read.
    #[error(transparent)]
    File(#[from] SaveError),
    /// A file has no credentials.
    #[error("{}: neither credentials nor the seed of an NKey: {problem}", path.display())]
    Credentials {
        /// The file.
        path: PathBuf,
        /// The reason.
        problem: String,
    },
    /// A file has no certificate.
    #[error("{}: has no certificate in PEM format", .0.display())]
    NoCertificate(PathBuf),
    /// No connection to the server.
    #[error("{url}: cannot connect: {problem}")]
    Unreachable {
        /// The address.
        url: String,
        /// The reason.
        problem: String,
    },
    /// The server has no queue.
    #[error("{url}: the server has no JetStream; start it with: nats-server -js")]
    NoJetStream {
        /// The address.
        url: String,
    },
    /// The server refused a request.
    #[error("{url}: {task} failed: {problem}")]
    Refused {
        /// The address.
        url: String,
        /// The request.
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
        /// The run.
        run: String,
        /// The machine of its coordinator.
        host: String,
        /// Its engine.
        wanted: String,
        /// The engine of this program.
        own: String,
    },
    /// The machine cannot compute what every worker must.
    #[error("the check of the engine failed: {0}")]
    NoProof(String),
    /// The system refused a thread or a runtime.
    #[error("threads: cannot be started: {0}")]
    Threads(#[from] std::io::Error),
    /// The worker was told to stop in an unexpected way.
    #[error("a worker thread ended unexpectedly")]
    ThreadEnded,
}
