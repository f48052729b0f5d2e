//! Standard output, and the interrupt key.

use std::io;
use std::sync::{Arc, Mutex, PoisonError};

use serde_json::{Value, json};

use super::error::CliError;
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::run::terminal::{write_line, write_text};
use snakes_lab::run::{RunControl, WorkersError};

/// Writes a text of several lines to standard output.
pub fn print(text: &str) -> Result<(), CliError> {
    written(write_text(&mut io::stdout(), text))
}

/// Writes a line to standard output, which stays one line whatever is in it.
pub fn print_line(line: &str) -> Result<(), CliError> {
    written(write_line(&mut io::stdout(), line))
}

/// Writes a line of JSON to standard output.
pub fn print_json(line: &Value) -> Result<(), CliError> {
    print_line(&line.to_string())
}

/// Returns the result of writing. A reader that stops early (`snakes show presets | head -1`) causes no error.
fn written(result: io::Result<()>) -> Result<(), CliError> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other.map_err(HeadlessError::from)?),
    }
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

/// Returns a control that the interrupt key cancels. It replaces any earlier control.
///
/// # Errors
/// The system refused the thread that waits for the key. The key would have no effect then.
pub fn cancel_on_interrupt() -> Result<Arc<RunControl>, CliError> {
    let current = || CANCELLED_BY_KEY.lock().unwrap_or_else(PoisonError::into_inner);
    let control = Arc::new(RunControl::default());
    let is_first = current().replace(Arc::clone(&control)).is_none();
    if is_first {
        let cancel = move || {
            if let Some(control) = current().as_ref() {
                control.cancel();
            }
        };
        match ctrlc::set_handler(cancel) {
            Err(ctrlc::Error::System(error)) => {
                return Err(HeadlessError::from(WorkersError::from(error)).into());
            }
            // If the handler cannot be set, the key ends the program at once, and files written so far are complete.
            Ok(()) | Err(_) => {}
        }
    }
    Ok(control)
}
