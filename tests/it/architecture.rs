//! The invariants of `src/lib.rs` that a scan of the source can check.

use std::fs;
use std::path::{Path, PathBuf};

fn source() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every source file: its path below `src/` with forward slashes, and its text without tests.
fn files() -> Vec<(String, String)> {
    fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    let mut paths = Vec::new();
    collect(&source(), &mut paths);
    paths.sort();
    let relative = |path: &Path| {
        let path = path.strip_prefix(source()).expect("below src");
        path.to_string_lossy().replace('\\', "/")
    };
    let text = |path: &Path| {
        let text = fs::read_to_string(path).expect("read");
        text.split("#[cfg(test)]").next().unwrap_or_default().to_owned()
    };
    paths.iter().map(|path| (relative(path), text(path))).collect()
}

/// The modules in the order of the pipeline: each may use those before it, none after it.
const PIPELINE: [&str; 12] = [
    "check", "rng", "world", "genome", "control", "score", "evolve", "save", "run", "plot",
    "studio", "cli",
];

/// Lines that are code, not comment.
fn code(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.trim_start().starts_with("//"))
}

#[test]
fn imports_are_written_so_that_a_scan_sees_them() {
    for (path, text) in files() {
        for grouped in ["use crate::{", "use std::{"] {
            let found = code(&text).find(|line| line.trim_start().starts_with(grouped));
            assert_eq!(
                found, None,
                "src/{path}: one use per module, so that this test can read it"
            );
        }
    }
}

#[test]
fn every_module_uses_only_those_before_it() {
    for (path, text) in files() {
        let module = path.split(['/', '.']).next().unwrap_or_default();
        let Some(place) = PIPELINE.iter().position(|known| *known == module) else {
            assert!(["lib", "main"].contains(&module), "{path} is in no module of the pipeline");
            continue;
        };
        for later in &PIPELINE[place + 1..] {
            let uses = code(&text).any(|line| line.contains(&format!("crate::{later}")));
            assert!(!uses, "src/{path} uses crate::{later}, which comes after {module}");
        }
    }
}

/// Which words may stand in which modules only: word, modules, reason.
const HOMES: [(&str, &[&str], &str); 10] = [
    ("bevy", &["studio"], "the core builds without Bevy"),
    ("egui", &["studio"], "the core builds without egui"),
    ("rapier3d", &["world", "studio"], "only the world knows the physics engine"),
    ("rayon", &["run", "studio"], "a strategy or a world that knew threads could depend on them"),
    ("std::thread", &["run"], "as above"),
    ("std::fs", &["save"], "one place touches files"),
    ("Instant", &["run", "studio"], "a clock must not decide a result"),
    ("SystemTime", &[], "a clock must not decide a result"),
    ("HashMap", &[], "its order differs from run to run"),
    ("HashSet", &[], "its order differs from run to run"),
];

#[test]
fn what_does_not_belong_into_a_module_is_not_there() {
    for (path, text) in files() {
        let module = path.split(['/', '.']).next().unwrap_or_default();
        for (word, homes, reason) in HOMES {
            if !homes.contains(&module) {
                let found = code(&text).find(|line| line.contains(word));
                assert_eq!(found, None, "{word} in src/{path}: {reason}");
            }
        }
    }
}

#[test]
fn only_the_simulation_steps_the_engine() {
    for (path, text) in files() {
        // The bench steps rapier bare on purpose: it is what we compare with.
        let allowed = ["world/simulation.rs", "run/bench.rs"].contains(&path.as_str());
        for step in
            ["physics.step(", "physics_mut().step(", ".step_with_events(", ".step_simulation("]
        {
            let steps = code(&text).any(|line| line.contains(step));
            assert!(!steps || allowed, "src/{path} steps the engine itself");
        }
    }
}

#[test]
fn every_file_opens_with_what_it_is_for() {
    for (path, text) in files() {
        assert!(text.starts_with("//!"), "src/{path} does not open with //!");
    }
}
