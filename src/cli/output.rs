//! Standard output, and requests to end the program.

use std::io::{self, Write};
#[cfg(unix)]
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

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

/// Control that a request to end the program cancels; `None` before the first.
static CANCELLED_AT_END: Mutex<Option<Arc<RunControl>>> = Mutex::new(None);

/// Returns a control that a request to end the program cancels: the interrupt key, or a signal of the system. It replaces any earlier
/// control.
pub fn cancel_on_interrupt() -> Arc<RunControl> {
    let current = || CANCELLED_AT_END.lock().unwrap_or_else(PoisonError::into_inner);
    let control = Arc::new(RunControl::default());
    let is_first = current().replace(Arc::clone(&control)).is_none();
    if is_first {
        // If the handler cannot be set, such a request ends the program at once, and files written so far are complete.
        let _ = at_requests_to_end(move || {
            if let Some(control) = current().as_ref() {
                control.cancel();
            }
        });
    }
    control
}

/// Calls `act` at each request to end the program: the interrupt key, SIGTERM and, when the terminal is closed, SIGHUP.
#[cfg(unix)]
fn at_requests_to_end(mut act: impl FnMut() + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut requests = vec![SIGINT, SIGTERM];
    if !is_ignored(SIGHUP) {
        requests.push(SIGHUP);
    }
    let mut signals = signal_hook::iterator::Signals::new(requests)?;
    snakes_lab::run::BackgroundTask::start(move || signals.forever().for_each(|_| act())).map(drop)
}

/// Returns whether the program ignores a signal, as `nohup` makes it ignore SIGHUP. Where the system does not tell, it may.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = snakes_core::save::load_text(Path::new("/proc/self/status")).unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    ignored.is_none_or(|bits| (bits >> (signal - 1)) & 1 == 1)
}

/// Calls `act` at each request to end the program: Ctrl-C and Ctrl-Break. When the console is closed, Windows ends the program soon after
/// the request.
#[cfg(windows)]
fn at_requests_to_end(act: impl FnMut() + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(act)
}
