//! The same done with one thing after another, on a thread of its own: counted, and to be cancelled.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::Errand;

/// Work with many things that is under way. Dropping it does not end it: see [`Self::cancel`].
#[derive(Debug)]
pub struct Batch<T> {
    tally: Arc<Tally>,
    total: usize,
    errand: Errand<Vec<T>>,
}

/// How far it is, and whether it is to stop.
#[derive(Debug, Default)]
struct Tally {
    done: AtomicUsize,
    is_cancelled: AtomicBool,
}

impl<T: Send + 'static> Batch<T> {
    /// Begins to do something with each of several things. Once it is cancelled, `leave` says what comes of those
    /// with which nothing is done.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start<I: Send + 'static>(
        things: Vec<I>,
        act: impl Fn(I) -> T + Send + 'static,
        leave: impl Fn(I) -> T + Send + 'static,
    ) -> std::io::Result<Self> {
        let (tally, total) = (Arc::new(Tally::default()), things.len());
        let shared = Arc::clone(&tally);
        let each = move |thing| {
            if shared.is_cancelled.load(Ordering::Relaxed) {
                return leave(thing);
            }
            let result = act(thing);
            shared.done.fetch_add(1, Ordering::Relaxed);
            result
        };
        let errand = Errand::start(move || things.into_iter().map(each).collect())?;
        Ok(Self { tally, total, errand })
    }

    /// With how many things it is done.
    pub fn done(&self) -> usize {
        self.tally.done.load(Ordering::Relaxed)
    }

    /// With how many things it has to do.
    pub fn total(&self) -> usize {
        self.total
    }

    /// Ends it after the thing that it is about.
    pub fn cancel(&self) {
        self.tally.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// What came of each thing, once all is done or left; an error, if the program failed.
    pub fn poll(&self) -> Option<Result<Vec<T>, String>> {
        self.errand.poll()
    }

    /// Waits for it, for somebody who has time.
    ///
    /// # Errors
    /// The program failed.
    pub fn wait(&self) -> Result<Vec<T>, String> {
        self.errand.wait()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn it_is_counted_and_what_is_cancelled_is_left_but_not_lost() {
        let (go_on, may_go_on) = channel::<()>();
        let act = move |number: u32| {
            let _ = may_go_on.recv();
            Ok(number)
        };
        let batch = Batch::start((0..5).collect(), act, Err).expect("a thread");
        assert_eq!((batch.done(), batch.total()), (0, 5));
        for _ in 0..2 {
            go_on.send(()).expect("it waits");
        }
        while batch.done() < 2 {
            std::thread::yield_now();
        }
        assert!(batch.poll().is_none());
        batch.cancel();
        go_on.send(()).expect("it waits");
        assert_eq!(batch.wait(), Ok(vec![Ok(0), Ok(1), Ok(2), Err(3), Err(4)]));
    }
}
