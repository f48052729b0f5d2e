//! Runs with equal seed and settings give equal bits.
//!
//! `cargo test --release --test it golden -- --ignored` writes the reference to `assets/golden.ron`. It holds for debug and release
//! builds, with and without the studio: this test runs in all of them.

use snakes_core::Processors;
use snakes_core::world::VectorLevel;
use snakes_lab::run::verify::Trajectories;
use snakes_lab::run::{LocalPool, RunControl};

use super::program::{folder, json_lines, stdout_of};

fn computed() -> Trajectories {
    let pool = LocalPool::new(2).expect("threads");
    Trajectories::computed(&pool, &RunControl::default(), |_, _| ()).expect("not cancelled")
}

#[test]
fn runs_have_the_golden_bits() {
    let golden = Trajectories::reference().expect("assets/golden.ron is well formed");
    assert_eq!(
        computed(),
        golden,
        "\n\nThis build computes other bits than the golden ones (right).\n\
         If you did not intend to change results, your change is the bug: every save would replay\n\
         differently. If you did: raise ENGINE_VERSION in src/engine.rs, regenerate with\n    \
         cargo test --release --test it golden -- --ignored\n\
         find new champions for saves/, and describe the change in CHANGELOG.md.\n\
         If only this machine differs, a step called a float function of its C library: see invariant 3.\n"
    );
}

#[test]
#[ignore = "rewrites the golden file of these processors; run it by hand after an intended change of bits"]
fn regenerate_golden() {
    let layout = ron::ser::PrettyConfig::new();
    let text = ron::ser::to_string_pretty(&computed(), layout).expect("serialisable");
    let name = match Processors::THIS {
        Processors::X86_64 => "golden.ron",
        Processors::Arm64 => "golden-arm64.ron",
        Processors::Other => panic!("other processors have no reference"),
    };
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/");
    std::fs::write(format!("{folder}{name}"), text + "\n").expect("written");
}

#[test]
fn verify_prints_a_table_and_the_fingerprint_of_the_reference() {
    let folder = folder();
    let reference = Trajectories::reference().expect("well formed");
    let text = stdout_of(folder.path(), "verify");
    let fingerprint = format!("fingerprint  {}", reference.fingerprint());
    assert!(text.contains(&fingerprint), "{text}");
    assert!(text.contains("This machine computes the reference's bits"), "{text}");
    let agreeing = text.lines().filter(|line| line.ends_with("  the same")).count();
    assert_eq!(agreeing, reference.trajectories.len());
}

/// The program gives the golden bits with every set of vector instructions that the machine has, and without the variants of float
/// functions that the C library selects by processor. The strongest set is tested by [`runs_have_the_golden_bits`].
#[test]
fn vector_instructions_and_variants_of_the_c_library_change_no_bit() {
    let levels = VectorLevel::all();
    // A machine with a single set runs it again without the variants.
    let weaker = &levels[..levels.len().saturating_sub(1).max(1)];
    for level in weaker {
        let folder = folder();
        let mut command = super::program::snakes(folder.path(), "verify --json");
        command.env("SNAKES_SIMD", level.name());
        command.env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-SSE4_2,-SSE4_1");
        let output = command.output().expect("the program starts");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", level.name());
    }
}

/// Checks that a run with these settings, in which stairs evolve, ends with more than three stairs, and with the same hash on one,
/// two and four threads.
fn assert_stairs_have_one_hash(settings: &str) {
    let folder = folder();
    let hash = |threads: usize| {
        let arguments = format!(
            "--no-render --json --preset poet --seed 9 --duration 3 --population 100 --generations 30 {settings} \
             --out out-{threads} --threads {threads}"
        );
        let lines = json_lines(folder.path(), &arguments);
        let last = &lines[lines.len() - 2]["stairs"];
        assert!(last["all"].as_u64().is_some_and(|all| all > 3), "{last}");
        lines[lines.len() - 1]["run_hash"].clone()
    };
    let one = hash(1);
    assert_eq!(one, hash(2));
    assert_eq!(one, hash(4));
}

#[test]
fn stairs_that_evolve_have_one_run_hash_for_any_number_of_threads() {
    assert_stairs_have_one_hash(
        "--set pairs=3 --set pair_candidates=4 --set learn_generations=1 --set transfers=1 --set reproduces_from=0 \
         --set too_hard_below=0 --set too_easy_above=1.1",
    );
}

#[test]
fn queues_of_snakes_and_stairs_have_one_run_hash_for_any_number_of_threads() {
    assert_stairs_have_one_hash(
        "--set strategy=mcc --set criterion=0.05 --set snake_queue=6 --set snake_children=3 --set stairs_queue=3 \
         --set stairs_children=2 --set first_snakes=4",
    );
}

#[test]
fn the_program_gives_one_run_hash_for_any_number_of_threads() {
    let folder = folder();
    let hash = |threads: usize| {
        let arguments = format!(
            "--no-render --json --seed 9 --population 30 --generations 2 --out out-{threads} --threads {threads}"
        );
        json_lines(folder.path(), &arguments)[2]["run_hash"].clone()
    };
    let one = hash(1);
    assert_eq!(one, hash(2));
    assert_eq!(one, hash(4));
}
