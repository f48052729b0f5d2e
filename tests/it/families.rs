//! `snakes families`: what is finished is kept, and continues to the same files.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::json;

use super::program::{folder, json_lines, run, snakes, stdout_of};

const TINY: &str =
    "families --families zcs --evaluations 64 --duration 1 --suite step-rate --threads 1";

/// The bytes of the files of results.
fn written(folder: &Path) -> [Vec<u8>; 4] {
    ["families.ron", "families-exam.csv", "families.png", "families/zcs-seed202.ron"]
        .map(|name| fs::read(folder.join(name)).expect(name))
}

#[test]
fn families_killed_after_a_run_continue_to_the_same_files() {
    let folder = folder();
    let arguments = |out: &str, seeds: u32| format!("{TINY} --seeds {seeds} --out {out}");
    let text = stdout_of(folder.path(), &arguments("whole", 3));
    assert!(text.contains("| family |"), "{text}");
    assert!(text.contains("| ≥ 2  | ≥ 4  |"), "{text}");
    let mut child = snakes(folder.path(), &arguments("killed", 3))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let (ron, began) = (folder.path().join("killed/families.ron"), Instant::now());
    while !ron.exists() && began.elapsed() < Duration::from_secs(60) {
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().expect("killed");
    child.wait().expect("ended");
    let output = run(folder.path(), &arguments("killed", 3));
    let progress = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && !progress.contains("3 of 3 runs left"), "{progress}");
    assert_eq!(String::from_utf8_lossy(&output.stdout).replace("killed", "whole"), text);
    let [whole, killed] = ["whole", "killed"].map(|name| written(&folder.path().join(name)));
    assert!(whole == killed, "all files have the same bytes");
    // Nothing is left to do, and JSON has the same runs.
    let lines = json_lines(folder.path(), &format!("{} --json", arguments("whole", 2)));
    assert_eq!(lines[0]["family"], json!("zcs"));
    assert_eq!(lines[0]["run"]["seed"], json!(201));
    assert_eq!(lines[2]["demand"], json!("steps climbed"));
    assert_eq!((lines[2]["must"].clone(), lines[2]["hard"].clone()), (json!(2.0), json!(4.0)));
    let file = lines[1]["file"].as_str().expect("a path");
    let replay = stdout_of(folder.path(), &format!("replay {file} --no-render"));
    assert!(replay.contains("equal to the record, bit for bit"), "{replay}");
    assert_eq!(lines[3]["runs"], json!(2));
}

#[test]
fn runs_with_other_settings_are_refused_until_they_are_restarted() {
    let folder = folder();
    stdout_of(folder.path(), &format!("{TINY} --seeds 1 --out out"));
    let other = TINY.replace("--evaluations 64", "--evaluations 32");
    let output = run(folder.path(), &format!("{other} --seeds 1 --out out"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.contains("families.ron: settings of zcs is ") && message.contains("--restart"),
        "{message}"
    );
    let text = stdout_of(folder.path(), &format!("{other} --seeds 1 --out out --restart"));
    assert!(text.contains("| zcs    |    1 |"), "{text}");
    for (flags, refusal) in [
        ("--families walker", "error: --families is \"walker\"; allowed: all, gait, reflex"),
        ("--evaluations 3", "error: --evaluations is 3; allowed: "),
        ("--seeds 0", "error: --seeds is 0; allowed: 1 to 10000"),
        ("--duration -1", "error: --duration is -1; allowed: 0.1 to 600"),
        ("--suite stars", "error: --suite is \"stars\"; allowed: trials, step-rate"),
    ] {
        let output = run(folder.path(), &format!("families {flags}"));
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.starts_with(refusal), "{flags}: {message}");
    }
}
