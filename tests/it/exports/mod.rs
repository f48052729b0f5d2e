//! Exported files, read by the programs for which they are intended.
//!
//! Tests that need such a program are skipped with a line if it is missing, or fail if `SNAKES_PEER_TESTS=required` is set.
//! `SNAKES_PEER_PYTHON` names the Python, which needs the packages in `tests/peers/requirements.txt`. Node needs the packages of
//! `npm install --prefix tests/peers`.

mod creatures;
#[cfg(all(feature = "studio", target_os = "linux"))]
mod films;
mod models;
mod page;
mod scenes;
mod soft;
mod tables;

pub use page::browser;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use snakes_lab::export::{ExportOrder, ExportProgress, ExportSource};
use snakes_lab::run::RunControl;

/// Environment variable that names the Python of the tests.
const PYTHON_VARIABLE: &str = "SNAKES_PEER_PYTHON";

/// Returns the path of a script in `tests/peers`.
fn peer_script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers").join(name)
}

/// Returns a command that runs a program, if the program succeeds with the arguments `probe`. Otherwise prints a line that the test
/// is skipped.
fn peer(program: &str, probe: &[&str], test: &str) -> Option<Command> {
    let found = Command::new(program).args(probe).output();
    if found.as_ref().is_ok_and(|output| output.status.success()) {
        return Some(Command::new(program));
    }
    let reason = match found {
        Err(error) => error.to_string(),
        Ok(output) => {
            let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
            said.lines().last().unwrap_or_default().to_owned()
        }
    };
    assert!(
        std::env::var("SNAKES_PEER_TESTS").as_deref() != Ok("required"),
        "{test} needs {program} {probe:?}: {reason}"
    );
    // The line bypasses the test harness, which would hide it if the test passes.
    let _ = writeln!(std::io::stderr(), "skipped: {test} needs {program} {probe:?}: {reason}");
    None
}

/// Returns a command that runs Python, if it has these modules.
fn peer_python(modules: &str, test: &str) -> Option<Command> {
    let python = std::env::var(PYTHON_VARIABLE).unwrap_or_else(|_| "python3".to_owned());
    peer(&python, &["-c", &format!("import {modules}")], test)
}

/// Exports to a file whose ending decides the format.
fn export(source: ExportSource, path: &Path) {
    let order = ExportOrder::new(source, path.to_owned()).expect("a known ending");
    order.carry_out(&ExportProgress::new(&|_| (), &RunControl::default())).expect("written");
}

/// Runs a command, which must succeed, and returns its standard output.
pub fn succeed(command: &mut Command) -> String {
    let output = command.output().expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{text}\n{said}");
    text
}
