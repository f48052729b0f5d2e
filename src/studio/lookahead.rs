//! What will happen in a lane, worked out beside the window: a history of its rollout, from which any moment is
//! within reach.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use bevy::tasks::futures_lite::future::{block_on, poll_once};
use bevy::tasks::{AsyncComputeTaskPool, Task};

use super::exhibit::Exhibit;
use crate::run::caught;
use crate::score::History;

/// A history that is on its way, or there. Dropping it ends the work.
#[derive(Default)]
pub(super) struct Lookahead {
    task: Option<Task<Option<History>>>,
    history: Option<Arc<History>>,
    watch: Arc<Watch>,
}

#[derive(Default)]
struct Watch {
    steps_done: AtomicU32,
    is_unwanted: AtomicBool,
}

impl Lookahead {
    /// Begins to work out what will happen. A recording needs none.
    pub fn begin(exhibit: &Exhibit) -> Self {
        let watch = Arc::new(Watch::default());
        let task = AsyncComputeTaskPool::try_get().filter(|_| exhibit.recording().is_none());
        let task = task.map(|pool| {
            let (watch, exhibit) = (Arc::clone(&watch), exhibit.clone());
            pool.spawn(async move {
                let goes_on = |step| {
                    watch.steps_done.store(step, Ordering::Relaxed);
                    !watch.is_unwanted.load(Ordering::Relaxed)
                };
                // Where the program fails, the stage will fail too, and say it.
                let genome = &exhibit.champion().genome;
                caught(|| History::of(genome, exhibit.trial(), goes_on)).ok().flatten()
            })
        });
        Self { task, history: None, watch }
    }

    /// Takes the history in if it is there.
    pub fn poll(&mut self) {
        let Some(task) = &mut self.task else { return };
        if let Some(history) = block_on(poll_once(task)) {
            self.task = None;
            self.history = history.map(Arc::new);
        }
    }

    /// What will happen, once it is known.
    pub fn history(&self) -> Option<&Arc<History>> {
        self.history.as_ref()
    }

    /// How many steps are worked out, while it is on its way.
    pub fn steps_done(&self) -> Option<u32> {
        self.task.as_ref().map(|_| self.watch.steps_done.load(Ordering::Relaxed))
    }
}

impl Drop for Lookahead {
    fn drop(&mut self) {
        self.watch.is_unwanted.store(true, Ordering::Relaxed);
    }
}
