//! Standard output, and the interrupt key.

use std::io::{self, Write};
use std::sync::Arc;

use super::error::CliError;
use crate::run::RunControl;
use crate::run::headless::HeadlessError;

/// Writes to standard output. A reader that stops early (`snakes presets | head -1`) is no error.
pub fn print(text: &str) -> Result<(), CliError> {
    match io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other.map_err(HeadlessError::from)?),
    }
}

/// A control that the interrupt key cancels.
pub fn cancel_on_interrupt() -> Arc<RunControl> {
    let control = Arc::new(RunControl::default());
    let cancelled = Arc::clone(&control);
    // Without a handler the key ends the program at once; files written by then are whole.
    let _ = ctrlc::set_handler(move || cancelled.cancel());
    control
}
