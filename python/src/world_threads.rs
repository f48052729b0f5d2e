//! The threads that step worlds, without Python's lock.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::world::World;

/// Threads that step the worlds of an environment. They start when they are first needed.
pub struct WorldThreads {
    count: usize,
    /// Threads, and the id of the process that started them, because threads do not survive a fork.
    pool: Option<(u32, ThreadPool)>,
}

impl WorldThreads {
    pub fn new(count: usize) -> Self {
        Self { count, pool: None }
    }

    /// Returns as many threads that have not started.
    pub fn unstarted(&self) -> Self {
        Self::new(self.count)
    }

    /// Starts the threads, unless one is enough or they already run in this process.
    fn prepare(&mut self) -> PyResult<()> {
        let process = std::process::id();
        let is_ready = self.pool.as_ref().is_some_and(|(of, _)| *of == process);
        if is_ready || self.count <= 1 {
            return Ok(());
        }
        let pool = ThreadPoolBuilder::new()
            .num_threads(self.count)
            .thread_name(|index| format!("worlds-{index}"))
            .build()
            .map_err(|error| PyRuntimeError::new_err(format!("threads: {error}")))?;
        // The threads of a parent process's pool do not exist in this process, so the pool must not wait for their end.
        std::mem::forget(self.pool.replace((process, pool)));
        Ok(())
    }

    /// Calls `work` with the index of each world, the world and its row of `width` numbers.
    pub fn each<T: Send>(
        &mut self,
        py: Python<'_>,
        worlds: &mut [Option<World>],
        rows: &mut [f32],
        width: usize,
        work: impl Fn(usize, &mut Option<World>, &mut [f32]) -> T + Sync + Send,
    ) -> PyResult<Vec<T>> {
        self.prepare()?;
        let Self { count, pool } = self;
        let width = width.max(1);
        let results = py.detach(|| match pool {
            Some((_, pool)) if worlds.len() > 1 => {
                // With a few portions per thread their durations even out, and distributing them costs little.
                let portion = (worlds.len() / (8 * *count)).max(1);
                pool.install(|| {
                    let each = worlds.par_iter_mut().zip(rows.par_chunks_mut(width)).enumerate();
                    each.with_min_len(portion)
                        .map(|(index, (world, row))| work(index, world, row))
                        .collect()
                })
            }
            _ => {
                let each = worlds.iter_mut().zip(rows.chunks_mut(width)).enumerate();
                each.map(|(index, (world, row))| work(index, world, row)).collect()
            }
        });
        Ok(results)
    }
}
