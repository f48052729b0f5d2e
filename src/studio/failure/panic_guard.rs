//! Turns a missing display or a crash into a one-line error message.
//!
//! Without a display or a graphics driver, winit and the renderer panic. A panic before the first frame therefore means
//! that no window can be opened. A later panic is a bug. The run is safe then, because every finished generation was
//! saved at once.

use std::panic;
use std::panic::{AssertUnwindSafe, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use bevy::prelude::*;

use super::gpu_loss;
use super::variables;
use crate::studio::error::StudioError;
use crate::studio::state::run_context::RunInProgress;
use snakes_lab::run::end_without_threads;

static WINDOW_IS_OPEN: AtomicBool = AtomicBool::new(false);
static FIRST_PANIC: Mutex<Option<String>> = Mutex::new(None);

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Last, || WINDOW_IS_OPEN.store(true, Ordering::Relaxed));
}

/// Runs the app. Turns a panic before the first frame into [`StudioError::NoWindow`], and a later panic into
/// [`StudioError::Crashed`].
pub(crate) fn guarded(
    run_folder: &RunInProgress,
    run: impl FnOnce() -> AppExit,
) -> Result<AppExit, StudioError> {
    let usual_hook = panic::take_hook();
    let folder = Arc::clone(run_folder);
    panic::set_hook(Box::new(move |info| {
        let is_open = WINDOW_IS_OPEN.load(Ordering::Relaxed);
        end_without_threads(info);
        if is_open {
            gpu_loss::recover_or_exit(info, &folder);
            usual_hook(info);
        }
        let mut first = FIRST_PANIC.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert_with(|| if is_open { said(info) } else { reason(info) });
    }));
    // Unwinding drops the app and the background run, which first finishes writing.
    panic::catch_unwind(AssertUnwindSafe(run)).map_err(|_| {
        let first = FIRST_PANIC.lock().unwrap_or_else(PoisonError::into_inner).take();
        let message = first.unwrap_or_else(|| "unknown reason".to_owned());
        if WINDOW_IS_OPEN.load(Ordering::Relaxed) {
            let run = run_folder.lock().unwrap_or_else(PoisonError::into_inner).take();
            StudioError::Crashed { message, run }
        } else {
            StudioError::NoWindow(message)
        }
    })
}

/// Returns the first line of the panic's message and its location.
fn said(info: &PanicHookInfo<'_>) -> String {
    let message = info.payload_as_str().unwrap_or("a panic without a message");
    let place = info.location().map(|place| format!(" at {place}")).unwrap_or_default();
    message.lines().next().unwrap_or_default().to_owned() + &place
}

/// Returns the reason why no window can be opened, from the panic's message.
fn reason(info: &PanicHookInfo<'_>) -> String {
    let message = info.payload_as_str().unwrap_or("unknown reason");
    if ["LibraryOpenError", "NoWaylandLib"].iter().any(|missing| message.contains(missing)) {
        "a library of X11 or Wayland is missing".to_owned()
    } else if message.contains("event loop") {
        format!("no display was found{}", variables::of_display())
    } else if message.contains("GPU") {
        format!("no graphics driver was found{}", variables::of_graphics())
    } else {
        message.lines().next().unwrap_or_default().chars().take(120).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::small_run;
    use snakes_core::save::SavesFolder;
    use snakes_lab::run::{BackgroundRun, LocalPool, RunEvent, RunSource};
    use std::time::Duration;

    #[test]
    fn a_crash_names_the_run_and_the_run_can_continue() {
        let folder = tempfile::tempdir().expect("a folder");
        let source = small_run(&SavesFolder::find(Some(folder.path())), 1, 10_000);
        let run_folder = RunInProgress::default();
        run_folder.lock().expect("no panic").replace(source.folder.clone());
        let mut last = 0;
        let ended = guarded(&run_folder, || {
            WINDOW_IS_OPEN.store(true, Ordering::Relaxed);
            let evaluator = Arc::new(LocalPool::new(1).expect("threads"));
            let background =
                BackgroundRun::start(source.clone(), evaluator, [], None).expect("a thread");
            background.resume();
            while last < 3 {
                if let Some(RunEvent::Generation(report)) = background.poll() {
                    last = report.generation;
                }
                std::thread::sleep(Duration::from_millis(1));
            }
            panic!("a panel divided by zero")
        });
        let Err(StudioError::Crashed { run, .. }) = ended else { panic!("{ended:?}") };
        assert_eq!(run.as_ref(), Some(&source.folder));
        // The run's thread has released the folder, and no finished generation is lost.
        let again = RunSource::in_folder(&source.folder).expect("a run").open("a test");
        assert!(again.expect("free and whole").reports.len() as u32 >= last);
    }
}
