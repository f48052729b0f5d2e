//! The same bits with other compiler settings, on other processors, and under a memory checker.
//!
//! The test builds the program several times and runs it in emulation, which takes about ten minutes:
//!
//!     cargo test --release --no-default-features --test it same_bits -- --ignored --nocapture
//!
//! Cases that need a missing tool (Debian's `qemu-user` and `valgrind`) are skipped; with
//! `SNAKES_SAME_BITS=required` the test fails instead.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use snakes_and_stairs::run::verify::Trajectories;

/// Builds the program into a separate folder and returns its path.
fn build(name: &str, profile: &str, rustflags: &str, settings: &[String]) -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let mut command = Command::new(env!("CARGO"));
    command.args(["build", "--no-default-features", "--locked", "--profile", profile]);
    command.args(["--bin", "snakes", "--manifest-path"]);
    command.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
    command.arg("--target-dir").arg(&target).env("RUSTFLAGS", rustflags);
    for setting in settings {
        command.args(["--config", setting]);
    }
    let output = command.output().expect("cargo starts");
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    target.join(if profile == "dev" { "debug" } else { profile }).join("snakes")
}

/// Settings for a build without any optimisation, in this package and in its dependencies.
fn unoptimised() -> Vec<String> {
    let packages = ["\"*\"", "rapier3d", "parry3d", "nalgebra", "simba", "glam"];
    let package = |name| format!("profile.dev.package.{name}.opt-level=0");
    let all = packages.into_iter().map(package);
    all.chain(["profile.dev.opt-level=0".to_owned()]).collect()
}

fn is_installed(program: &str) -> bool {
    let version = Command::new(program).arg("--version").output();
    let is_found = version.is_ok_and(|output| output.status.success());
    let required = env::var("SNAKES_SAME_BITS").is_ok_and(|value| value == "required");
    assert!(is_found || !required, "{program} is not installed");
    is_found
}

/// The fingerprint that `snakes verify` prints when the command `runner` runs it with these environment variables.
fn fingerprint(program: &Path, runner: &[&str], variables: &[(&str, &str)]) -> String {
    let words = runner.iter().map(Path::new).chain([program]).collect::<Vec<&Path>>();
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).args(["verify", "--json"]).envs(variables.iter().copied());
    let output = command.output().expect("the program starts");
    let stdout = String::from_utf8_lossy(&output.stdout);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{runner:?}: {:?}\n{stdout}\n{stderr}", output.status);
    let last: Value = serde_json::from_str(stdout.lines().last().expect("a line")).expect("JSON");
    last["fingerprint"].as_str().expect("a fingerprint").to_owned()
}

#[test]
#[ignore = "builds the program three times and runs it in emulation: ten minutes"]
fn every_build_and_every_processor_gives_the_fingerprint_of_the_reference() {
    const NO_VARIANTS: (&str, &str) =
        ("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-SSE4_2,-SSE4_1");
    let reference = Trajectories::reference().expect("well formed").fingerprint();
    let tested = Path::new(env!("CARGO_BIN_EXE_snakes"));
    let release = build("release", "release", "", &[]);
    let unoptimised = build("opt-0", "dev", "", &unoptimised());
    let v3 = build("v3", "release", "-Ctarget-cpu=x86-64-v3", &[]);
    let mut cases = vec![
        ("the program under test", tested, vec![], vec![]),
        ("opt-level 3", &*release, vec![], vec![]),
        (
            "the same without the C library's AVX and FMA variants",
            &release,
            vec![],
            vec![NO_VARIANTS],
        ),
        ("opt-level 0", &unoptimised, vec![], vec![]),
        ("opt-level 3 for x86-64-v3", &v3, vec![], vec![]),
    ];
    if is_installed("qemu-x86_64") {
        cases.push((
            "emulated Core 2 of 2006",
            &release,
            vec!["qemu-x86_64", "-cpu", "core2duo"],
            vec![],
        ));
        cases.push((
            "emulated, all features known to QEMU",
            &release,
            vec!["qemu-x86_64", "-cpu", "max"],
            vec![],
        ));
        cases.push(("the same, for x86-64-v3", &v3, vec!["qemu-x86_64", "-cpu", "max"], vec![]));
    }
    if is_installed("valgrind") {
        let checker = vec!["valgrind", "--quiet", "--error-exitcode=9", "--num-callers=30"];
        cases.push(("under valgrind's memory checker", &release, checker, vec![]));
    }
    println!("{reference}  the reference");
    for (case, program, runner, variables) in cases {
        let found = fingerprint(program, &runner, &variables);
        println!("{found}  {case}");
        assert_eq!(found, reference, "{case}");
    }
}
