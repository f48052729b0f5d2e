//! Work on a separate thread, for callers that must not wait.

use std::io;
use std::sync::Arc;
use std::thread;

use crossbeam_channel::{Receiver, TryRecvError, bounded};

use super::panics::caught;
use super::run_control::RunControl;

/// Work in progress that ends with one result. Dropping the task does not end the work: see [`Self::cancel`].
#[derive(Debug)]
pub struct BackgroundTask<T> {
    result: Receiver<Result<T, String>>,
    pub(super) control: Arc<RunControl>,
    total: usize,
}

impl BackgroundTask<String> {
    /// Reads text to its end, such as the standard error of a process, which would block once its pipe is full. If reading fails,
    /// the result is the text up to the failure.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start_reading(mut source: impl io::Read + Send + 'static) -> io::Result<Self> {
        Self::start(move || {
            let mut bytes = Vec::new();
            let _ = source.read_to_end(&mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        })
    }
}

impl<T: Send + 'static> BackgroundTask<T> {
    /// Starts work that counts as a single item.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(work: impl FnOnce() -> T + Send + 'static) -> io::Result<Self> {
        Self::start_counted(1, |_| work())
    }

    /// Starts work on `total` items. The work counts finished items with its control, and stops early when the control is
    /// cancelled.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start_counted(
        total: usize,
        work: impl FnOnce(&RunControl) -> T + Send + 'static,
    ) -> io::Result<Self> {
        let (sender, result) = bounded(1);
        let control = Arc::new(RunControl::default());
        let shared = Arc::clone(&control);
        // Sending fails only when the task was dropped.
        let run = move || drop(sender.send(caught(|| work(&shared))));
        thread::Builder::new().name("background task".to_owned()).spawn(run)?;
        Ok(Self { result, control, total })
    }

    /// Returns the number of finished items.
    pub fn done(&self) -> usize {
        self.control.done() as usize
    }

    /// Returns the number of all items.
    pub fn total(&self) -> usize {
        self.total
    }

    /// Cancels the work, which stops after the current item.
    pub fn cancel(&self) {
        self.control.cancel();
    }

    /// Returns the result once, as soon as it is available, or the message of the panic if the work panicked.
    pub fn poll(&self) -> Option<Result<T, String>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(NO_RESULT.to_owned())),
        }
    }

    /// Returns the result as [`Self::poll`] does, and removes the task when its result is there.
    pub fn take_result(task: &mut Option<Self>) -> Option<Result<T, String>> {
        let result = task.as_ref()?.poll()?;
        *task = None;
        Some(result)
    }

    /// Blocks until the work ends, and returns its result.
    ///
    /// # Errors
    /// The work panicked.
    pub fn wait(&self) -> Result<T, String> {
        self.result.recv().unwrap_or_else(|_| Err(NO_RESULT.to_owned()))
    }
}

/// Error message when the result was taken before.
const NO_RESULT: &str = "the work ended without a result";

impl<T: Send + 'static> BackgroundTask<Vec<T>> {
    /// Applies `act` to each item in turn. After a cancellation, `skip` makes the results of the remaining items.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn for_each<I: Send + 'static>(
        items: Vec<I>,
        act: impl Fn(I) -> T + Send + 'static,
        skip: impl Fn(I) -> T + Send + 'static,
    ) -> io::Result<Self> {
        Self::start_counted(items.len(), move |control| {
            let each = |item| {
                if control.is_cancelled() {
                    return skip(item);
                }
                let result = act(item);
                control.count_one();
                result
            };
            items.into_iter().map(each).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_returns_its_result_or_the_message_of_its_panic() {
        assert_eq!(BackgroundTask::start(|| 6 * 7).expect("a thread").wait(), Ok(42));
        let failed: BackgroundTask<u32> =
            BackgroundTask::start(|| panic!("no such thing")).expect("a thread");
        assert!(failed.wait().expect_err("it failed").contains("no such thing"));
    }

    #[test]
    fn progress_is_counted_and_cancelling_skips_the_remaining_items() {
        let (go_on, may_go_on) = bounded::<()>(5);
        let act = move |number: u32| {
            let _ = may_go_on.recv();
            Ok(number)
        };
        let task = BackgroundTask::for_each((0..5).collect(), act, Err).expect("a thread");
        assert_eq!((task.done(), task.total()), (0, 5));
        for _ in 0..2 {
            go_on.send(()).expect("it waits");
        }
        while task.done() < 2 {
            thread::yield_now();
        }
        assert!(task.poll().is_none());
        task.cancel();
        go_on.send(()).expect("it waits");
        assert_eq!(task.wait(), Ok(vec![Ok(0), Ok(1), Ok(2), Err(3), Err(4)]));
    }
}
