//! Runs the program and reads its output.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// Path of a champion that climbs the stairs and stands on the landing.
pub const CLIMBER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/climber.ron");

/// Returns a command that runs the program under test in `folder`.
pub fn snakes(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_snakes"));
    command.args(arguments.split_whitespace()).current_dir(folder);
    // A test must not use the display or the saves of the user who runs it.
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command.env("HOME", folder).env("XDG_DATA_HOME", folder.join("data"));
    // A software driver compiles its programs for seconds. It keeps them in the home folder, which is a new one for each test.
    command.env("MESA_SHADER_CACHE_DIR", concat!(env!("CARGO_TARGET_TMPDIR"), "/mesa"));
    command
}

/// Returns a command like [`snakes`] whose program obeys SIGHUP and SIGINT even where the tests ignore them: under `nohup`, or in the
/// background of a script.
pub fn interruptible_snakes(folder: &Path, arguments: &str) -> Command {
    let snakes = snakes(folder, arguments);
    let mut command = Command::new("env");
    command.arg("--default-signal=HUP,INT").arg(snakes.get_program()).args(snakes.get_args());
    for (name, value) in snakes.get_envs() {
        match value {
            Some(value) => command.env(name, value),
            None => command.env_remove(name),
        };
    }
    command.current_dir(folder);
    command
}

/// Runs the program until it ends.
pub fn run(folder: &Path, arguments: &str) -> Output {
    snakes(folder, arguments).output().expect("the program starts")
}

/// Runs the program, which must succeed, and returns its standard output.
pub fn stdout_of(folder: &Path, arguments: &str) -> String {
    let output = run(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "snakes {arguments}: {:?}\n{stderr}", output.status);
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Runs the program, which must succeed, and returns the JSON objects on its standard output, one per line.
pub fn json_lines(folder: &Path, arguments: &str) -> Vec<Value> {
    json_of(stdout_of(folder, arguments).as_bytes())
}

/// Returns the JSON objects on a program's standard output, one per line.
pub fn json_of(stdout: &[u8]) -> Vec<Value> {
    let text = std::str::from_utf8(stdout).expect("UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("a JSON object")).collect()
}

/// Returns the only run in a folder of saves; `None` if there is none yet.
pub fn run_in(saves: &Path) -> Option<PathBuf> {
    let mut runs = fs::read_dir(saves).ok()?.map(|entry| entry.expect("an entry").path());
    let run = runs.next()?;
    assert_eq!(runs.next(), None, "one run only");
    Some(run)
}

/// Cuts the log of a run to the state after a kill that followed this number of generations.
pub fn cut_log(run: &Path, generations: usize) {
    let log = run.join("log.jsonl");
    let text = fs::read_to_string(&log).expect("a log");
    let first: String = text.split_inclusive('\n').take(generations).collect();
    fs::write(log, first).expect("written");
}

/// Returns a text with the slashes of Windows paths turned forward.
pub fn with_slashes(text: &str) -> String {
    text.replace('\\', "/")
}

/// Creates a temporary folder, which is removed when it is dropped.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}
