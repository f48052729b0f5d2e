//! State that the calls of a coordinator share with its thread and with its own threads that compute.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::compute::Compute;
use crate::latest::Latest;

/// How a coordinator works.
#[derive(Debug, Clone)]
pub struct CoordinatorOptions {
    /// The name of its run: letters, digits and hyphens. The same run has the same name when it is continued.
    pub run: String,
    /// The proof of its engine: see [`crate::proof`].
    pub proof: String,
    /// Number of workers that it waits for before it begins.
    pub expect_workers: usize,
    /// Number of its own threads that compute, too.
    pub local_threads: usize,
    /// Computes outcomes on this computer.
    pub compute: Arc<dyn Compute>,
}

/// State of the coordinator, for the calls that wait.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Status {
    /// Number of workers whose results may count.
    pub workers: usize,
    /// Number of their threads.
    pub threads: usize,
    /// Number of results that are being checked.
    pub audits: usize,
    /// Why earlier results cannot be trusted any more.
    pub taint: Option<String>,
}

/// Maximum number of texts that are kept after the calls that used them.
const MOST_SHARED: usize = 256;

/// See the module.
#[derive(Debug)]
pub struct Common {
    status: Mutex<Status>,
    /// Texts that tasks share, by hash: the latest ones.
    pub texts: Latest<Arc<str>>,
}

impl Common {
    /// The state of a coordinator that has not begun.
    pub fn new() -> Self {
        Self { status: Mutex::default(), texts: Latest::new(MOST_SHARED) }
    }

    /// State of the coordinator.
    pub fn status(&self) -> MutexGuard<'_, Status> {
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
