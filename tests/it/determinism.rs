//! The same seed and settings give the same bits.
//!
//! The golden values were made with `cargo test --no-default-features --test it golden -- --ignored`,
//! which rewrites `tests/data/golden.ron`. They hold for debug and release, with and without the
//! studio: this same test runs in all of them.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use snakes_and_stairs::ENGINE_VERSION;
use snakes_and_stairs::evolve::Settings;
use snakes_and_stairs::run::{Control, Experiment, pool};
use snakes_and_stairs::save::load_preset;
use snakes_and_stairs::score::{Fitness, PerPart};
use snakes_and_stairs::world::Surface;

use super::program::{folder, json_lines};

/// What the golden file holds.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Golden {
    engine: u32,
    runs: Vec<GoldenRun>,
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct GoldenRun {
    what: String,
    run_hash: String,
}

fn golden_file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/golden.ron")
}

fn run_hash(seed: u64, settings: Settings) -> String {
    let mut experiment = Experiment::new("golden", seed, settings);
    let pool = pool(2).expect("a pool");
    while !experiment.is_over() {
        experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
    }
    format!("{:016x}", experiment.run_hash())
}

/// Short runs that between them reach everything that decides bits.
fn computed() -> Golden {
    let small = |change: fn(&mut Settings)| {
        let mut settings = load_preset("report").expect("it is shipped").settings;
        settings.evolution.population = 40;
        settings.evolution.generations = 3;
        change(&mut settings);
        settings.check().expect("allowed");
        settings
    };
    let runs = [
        ("report, 3 generations of 40, seed 1", 1, small(|_| ())),
        ("the same with seed 2", 2, small(|_| ())),
        (
            "120 steps a second, 8 substeps, moon gravity, 30 points a second",
            1,
            small(|settings| {
                settings.trial.physics.steps_per_s = 120;
                settings.trial.physics.substeps = 8;
                settings.trial.physics.gravity_m_s2 = 1.62;
                settings.genome.points_per_s = 30.0;
            }),
        ),
        (
            "bouncy ice, soft undamped joints, seven limbs",
            1,
            small(|settings| {
                settings.trial.surface.friction = 0.05;
                settings.trial.surface.bounce = 0.8;
                settings.trial.agent.joint_damping_nms_per_rad = 0.0.into();
                settings.trial.agent.joint_cfm_m_s_per_n = 1.0e-4.into();
                settings.trial.agent.limbs = 7;
            }),
        ),
        (
            "stairs that slip, a soft damping ground, a squishy snake of unlike parts, steps climbed",
            1,
            small(|settings| {
                let trial = &mut settings.trial;
                trial.surface.slip_m_s_per_n = 0.01;
                trial.surface.bounce = 0.4;
                trial.surface.bounce_velocity_m_s = 1.0;
                trial.ground = Some(Surface {
                    soft_erp: 0.5,
                    soft_cfm_m_s_per_n: 0.003,
                    dampen_per_s: 0.5,
                    ..trial.surface.clone()
                });
                trial.fitness = Fitness::StepsClimbed;
                let agent = &mut trial.agent;
                agent.skin.soft_cfm_m_s_per_n = 0.001;
                agent.limb_length_m = PerPart::Each(vec![1.0, 2.0, 2.0, 2.0, 1.5]);
                agent.density_kg_m3 = Some(PerPart::Each(vec![2.0, 2.0, 3.0, 2.0, 2.0]));
                agent.bend_limit_rad = Some(0.9.into());
            }),
        ),
    ];
    let runs = runs.into_iter().map(|(what, seed, settings)| GoldenRun {
        what: what.to_owned(),
        run_hash: run_hash(seed, settings),
    });
    Golden { engine: ENGINE_VERSION, runs: runs.collect() }
}

#[test]
fn runs_have_the_golden_bits() {
    let text = std::fs::read_to_string(golden_file()).expect("tests/data/golden.ron is readable");
    let golden: Golden = ron::from_str(&text).expect("tests/data/golden.ron is well formed");
    let computed = computed();
    assert_eq!(
        computed, golden,
        "\n\nThis build computes other bits than the golden ones (right).\n\
         If you did not mean to change what is computed, your change is the bug: every save would replay\n\
         differently. If you did: raise ENGINE_VERSION in src/lib.rs, regenerate with\n    \
         cargo test --no-default-features --test it golden -- --ignored\n\
         find new champions for saves/, and say so in CHANGELOG.md.\n\
         If only this machine differs, a float function of its C library was reached: see invariant 3.\n"
    );
}

#[test]
#[ignore = "rewrites tests/data/golden.ron; run it by hand after a change of bits that was meant"]
fn regenerate_golden() {
    let layout = ron::ser::PrettyConfig::new();
    let text = ron::ser::to_string_pretty(&computed(), layout).expect("serialisable");
    std::fs::write(golden_file(), text + "\n").expect("written");
}

#[test]
fn the_program_gives_one_run_hash_for_any_number_of_threads() {
    let folder = folder();
    let hash = |threads: usize| {
        let arguments = format!(
            "--no-render --json --seed 9 --population 30 --generations 2 --out out --threads {threads}"
        );
        json_lines(folder.path(), &arguments)[2]["run_hash"].clone()
    };
    let one = hash(1);
    assert_eq!(one, hash(2));
    assert_eq!(one, hash(4));
}
