//! State that the calls of a coordinator share with its thread and its computing threads.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::compute::Compute;
use crate::latest::Latest;

/// Options of a coordinator.
#[derive(Debug, Clone)]
pub struct CoordinatorOptions {
    /// Name of the run: letters, digits and hyphens. A continued run keeps its name.
    pub run: String,
    /// Proof of the coordinator's engine: see [`crate::proof`].
    pub proof: String,
    /// Number of workers that the coordinator waits for before it begins.
    pub expect_workers: usize,
    /// Number of threads of the coordinator that compute as well.
    pub local_threads: usize,
    /// Whether calls are cancelled once the server refuses for good what the coordinator needs. Otherwise they end
    /// without the missing outcomes, which their caller computes.
    pub ends_if_refused: bool,
    /// Computes outcomes on this machine.
    pub compute: Arc<dyn Compute>,
}

/// State of a coordinator, as the waiting calls see it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Status {
    /// Number of workers whose results may count.
    pub workers: usize,
    /// Number of threads of these workers.
    pub threads: usize,
    /// Number of results that are being checked.
    pub audits: usize,
    /// Why results that were already delivered may be wrong; `None` while there is no doubt.
    pub taint: Option<String>,
    /// Why the server refuses for good what the coordinator needs, as one line; `None` while it does not.
    pub refusal: Option<String>,
}

/// Maximum number of shared texts that are kept.
const MOST_SHARED: usize = 256;

/// State that calls and threads of a coordinator share: see the module.
#[derive(Debug)]
pub struct Common {
    status: Mutex<Status>,
    /// Texts of the trials and genomes that were used last, by hash.
    pub texts: Latest<Arc<str>>,
}

impl Common {
    /// Creates the state of a coordinator that has not begun.
    pub fn new() -> Self {
        Self { status: Mutex::default(), texts: Latest::new(MOST_SHARED) }
    }

    /// Locks the state of the coordinator.
    pub fn status(&self) -> MutexGuard<'_, Status> {
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
