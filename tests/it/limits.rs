//! The program where the system limits it: sizes of files, open files, time of the processor, readers that leave. It says what happened
//! and leaves nothing half written behind.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use super::program::{CLIMBER, folder, json_lines, snakes};

/// Runs the program in a folder, with these limits of the shell.
fn run_within(folder: &Path, limits: &str, arguments: &str) -> Output {
    let script =
        format!("ulimit -Sc 0; {limits}; exec {} {arguments}", env!("CARGO_BIN_EXE_snakes"));
    let mut command = Command::new("bash");
    command.args(["-c", &script]).current_dir(folder).env("HOME", folder);
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command.output().expect("bash starts")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn s1_too_many_open_files_are_told_in_the_words_of_the_system() {
    let folder = folder();
    let export = format!("export {CLIMBER} -o a.urdf");
    let mut refusals = 0;
    for files in 5..=12 {
        for arguments in
            [&export, "run --population 4 --generations 1 --duration 0.2 --restart --out out"]
        {
            let output = run_within(folder.path(), &format!("ulimit -n {files}"), arguments);
            let said = said(&output);
            let is_told =
                said.contains("Too many open files") || said.contains("cannot be started");
            assert!(output.status.success() || is_told, "{files} {arguments}: {said}");
            refusals += u32::from(!output.status.success());
        }
    }
    assert!(refusals > 0, "some limit is too low");
}

#[test]
fn s2_a_file_beyond_the_largest_size_is_an_error_that_leaves_nothing() {
    let folder = folder();
    for name in ["a.csv", "a.parquet", "a.html", "a.glb"] {
        fs::write(folder.path().join(name), "an earlier one").expect("written");
        let output =
            run_within(folder.path(), "ulimit -f 20", &format!("export {CLIMBER} -o {name}"));
        let told = format!("error: {name}: cannot be written: File too large (os error 27)\n");
        assert_eq!((output.status.code(), said(&output)), (Some(1), told));
        let kept = fs::read_to_string(folder.path().join(name)).expect("a file");
        assert_eq!(kept, "an earlier one");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 4);
    let order = "run --population 40 --generations 300 --duration 0.2 --out out";
    let output = run_within(folder.path(), "ulimit -f 20", order);
    let said = said(&output);
    assert!(said.contains("File too large") && said.contains("--resume out/"), "{said}");
}

#[test]
fn s2_a_run_whose_time_of_the_processor_is_spent_stops_after_a_generation() {
    let folder = folder();
    let order = "run --population 40 --generations 10000 --duration 1 --out out";
    let output = run_within(folder.path(), "ulimit -St 2", order);
    let said = said(&output);
    assert_eq!(output.status.code(), Some(1), "{:?}: {said}", output.status);
    assert!(
        said.contains("cancelled after generation ") && said.contains("--resume out/"),
        "{said}"
    );
}

#[test]
fn s7_a_run_whose_reader_leaves_says_what_is_saved_and_how_to_continue() {
    let folder = folder();
    let order = "run --json --population 8 --generations 60 --duration 0.2 --out out";
    let mut child = snakes(folder.path(), order)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("ended");
    let said = said(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    let error = said.lines().last().expect("an error");
    assert!(error.contains("Broken pipe") && error.contains("; generations up to "), "{said}");
    let (_, resume) = error.split_once("continue the run with: snakes ").expect("a command");
    let continued = json_lines(folder.path(), &format!("{resume} --json"));
    let undisturbed = json_lines(folder.path(), &order.replace("out out", "out other"));
    assert_eq!(continued.len(), undisturbed.len());
    assert_eq!(
        continued.last().map(|done| &done["run_hash"]),
        undisturbed.last().map(|done| &done["run_hash"])
    );
}
