//! Recovery from a lost graphics device, for example after a driver restart or a switch between two GPUs.
//!
//! If the renderer reports the loss, drawing restarts on another device. Usually the renderer panics in the middle of a
//! frame instead, and the process cannot draw again. The program then restarts itself with the same arguments, and the
//! run continues from its folder.

#[cfg(unix)]
use std::ffi::OsString;

use std::panic::PanicHookInfo;
use std::sync::{Mutex, PoisonError};

use bevy::prelude::*;
use bevy::render::error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy};
use bevy::render::settings::RenderCreation;

use crate::studio::error::StudioError;
use crate::studio::state::run_context::RunInProgress;
use crate::studio::ui::notifications::Notices;
use snakes_lab::run::headless::say;

/// Reason why drawing ended for good, if it did.
static FAILURE: Mutex<Option<String>> = Mutex::new(None);

/// Returns the reason why drawing ended, or `None` while drawing works.
pub(crate) fn failure() -> Option<String> {
    FAILURE.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Name of the environment variable that counts how often the program has restarted itself.
const REOPENED: &str = "SNAKES_REOPENED";
/// Maximum number of restarts. A driver that fails more often is unlikely to recover.
const MAX_RESTARTS: u32 = 3;

/// Number of times that the graphics device was lost since the start of the program.
#[derive(Resource, Debug, Default)]
struct Losses(u32);

/// Maximum number of lost devices before drawing ends for good.
const MAX_LOSSES: u32 = 5;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Losses>()
        .insert_resource(RenderErrorHandler(recover))
        .add_systems(Startup, report_restart);
}

/// Reads from the environment how often the program has restarted itself.
fn restarts() -> u32 {
    std::env::var(REOPENED).ok().and_then(|text| text.parse().ok()).unwrap_or(0)
}

fn report_restart(mut notices: ResMut<Notices>) {
    if restarts() > 0 {
        notices.problem(
            "The graphics driver failed and the studio restarted. The run with which it was opened continues; \
             any other run is listed under \"Open an earlier run\"."
                .to_owned(),
        );
    }
}

/// Restarts the program if the graphics driver caused the panic. Exits with an error message if the restart fails.
/// Returns if the panic has another cause.
///
/// After a panic in the renderer, dropping its buffers panics again, which would abort the process without a message.
pub(crate) fn recover_or_exit(info: &PanicHookInfo<'_>, run_folder: &RunInProgress) {
    if !info.location().is_some_and(|place| place.file().contains("wgpu")) {
        return;
    }
    if restarts() < MAX_RESTARTS {
        restart_program();
    }
    let said = info.payload_as_str().unwrap_or_default().lines().next().unwrap_or_default();
    let message = format!("the graphics driver failed ({said})");
    // The panicking thread may hold this lock, so do not block on it.
    let run = run_folder.try_lock().ok().and_then(|mut run| run.take());
    say(&format!("error: {}", StudioError::Crashed { message, run }));
    std::process::exit(1)
}

/// Replaces the process by a new one. This releases all locks, including that of the run's folder.
#[cfg(unix)]
fn restart_program() {
    use std::os::unix::process::CommandExt;
    let Ok(program) = std::env::current_exe() else { return };
    let arguments = restart_arguments(std::env::args_os().skip(1));
    let mut command = std::process::Command::new(program);
    // `exec` returns only on failure.
    let _ = command.args(arguments).env(REOPENED, (restarts() + 1).to_string()).exec();
}

/// Returns the arguments for the new process, without `--restart`: the run has begun and must continue now.
#[cfg(unix)]
fn restart_arguments(arguments: impl Iterator<Item = OsString>) -> impl Iterator<Item = OsString> {
    arguments.filter(|argument| argument != "--restart")
}

/// Does nothing where a process cannot be replaced. The error message then explains how to continue.
#[cfg(not(unix))]
fn restart_program() {}

/// Requests a new graphics device, or gives up with a message after too many losses.
fn recover(error: &RenderError, studio: &mut World, _: &mut World) -> RenderErrorPolicy {
    let mut losses = studio.resource_mut::<Losses>();
    losses.0 += 1;
    let is_lost = matches!(error.ty, ErrorType::DeviceLost | ErrorType::OutOfMemory);
    if is_lost && losses.0 <= MAX_LOSSES {
        studio.resource_mut::<Notices>().problem(
            "The graphics device was lost; drawing restarts and evolution continues. If this happens \
             repeatedly, try a smaller window or another graphics driver."
                .to_owned(),
        );
        return RenderErrorPolicy::Recover(RenderCreation::default());
    }
    let what = error.description.lines().next().unwrap_or_default();
    let message = format!("the graphics driver failed: {:?} {what}", error.ty);
    FAILURE.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
    studio.write_message(AppExit::error());
    RenderErrorPolicy::StopRendering
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_continues_a_run_that_was_started_afresh() {
        let given = ["--seed", "7", "--restart", "--preset", "quick"].map(OsString::from);
        let again: Vec<OsString> = restart_arguments(given.into_iter()).collect();
        assert_eq!(again, ["--seed", "7", "--preset", "quick"]);
    }
}
