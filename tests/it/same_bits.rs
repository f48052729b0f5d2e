//! The program computes the same bits with other compiler settings, on other processors, and under a memory checker.
//!
//! Building and emulation take about half an hour on two cores:
//!
//!     cargo test --release --test it same_bits -- --ignored --nocapture
//!
//! WebAssembly is not covered: plotters, which draws the charts, does not compile for `wasm32-wasip1` without its fonts.
//!
//! Cases that need a missing tool (Debian's `qemu-user` or `valgrind`) are skipped, or fail if `SNAKES_SAME_BITS=required` is set.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::thread;

use serde_json::Value;
use snakes_lab::run::verify::Trajectories;

/// The platform of 64-bit ARM, and the tools that build and run its programs on this machine.
const ARM: &str = "aarch64-unknown-linux-gnu";
const ARM_LINKER: &str = "aarch64-linux-gnu-gcc";
const ARM_RUNNER: [&str; 3] = ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"];

/// Builds the program into a separate folder, and returns its path.
fn build(name: &str, profile: &str, rustflags: &str, settings: &[String]) -> PathBuf {
    build_for(None, name, profile, rustflags, settings)
}

fn build_for(
    platform: Option<&str>,
    name: &str,
    profile: &str,
    rustflags: &str,
    settings: &[String],
) -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let mut command = Command::new(env!("CARGO"));
    command.args(["build", "--no-default-features", "--locked", "--profile", profile]);
    command.args(["--package", "snakes-and-stairs", "--manifest-path"]);
    command.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
    command.arg("--target-dir").arg(&target).env("RUSTFLAGS", rustflags);
    command.args(platform.into_iter().flat_map(|platform| ["--target", platform]));
    for setting in settings {
        command.args(["--config", setting]);
    }
    let output = command.output().expect("cargo starts");
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    let target = platform.map_or(target.clone(), |platform| target.join(platform));
    target.join(if profile == "dev" { "debug" } else { profile }).join("snakes")
}

/// Returns whether Rust's standard library for a platform is installed.
fn has_platform(platform: &str) -> bool {
    let root = Command::new("rustc").args(["--print", "sysroot"]).output();
    root.is_ok_and(|root| {
        let root = String::from_utf8_lossy(&root.stdout).trim().to_owned();
        Path::new(&root).join("lib/rustlib").join(platform).join("lib").is_dir()
    })
}

/// Builds the program without any optimisation, including its dependencies. Returns its path.
fn build_unoptimised() -> PathBuf {
    let packages = ["\"*\"", "rapier3d", "parry3d", "nalgebra", "simba", "glam", "snakes-core"];
    let package = |name| format!("profile.dev.package.{name}.opt-level=0");
    build("opt-0", "dev", "", &packages.map(package))
}

fn is_found(program: &str) -> bool {
    let version = Command::new(program).arg("--version").output();
    version.is_ok_and(|output| output.status.success())
}

fn is_installed(program: &str) -> bool {
    let is_found = is_found(program);
    let required = env::var("SNAKES_SAME_BITS").is_ok_and(|value| value == "required");
    assert!(is_found || !required, "{program} is not installed");
    is_found
}

/// Returns whether this processor runs programs for x86-64-v3.
fn is_v3() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("f16c")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("movbe")
    }
    #[cfg(not(target_arch = "x86_64"))]
    false
}

/// Returns the fingerprint that `snakes verify` prints when the command `runner` runs it with these environment variables. The
/// program uses one thread, because several cases run at the same time.
fn fingerprint(program: &Path, runner: &[&str], variables: &[(&str, &str)]) -> String {
    let words = runner.iter().map(Path::new).chain([program]).collect::<Vec<&Path>>();
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).args(["verify", "--json", "--threads", "1"]);
    command.envs(variables.iter().copied());
    let output = command.output().expect("the program starts");
    let stdout = String::from_utf8_lossy(&output.stdout);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{runner:?}: {:?}\n{stdout}\n{stderr}", output.status);
    let last: Value = serde_json::from_str(stdout.lines().last().expect("a line")).expect("JSON");
    last["fingerprint"].as_str().expect("a fingerprint").to_owned()
}

/// Returns the path of the program under test, which is optimised like a user's program.
fn tested() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_snakes"))
}

/// Makes the C library leave out its variants for newer processors.
const NO_VARIANTS: (&str, &str) =
    ("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-SSE4_2,-SSE4_1");

/// Processors of another family compute other bits, for which there is one reference.
#[test]
#[ignore = "builds the program for 64-bit ARM and runs it in emulation: minutes"]
fn arm_gives_the_fingerprint_of_its_own_reference() {
    if !has_platform(ARM) || !is_found(ARM_LINKER) || !is_found(ARM_RUNNER[0]) {
        println!(
            "skipped: needs Rust's {ARM} (rustup target add {ARM}) and Debian's gcc-aarch64-linux-gnu and qemu-user"
        );
        return;
    }
    let linker = format!("target.{ARM}.linker={ARM_LINKER:?}");
    let program = build_for(Some(ARM), "arm", "release", "", &[linker]);
    let found = fingerprint(&program, &ARM_RUNNER, &[]);
    println!("{found}  64-bit ARM, emulated: its own reference");
}

/// A run of `snakes verify`: its description, the program, and the command that runs the program.
struct Case<'p> {
    what: &'static str,
    program: &'p Path,
    runner: Vec<&'static str>,
}

#[test]
#[ignore = "builds the program another time: minutes"]
fn a_build_without_optimisation_gives_the_fingerprint_of_the_reference() {
    let reference = Trajectories::reference().expect("well formed").fingerprint();
    assert_eq!(fingerprint(&build_unoptimised(), &[], &[]), reference);
    assert_eq!(fingerprint(tested(), &[], &[NO_VARIANTS]), reference, "{}", NO_VARIANTS.1);
}

#[test]
#[ignore = "builds the program several times and runs it in emulation: a quarter of an hour"]
fn every_processor_gives_the_fingerprint_of_the_reference() {
    const MAX: [&str; 3] = ["qemu-x86_64", "-cpu", "max"];
    let reference = Trajectories::reference().expect("well formed").fingerprint();
    let v3 = build("v3", "release", "-Ctarget-cpu=x86-64-v3", &[]);
    let case =
        |what, program, runner: &[&'static str]| Case { what, program, runner: runner.to_vec() };
    // The longest cases come first.
    let mut cases = Vec::new();
    if is_installed("valgrind") {
        let checker = ["valgrind", "--quiet", "--error-exitcode=9", "--num-callers=30"];
        cases.push(case("under valgrind's memory checker", tested(), &checker));
    }
    if is_installed("qemu-x86_64") {
        let core_2 = ["qemu-x86_64", "-cpu", "core2duo"];
        cases.push(case("emulated Core 2 of 2006", tested(), &core_2));
        // QEMU supports no processor features beyond those of x86-64-v3.
        if !is_v3() {
            cases.push(case("emulated, all features known to QEMU", tested(), &MAX));
            cases.push(case("the same, for x86-64-v3", &v3, &MAX));
        }
    }
    if is_v3() {
        cases.push(case("for x86-64-v3", &v3, &[]));
    }
    println!("{reference}  the reference");
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let waiting = Mutex::new(cases.into_iter());
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                let next = || waiting.lock().expect("no case has failed").next();
                while let Some(Case { what, program, runner }) = next() {
                    let found = fingerprint(program, &runner, &[]);
                    println!("{found}  {what}");
                    assert_eq!(found, reference, "{what}");
                }
            });
        }
    });
}
