//! `snakes study`: finished runs are kept, and an interrupted study ends with the same files.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::json;

use super::program::{folder, json_lines, run, snakes, stdout_of};

const TINY: &str =
    "study families --arms zcs --evaluations 64 --duration 1 --suite step-rate --threads 1";

/// Returns the bytes of the files of results.
fn written(folder: &Path) -> [Vec<u8>; 5] {
    [
        "families.ron",
        "families-runs.csv",
        "families-results.csv",
        "families.png",
        "families/zcs-seed202.ron",
    ]
    .map(|name| fs::read(folder.join(name)).expect(name))
}

#[test]
fn a_study_killed_after_a_run_continues_to_the_same_files() {
    let folder = folder();
    let arguments = |out: &str, seeds: u32| format!("{TINY} --seeds {seeds} --out {out}");
    let text = stdout_of(folder.path(), &arguments("whole", 3));
    assert!(text.contains("| arm ") && text.contains("| ≥ 2  | ≥ 4  |"), "{text}");
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
    // The whole study has no work left, and its JSON contains the runs.
    let lines = json_lines(folder.path(), &format!("{} --json", arguments("whole", 2)));
    assert_eq!((&lines[0]["type"], &lines[0]["arm"]), (&json!("run"), &json!("zcs")));
    assert_eq!(lines[0]["seed"], json!(201));
    let demand = lines.iter().find(|line| line["type"] == json!("demand")).expect("a demand");
    assert_eq!(demand["demand"], json!("steps"));
    assert_eq!((demand["must"].clone(), demand["hard"].clone()), (json!(2.0), json!(4.0)));
    let file = lines[1]["champion"].as_str().expect("a path");
    let replay = stdout_of(folder.path(), &format!("replay {file} --no-render"));
    assert!(replay.contains("equal to the record, bit for bit"), "{replay}");
    let last = lines.last().expect("a line");
    assert_eq!((&last["type"], &last["runs"]), (&json!("done"), &json!(2)));
}

#[test]
fn r5_methods_tell_the_evaluations_and_simulations_that_each_arm_spent() {
    let folder = folder();
    let order = "study methods --strategies random,cma_es,ga --controllers gait --seeds 1 --evaluations 50 --population 20 --duration 0.2";
    let text = stdout_of(folder.path(), order);
    let head = text.lines().find(|line| line.starts_with("| arm")).expect("a table");
    assert!(head.contains(" evaluations |") && head.contains(" simulations |"), "{head}");
    let runs: Vec<_> = json_lines(folder.path(), &format!("{order} --json"))
        .into_iter()
        .filter(|line| line["type"] == json!("run"))
        .collect();
    assert_eq!(runs.len(), 3);
    for run in runs {
        // Each spends whole generations of the budget.
        let [spent, simulated] =
            ["evaluations", "simulations"].map(|value| run[value].as_f64().expect("a number"));
        assert!((20.0..=50.0).contains(&spent) && simulated >= spent, "{run}");
    }
}

#[test]
fn a_users_own_study_gives_all_files_and_verdicts() {
    let folder = folder();
    let study = r#"(
        name: "ice",
        title: "Friction",
        seeds: 2,
        evaluations: 24,
        settings: {"evolution.population": 8, "trial.duration_s": 1},
        arms: [(name: "rough"), (name: "smooth", settings: {"surface.friction": 0.1})],
        compare: ["fitness"],
        demands: [(arms: ["smooth"], measure: Difference(of: "fitness"), must: 0)],
    )"#;
    fs::write(folder.path().join("my.ron"), study).expect("written");
    let text = stdout_of(folder.path(), "study my.ron --out out");
    for part in ["Friction\n", "| rough", "| smooth", "fitness, more than rough", "must: "] {
        assert!(text.contains(part), "{part} in {text}");
    }
    for name in ["ice.ron", "ice-runs.csv", "ice-results.csv", "ice.png"] {
        assert!(folder.path().join("out").join(name).exists(), "{name}");
    }
}

#[test]
fn what_a_study_cannot_do_is_refused_by_the_name_of_its_flag() {
    let folder = folder();
    stdout_of(folder.path(), &format!("{TINY} --seeds 1 --out out"));
    let other = TINY.replace("--evaluations 64", "--evaluations 32");
    let output = run(folder.path(), &format!("{other} --seeds 1 --out out"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    let start = "families.ron: settings of zcs is ";
    assert!(message.contains(start) && message.contains("--restart"), "{message}");
    let text = stdout_of(folder.path(), &format!("{other} --seeds 1 --out out --restart"));
    assert!(text.contains("| ZCS |    1 |"), "{text}");
    for (flags, refusal) in [
        ("walkers", "error: study is \"walkers\"; allowed: table1, methods"),
        ("families --arms walker", "error: --arms is \"walker\"; allowed: gait, reflex"),
        ("families --arms zcs --evaluations 3", "error: --evaluations is 3; allowed: "),
        ("families --seeds 0", "error: --seeds is 0; allowed: 1 to 10000"),
        ("families --duration -1", "error: --duration is -1; allowed: 0.1 to 600"),
        ("families --suite stars", "error: --suite is \"stars\"; allowed: trials, step-rate"),
        ("families --strategies ga", "error: --strategies has no effect with this study"),
        ("methods --baseline ga", "error: --baseline is \"ga\"; allowed: halving-signal"),
        ("methods --generations 3", "error: --generations has no effect with this study"),
        ("methods --set strategy=ga", "error: strategy is ga; allowed: no value"),
        ("poet --seeds 3", "error: --seeds has no effect with snakes study poet"),
        ("table1 --rounds 3", "error: --rounds has no effect with this study"),
    ] {
        let output = run(folder.path(), &format!("study {flags}"));
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.starts_with(refusal), "{flags}: {message}");
    }
    let study = r#"(name: "own", title: "Own", evaluations: 64, arms: [(name: "a", settings: {"ga.step": 0.5})])"#;
    fs::write(folder.path().join("own.ron"), study).expect("written");
    let message = run(folder.path(), "study own.ron").stderr;
    let message = String::from_utf8_lossy(&message);
    assert!(message.starts_with("error: own.ron: evolution.ga.step of a is 0.5; "), "{message}");
    let listed = stdout_of(folder.path(), "study");
    assert!(listed.contains("families ") && listed.contains("poet "), "{listed}");
}
