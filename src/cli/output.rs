//! Standard output, and the interrupt key.

use std::io::{self, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde_json::{Value, json};

use super::error::CliError;
use snakes_lab::run::RunControl;
use snakes_lab::run::headless::HeadlessError;

/// Writes to standard output. A reader that stops early (`snakes show presets | head -1`) causes no error.
pub fn print(text: &str) -> Result<(), CliError> {
    match io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other.map_err(HeadlessError::from)?),
    }
}

/// Writes a line of JSON to standard output.
pub fn print_json(line: &Value) -> Result<(), CliError> {
    print(&format!("{line}\n"))
}

/// Prints a list of things of one kind, each with its name and a sentence about it.
pub fn print_names(kind: &str, things: &[(String, String)], as_json: bool) -> Result<(), CliError> {
    let width = things.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, about): &(String, String)| match as_json {
        true => format!("{}\n", json!({"type": kind, "name": name, "about": about})),
        false => format!("{name:<width$}  {about}\n"),
    };
    print(&things.iter().map(line).collect::<String>())
}

/// Control that the interrupt key cancels; `None` before the first.
static CANCELLED_BY_KEY: Mutex<Option<Arc<RunControl>>> = Mutex::new(None);

fn current() -> MutexGuard<'static, Option<Arc<RunControl>>> {
    CANCELLED_BY_KEY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns whether the interrupt key was pressed since the latest control was made. Before the first, the key ends the program.
#[cfg(feature = "cluster")]
pub fn is_interrupted() -> bool {
    current().as_ref().is_some_and(|control| control.is_cancelled())
}

/// Returns a control that the interrupt key cancels. It replaces any earlier control.
pub fn cancel_on_interrupt() -> Arc<RunControl> {
    let control = Arc::new(RunControl::default());
    let is_first = current().replace(Arc::clone(&control)).is_none();
    if is_first {
        // If the handler cannot be set, the key ends the program at once, and files written so far are complete.
        let _ = ctrlc::set_handler(move || {
            if let Some(control) = current().as_ref() {
                control.cancel();
            }
        });
    }
    control
}
