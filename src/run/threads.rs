//! Worker threads.

use std::num::NonZero;
use std::ops::RangeInclusive;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// How many worker threads may be asked for.
pub const THREADS_RANGE: RangeInclusive<usize> = 1..=1024;

/// The number of processors this program may use.
pub fn available_cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}

/// A pool of its own for one run.
///
/// # Errors
/// The system refused to start that many threads.
pub fn pool(threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(|index| format!("evolution-{index}"))
        .build()
}
