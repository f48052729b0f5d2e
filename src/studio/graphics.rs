//! When the graphics device is lost: a driver that restarts, a laptop that changes cards.
//!
//! If the renderer notices in good order, drawing begins anew on another device. Mostly it does not: a buffer of the
//! lost device makes it panic in the middle of a frame, and nothing can be drawn in this process any more. The
//! program then opens itself again with the same arguments, and the run goes on from its folder.

#[cfg(unix)]
use std::ffi::OsString;
use std::io::Write;
use std::panic::PanicHookInfo;
use std::sync::{Arc, Mutex, PoisonError};

use bevy::prelude::*;
use bevy::render::error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy};
use bevy::render::settings::RenderCreation;

use super::StudioError;
use super::notice::Notices;
use super::start_up::RunInProgress;

/// Why drawing ended for good, if it did. What opened the window reads it after the window is closed.
#[derive(Resource, Debug, Clone, Default)]
pub(super) struct Failure(Arc<Mutex<Option<String>>>);

impl Failure {
    /// What is known of it.
    pub fn message(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// In the environment: how often the program has opened itself again.
const REOPENED: &str = "SNAKES_REOPENED";
/// A driver that has failed so often will fail again.
const MOST_REOPENINGS: u32 = 3;

/// How often a device was lost.
#[derive(Resource, Debug, Default)]
struct Losses(u32);

/// A device that is lost more often than this in a session will be lost again.
const MOST_LOSSES: u32 = 5;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Losses>()
        .insert_resource(RenderErrorHandler(recover))
        .add_systems(Startup, say_if_reopened);
}

/// How often the program has opened itself again.
fn reopenings() -> u32 {
    std::env::var(REOPENED).ok().and_then(|text| text.parse().ok()).unwrap_or(0)
}

fn say_if_reopened(mut notices: ResMut<Notices>) {
    if reopenings() > 0 {
        notices.problem(
            "The graphics driver failed, and the studio was opened again. Evolution goes on where it was; runs \
             begun later are under \"Continue a stopped run\"."
                .to_owned(),
        );
    }
}

/// Opens the program again if this panic is the graphics driver's or, if that is in vain, ends it with a message.
/// Returns if it is another panic.
///
/// A panic of the renderer ends in a second one while its buffers are dropped, which ends the process without a word.
pub(super) fn outlive(info: &PanicHookInfo<'_>, run_folder: &RunInProgress) {
    if !info.location().is_some_and(|place| place.file().contains("wgpu")) {
        return;
    }
    if reopenings() < MOST_REOPENINGS {
        reopen();
    }
    let said = info.payload_as_str().unwrap_or_default().lines().next().unwrap_or_default();
    let message = format!("the graphics driver failed ({said})");
    // Whoever holds the folder's name cannot let go of it any more.
    let run = run_folder.try_lock().ok().and_then(|mut run| run.take());
    // Nothing is left to do if standard error is gone.
    let _ = writeln!(std::io::stderr(), "error: {}", StudioError::Crashed { message, run });
    std::process::exit(1)
}

/// Replaces this process by a new one: its locks are released, and the run's folder is free.
#[cfg(unix)]
fn reopen() {
    use std::os::unix::process::CommandExt;
    let Ok(program) = std::env::current_exe() else { return };
    let arguments = again(std::env::args_os().skip(1));
    let mut command = std::process::Command::new(program);
    // It returns only if there is no new process.
    let _ = command.args(arguments).env(REOPENED, (reopenings() + 1).to_string()).exec();
}

/// The arguments to open the program with once more. A run that was to begin anew has begun; now it is to go on.
#[cfg(unix)]
fn again(arguments: impl Iterator<Item = OsString>) -> impl Iterator<Item = OsString> {
    arguments.filter(|argument| argument != "--restart")
}

/// Elsewhere no process can be replaced by another; the message says how to go on.
#[cfg(not(unix))]
fn reopen() {}

/// Asks for another device, or gives up in good order.
fn recover(error: &RenderError, studio: &mut World, _: &mut World) -> RenderErrorPolicy {
    let mut losses = studio.resource_mut::<Losses>();
    losses.0 += 1;
    let is_lost = matches!(error.ty, ErrorType::DeviceLost | ErrorType::OutOfMemory);
    if is_lost && losses.0 <= MOST_LOSSES {
        studio.resource_mut::<Notices>().problem(
            "The graphics device was lost; drawing begins anew. Evolution goes on meanwhile. If this happens \
             again and again, a smaller window or another graphics driver may help."
                .to_owned(),
        );
        return RenderErrorPolicy::Recover(RenderCreation::default());
    }
    let what = error.description.lines().next().unwrap_or_default();
    let message = format!("the graphics driver failed: {:?} {what}", error.ty);
    let failure = studio.resource::<Failure>().0.clone();
    failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
    studio.write_message(AppExit::error());
    RenderErrorPolicy::StopRendering
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_was_begun_anew_is_not_thrown_away_when_the_studio_opens_again() {
        let given = ["--seed", "7", "--restart", "--preset", "quick"].map(OsString::from);
        let again: Vec<OsString> = again(given.into_iter()).collect();
        assert_eq!(again, ["--seed", "7", "--preset", "quick"]);
    }
}
