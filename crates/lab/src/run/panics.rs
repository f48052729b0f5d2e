//! Catches panics, so that a panic in an evaluation ends only this evaluation and not the program.

use std::any::Any;
use std::cell::RefCell;
use std::io;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::Once;

use super::evaluator::WorkersError;
use super::terminal::say;

thread_local! {
    /// Message of the last panic if this thread expects panics (empty before one), otherwise `None`.
    static EXPECTED: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Runs `work`. A panic becomes an error with its message and location, and is not printed.
///
/// # Errors
/// `work` panicked. Values that it was changing may be inconsistent and must not be used again.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    install_hook();
    EXPECTED.set(Some(String::new()));
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    let message = EXPECTED.take().unwrap_or_default();
    result
        .map_err(|payload| if message.is_empty() { message_of(payload.as_ref()) } else { message })
}

/// Runs `work` of a library that panics if the system refuses it a thread.
///
/// # Errors
/// The system refused a thread, or `work` panicked for another reason.
pub fn with_threads<T>(work: impl FnOnce() -> T) -> io::Result<T> {
    caught(work).map_err(|message| {
        if is_of_threads(&message) { no_thread() } else { io::Error::other(message) }
    })
}

/// Lets a panic that nobody expects print one line. A panic in a library to which the system refuses a thread ends the program.
pub fn report_panics() {
    panic::set_hook(Box::new(|info| {
        end_without_threads(info);
        let place = info.location().map(|place| format!(" at {place}")).unwrap_or_default();
        say(&format!("error: this program has a fault: {}{place}", message_of(info.payload())));
    }));
}

/// Ends the program with an error if the system refused a thread to a library, such as Bevy, which panics then. What such a library
/// leaves behind panics again when it is dropped, which would end the program without a message.
pub fn end_without_threads(info: &PanicHookInfo<'_>) {
    if is_of_threads(&message_of(info.payload())) {
        say(&format!("error: {}", WorkersError::from(no_thread())));
        std::process::exit(1);
    }
}

fn no_thread() -> io::Error {
    io::Error::other("the system refuses another thread")
}

/// Whether this is the message with which the standard library, Bevy or Tokio panics if the system refuses a thread.
fn is_of_threads(message: &str) -> bool {
    let message = message.to_lowercase();
    ["failed to spawn thread", "spawn worker thread"].iter().any(|words| message.contains(words))
}

/// Installs a panic hook that stores the message on threads that expect a panic, instead of printing it.
fn install_hook() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            let is_expected = EXPECTED.with_borrow_mut(|expected| {
                if let Some(message) = expected {
                    let place = info.location().map(|place| format!(" at {place}"));
                    *message = message_of(info.payload()) + &place.unwrap_or_default();
                }
                expected.is_some()
            });
            if !is_expected {
                usual(info);
            }
        }));
    });
}

/// Returns a panic's message as one line of at most 300 characters.
fn message_of(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let text = text.unwrap_or("a panic without a message");
    let line = text.split_whitespace().collect::<Vec<&str>>().join(" ");
    line.chars().take(300).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f8_a_library_without_a_thread_gives_an_error_that_says_so() {
        for message in [
            "failed to spawn thread: Os { code: 11, kind: WouldBlock }",
            "Failed to spawn thread.: Os { code: 11, kind: WouldBlock }",
            "OS can't spawn worker thread: Resource temporarily unavailable (os error 11)",
        ] {
            let error = with_threads(|| panic!("{message}")).expect_err("it panicked").to_string();
            assert_eq!(error, "the system refuses another thread");
        }
        let other = with_threads(|| panic!("no such limb")).expect_err("it panicked").to_string();
        assert!(other.starts_with("no such limb at "), "{other}");
        assert_eq!(with_threads(|| 2 + 2).expect("no panic"), 4);
    }

    #[test]
    fn a_panic_becomes_its_message_and_place() {
        assert_eq!(caught(|| 2 + 2), Ok(4));
        let message = caught(|| panic!("limb {}\nis gone", 3)).expect_err("it panicked");
        assert!(
            message.starts_with("limb 3 is gone at crates/lab/src/run/panics.rs:"),
            "{message}"
        );
    }
}
