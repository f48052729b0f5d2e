//! Lines for the terminal. Everything that the program prints passes here: names of files and runs, and messages of systems and
//! servers, cannot act on the terminal.

use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

use indicatif::ProgressBar;

use snakes_core::check::printable;

/// The bar that is currently drawn on the terminal.
static DRAWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// Sets the bar that [`say`] hides while it writes; `None` if no bar is drawn.
pub(super) fn set_drawn(bar: Option<ProgressBar>) {
    *DRAWN.lock().unwrap_or_else(PoisonError::into_inner) = bar;
}

/// Writes a line for the user to standard error. Standard output is reserved for results.
pub fn say(line: &str) {
    // If standard error is closed, there is nowhere to report the failure.
    let write = || drop(write_line(&mut io::stderr(), line));
    let bar = DRAWN.lock().unwrap_or_else(PoisonError::into_inner).clone();
    match bar {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Writes a line of text or JSON.
///
/// # Errors
/// `out` failed.
pub fn write_line(out: &mut dyn Write, line: &str) -> io::Result<()> {
    writeln!(out, "{}", printable(line))
}

/// Writes a text of several lines, such as a table or a page of the manual, which ends with a line break.
///
/// # Errors
/// `out` failed.
pub fn write_text(out: &mut dyn Write, text: &str) -> io::Result<()> {
    text.split_inclusive('\n').try_for_each(|line| match line.strip_suffix('\n') {
        Some(line) => write_line(out, line),
        None => write!(out, "{}", printable(line)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f9_a_line_stays_one_line_and_a_text_keeps_its_lines() {
        let mut out = Vec::new();
        write_line(&mut out, "a\nb \u{1b}[2J").expect("in memory");
        write_text(&mut out, "c\u{9b}m\n\nd").expect("in memory");
        assert_eq!(String::from_utf8_lossy(&out), "a b \\u001b[2J\nc\\u009bm\n\nd");
    }
}
