//! From "no display" to one line of text.
//!
//! Without a display or a graphics driver, winit and the renderer end in a panic. Until the first frame
//! is drawn a panic therefore means that no window can be opened; after it, that the program is broken.

use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use bevy::prelude::*;

use super::StudioError;

static WINDOW_IS_OPEN: AtomicBool = AtomicBool::new(false);
static FIRST_PANIC: Mutex<Option<String>> = Mutex::new(None);

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Last, || WINDOW_IS_OPEN.store(true, Ordering::Relaxed));
}

/// Runs the app; a panic before its first frame becomes [`StudioError::NoWindow`].
pub(super) fn guarded(run: impl FnOnce() -> AppExit) -> Result<AppExit, StudioError> {
    let usual_hook = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if WINDOW_IS_OPEN.load(Ordering::Relaxed) {
            usual_hook(info);
        } else {
            let mut first = FIRST_PANIC.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert_with(|| reason(info));
        }
    }));
    panic::catch_unwind(AssertUnwindSafe(run)).map_err(|_| {
        let mut first = FIRST_PANIC.lock().unwrap_or_else(PoisonError::into_inner);
        match first.take() {
            Some(reason) => StudioError::NoWindow(reason),
            None => StudioError::Ended(1),
        }
    })
}

/// The panic's message in a few words.
fn reason(info: &PanicHookInfo<'_>) -> String {
    let message = info.payload_as_str().unwrap_or("unknown reason");
    if message.contains("event loop") {
        "no display was found".to_owned()
    } else if message.contains("GPU") {
        "no graphics driver was found".to_owned()
    } else {
        message.lines().next().unwrap_or_default().chars().take(120).collect()
    }
}
