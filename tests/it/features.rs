//! The window must not change how the core is compiled.
//!
//! Cargo builds a shared dependency once, with the features that all its users request together. A feature that the window enables
//! in the physics engine could change bits, but the reference would show this only in the program with its window. Python, pages
//! and the command line alone are built without the window, so this test compares the features themselves.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Packages that decide the bits of a run: arithmetic, physics, random numbers, and orders of iteration.
const DECISIVE: [&str; 17] = [
    "approx",
    "ena",
    "glam",
    "glamx",
    "libm",
    "matrixmultiply",
    "nalgebra",
    "num-traits",
    "parry3d",
    "rand",
    "rand_chacha",
    "rand_core",
    "rapier3d",
    "rstar",
    "simba",
    "spade",
    "wide",
];

/// Features that only the window and the connection to other machines request. None of them changes a computation: debug lines,
/// conversions, serialisation, further generators of random numbers.
const HARMLESS: [(&str, &[&str]); 4] = [
    ("glam", &["bytemuck", "encase", "rand", "serde"]),
    ("nalgebra", &["default"]),
    ("rand", &["alloc", "default", "std", "std_rng", "sys_rng", "thread_rng"]),
    ("rapier3d", &["debug-render"]),
];

/// Returns the features of each decisive package, by name and version.
fn features(arguments: &[&str]) -> BTreeMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--offline", "--edges", "normal", "--prefix", "none"])
        .args(["--package", "snakes-and-stairs"])
        .args(["--format", "{p}\t{f}", "--manifest-path"])
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"))
        .args(arguments)
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let mut found = BTreeMap::new();
    for line in text.lines() {
        let Some((package, features)) = line.split_once('\t') else { continue };
        if DECISIVE.iter().any(|name| package.starts_with(&format!("{name} v"))) {
            let features =
                features.trim_end_matches(" (*)").split(',').filter(|name| !name.is_empty());
            let of_package: &mut BTreeSet<String> = found.entry(package.to_owned()).or_default();
            of_package.extend(features.map(str::to_owned));
        }
    }
    found
}

#[test]
fn the_window_adds_no_feature_that_could_change_bits() {
    let core = features(&["--no-default-features"]);
    let mut with_window = features(&["--features", "studio"]);
    assert_eq!(core.len(), DECISIVE.len(), "one version of each: {core:?}");
    // The connection to other machines brings older versions of the packages for random numbers. No run uses them.
    with_window.retain(|package, _| core.contains_key(package));
    for (package, features) in &mut with_window {
        let harmless =
            HARMLESS.iter().filter(|(name, _)| package.starts_with(&format!("{name} v")));
        for feature in harmless.flat_map(|(_, names)| *names) {
            features.remove(*feature);
        }
    }
    assert_eq!(
        with_window, core,
        "\n\nThe window (left) compiles the core's dependencies with other features than the core alone (right).\n\
         Run `cargo test --release determinism` to see whether bits change. If they do not, and the\n\
         feature has no part in a computation, add it to HARMLESS.\n"
    );
}

#[test]
fn the_stage_holds_worlds_of_the_very_engine_that_computes_them() {
    let lock = include_str!("../../Cargo.lock");
    for package in ["rapier3d", "parry3d"] {
        let versions = lock.matches(&format!("name = \"{package}\"\n")).count();
        assert_eq!(versions, 1, "bevy_rapier3d and the core use one version of {package}");
    }
}
