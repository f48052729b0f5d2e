//! Standard output, and requests to end the program.

use std::io;
#[cfg(unix)]
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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

/// Control that a request to end the program cancels; `None` before the first.
static CANCELLED_AT_END: Mutex<Option<Arc<RunControl>>> = Mutex::new(None);

fn current() -> MutexGuard<'static, Option<Arc<RunControl>>> {
    CANCELLED_AT_END.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns whether the user or the system has requested the end since the latest control was made. Before the first control, such a
/// request ends the program.
#[cfg(feature = "cluster")]
pub fn is_interrupted() -> bool {
    current().as_ref().is_some_and(|control| control.is_cancelled())
}

/// Returns a control that a request to end the program cancels: the interrupt key, or a signal of the system. It replaces any earlier
/// control.
///
/// # Errors
/// Fails if the system refuses the thread that waits for such a request, which would then have no effect.
pub fn cancel_on_interrupt() -> Result<Arc<RunControl>, CliError> {
    let control = Arc::new(RunControl::default());
    let is_first = current().replace(Arc::clone(&control)).is_none();
    if is_first {
        let cancel = move || {
            if let Some(control) = current().as_ref() {
                control.cancel();
            }
        };
        at_requests_to_end(cancel)
            .map_err(|error| HeadlessError::from(WorkersError::from(error)))?;
    }
    Ok(control)
}

/// Makes a write beyond the largest size of files (`ulimit -f`) fail with an error that can be told. By default the system ends the program
/// without a word, and a file that is half written stays.
#[cfg(unix)]
pub fn survive_large_files() {
    let flag = Arc::new(std::sync::atomic::AtomicBool::new(false));
    // Where no handler can be set, the system does as by default.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, flag);
}

/// Calls `act` at each request to end the program: the interrupt key, SIGTERM, when the terminal is closed SIGHUP, and when the allowed
/// time of the processor (`ulimit -St`, or a queue of a computing centre) is spent SIGXCPU.
#[cfg(unix)]
fn at_requests_to_end(mut act: impl FnMut() + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXCPU};
    let mut requests = vec![SIGINT, SIGTERM, SIGXCPU];
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
fn at_requests_to_end(act: impl FnMut() + Send + 'static) -> io::Result<()> {
    ctrlc::set_handler(act).map_err(|error| match error {
        ctrlc::Error::System(error) => error,
        other => io::Error::other(other),
    })
}
