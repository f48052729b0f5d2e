//! Something that takes its time, done once on a thread of its own.

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::caught;

/// Work that is under way. Dropping it does not end it: what was begun is finished.
#[derive(Debug)]
pub struct Errand<T>(Mutex<Receiver<Result<T, String>>>);

impl<T: Send + 'static> Errand<T> {
    /// Begins it.
    ///
    /// # Errors
    /// The thread could not be started.
    pub fn start(work: impl FnOnce() -> T + Send + 'static) -> std::io::Result<Self> {
        let (sender, result) = channel();
        // Nobody may be waiting any more.
        let send = move || drop(sender.send(caught(work)));
        thread::Builder::new().name("errand".to_owned()).spawn(send)?;
        Ok(Self(Mutex::new(result)))
    }

    /// What came of it, once it is done; an error, if the program failed.
    pub fn poll(&self) -> Option<Result<T, String>> {
        match self.0.lock().unwrap_or_else(PoisonError::into_inner).try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("it was broken off".to_owned())),
        }
    }

    /// Waits for it, for somebody who has time.
    ///
    /// # Errors
    /// The program failed.
    pub fn wait(&self) -> Result<T, String> {
        let result = self.0.lock().unwrap_or_else(PoisonError::into_inner).recv();
        result.unwrap_or_else(|_| Err("it was broken off".to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_came_of_it_is_told_even_if_the_program_failed() {
        assert_eq!(Errand::start(|| 6 * 7).expect("a thread").wait(), Ok(42));
        let failed: Errand<u32> = Errand::start(|| panic!("no such thing")).expect("a thread");
        assert!(failed.wait().expect_err("it failed").contains("no such thing"));
    }
}
