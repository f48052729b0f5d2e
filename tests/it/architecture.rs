//! The invariants of `src/lib.rs` that a scan of the source can check.

use std::fs;
use std::path::{Path, PathBuf};

fn source() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every source file: its path below `src/` with forward slashes, and its text.
fn all_files() -> Vec<(String, String)> {
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
    paths.iter().map(|path| (relative(path), fs::read_to_string(path).expect("read"))).collect()
}

/// The same without tests.
fn files() -> Vec<(String, String)> {
    let texts = all_files();
    let of_tests: Vec<String> =
        texts.iter().flat_map(|(path, text)| test_files(path, text)).collect();
    for path in &of_tests {
        assert!(texts.iter().any(|(of, _)| of == path), "src/{path} is declared, and not there");
    }
    // What is below a file of tests is of tests, too.
    let is_of_tests = |path: &String| {
        let is_below = |of: &String| path.starts_with(&of.replace(".rs", "/"));
        of_tests.iter().any(|of| path == of || is_below(of))
    };
    texts
        .into_iter()
        .filter(|(path, _)| !is_of_tests(path))
        .map(|(path, text)| (path, without_tests(&text)))
        .collect()
}

/// The files of modules that a file declares for tests only.
fn test_files(path: &str, text: &str) -> Vec<String> {
    let folder = path.strip_suffix("/mod.rs").or(path.strip_suffix(".rs")).expect("a source file");
    let declared = text.split("#[cfg(test)]\n").skip(1).filter_map(|after| {
        let (head, _) = after.lines().next()?.split_once(';')?;
        let (_, name) = head.split_once("mod ")?;
        Some(format!("{folder}/{name}.rs"))
    });
    declared.collect()
}

/// A file's text without its modules of tests. What else is only there in tests stays.
fn without_tests(text: &str) -> String {
    let mut rest = text;
    let mut kept = String::new();
    while let Some((before, after)) = rest.split_once("#[cfg(test)]\n") {
        kept += before;
        let head = after.lines().next().unwrap_or_default();
        let is_module = head.contains("mod ") && head.ends_with('{');
        // Its closing brace is the first that stands at the margin.
        rest = match after.split_once("\n}\n") {
            Some((_, after_it)) if is_module => after_it,
            _ => after,
        };
    }
    kept + rest
}

#[test]
fn a_file_is_scanned_to_its_end_but_for_its_tests() {
    let text = "a\n#[cfg(test)]\nfn b() {\n}\n#[cfg(test)]\nmod tests {\n    c\n}\nd\n";
    assert_eq!(without_tests(text), "a\nfn b() {\n}\nd\n");
    let text = "mod a;\n#[cfg(test)]\npub(super) mod tests;\nmod b;\n";
    assert_eq!(test_files("studio/mod.rs", text), ["studio/tests.rs"]);
    assert_eq!(test_files("studio/lane.rs", text), ["studio/lane/tests.rs"]);
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
    for (path, text) in all_files() {
        assert!(text.starts_with("//!"), "src/{path} does not open with //!");
    }
}
