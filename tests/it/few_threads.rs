//! The program where the system refuses it threads: it does its work or says what is missing, and never panics.

use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Output};

use super::program::{CLIMBER, folder};

/// Number of a user of whom no other process is, for tests that run as root: no limit binds root.
const OTHER_USER: u32 = 61_234;

/// Runs the folder's program, which may have this number of threads.
fn run_with_threads(folder: &Path, threads: u32, arguments: &str) -> Output {
    let script = format!("ulimit -u {threads}; exec ./snakes {arguments}");
    let mut command = Command::new("bash");
    command.args(["-c", &script]).current_dir(folder).env("HOME", folder);
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    if fs::metadata("/proc/self").expect("this process").uid() == 0 {
        command.uid(OTHER_USER).gid(OTHER_USER);
    }
    command.output().expect("bash starts")
}

#[test]
fn f8_without_threads_a_command_does_its_work_or_says_so_in_one_line() {
    let folder = folder();
    fs::set_permissions(folder.path(), Permissions::from_mode(0o777)).expect("opened to all");
    fs::copy(CLIMBER, folder.path().join("climber.ron")).expect("copied");
    // The other user may be refused the folder in which Cargo builds the program.
    fs::copy(env!("CARGO_BIN_EXE_snakes"), folder.path().join("snakes")).expect("copied");
    for threads in 1..=6 {
        for arguments in [
            "exam climber.ron --suite step-rate",
            "exam climber.ron --trials 3",
            "export climber.ron -o a.parquet",
            "export climber.ron -o a.urdf",
            "replay climber.ron --no-render",
            "run --population 4 --generations 1 --duration 0.2 --out out --restart",
            "study methods --strategies random --controllers gait --seeds 2 --evaluations 8 \
             --population 4 --duration 0.2 --out study --restart",
            #[cfg(feature = "cluster")]
            "worker --nats nats://127.0.0.1:1",
        ] {
            let output = run_with_threads(folder.path(), threads, arguments);
            let said = String::from_utf8_lossy(&output.stderr);
            let errors: Vec<&str> =
                said.lines().filter(|line| line.starts_with("error: ")).collect();
            let is_told = match (output.status.code(), &errors[..]) {
                (Some(0), []) => true,
                (Some(1), [error]) => {
                    error.starts_with("error: threads: cannot be started: ")
                        || error.contains("no server answers")
                }
                _ => false,
            };
            assert!(
                is_told && !said.contains("panicked"),
                "{threads} threads, {arguments}: {:?}\n{said}",
                output.status
            );
            if threads == 1 && arguments.starts_with("exam") {
                assert_eq!(errors.len(), 1, "the limit binds: {said}");
            }
        }
    }
}
