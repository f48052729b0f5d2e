//! Catches panics, so that a panic in an evaluation ends only this evaluation and not the program.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

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
    fn a_panic_becomes_its_message_and_place() {
        assert_eq!(caught(|| 2 + 2), Ok(4));
        let message = caught(|| panic!("limb {}\nis gone", 3)).expect_err("it panicked");
        assert!(
            message.starts_with("limb 3 is gone at crates/lab/src/run/panics.rs:"),
            "{message}"
        );
    }
}
