//! Newborn creatures and soft snakes, each in both engines: they end healthy as often, move as far and hold their joints as well.

use super::*;
use crate::evolve::{Settings, with_fields};
use crate::rng::{Purpose, stream};
use crate::save::load_preset;
use crate::score::{Evaluation, evaluate};

/// Returns the settings of a preset with changed values.
fn settings(preset: &str, changes: &[(&str, &str)]) -> Settings {
    let settings = load_preset(preset).expect("shipped").settings;
    with_fields(&settings, changes.iter().copied()).expect("allowed")
}

/// Evaluates newborns of a run in an engine.
fn evaluations(settings: &Settings, engine: PhysicsEngine, count: u32) -> Vec<Evaluation> {
    let mut trial = settings.trial.clone();
    trial.physics.engine = engine;
    trial.repeats.trials = 1;
    let newborn = |individual| {
        let mut rng = stream(1, 1, individual, Purpose::Birth);
        let genome = settings.genome.random_genome(trial.genome_shape(), &mut rng);
        evaluate(&genome, &trial)
    };
    (0..count).map(newborn).collect()
}

/// Name of a measure, and a function that computes it from an evaluation and the y coordinate of its start, in m.
type EngineMeasure = (&'static str, fn(&Evaluation, f32) -> f32);

const MEASURES: [EngineMeasure; 4] = [
    ("distance, m", |of, start_y_m| (of.centre_y_m - start_y_m).abs()),
    ("share in contact", |of, _| of.behaviour.map_or(0.0, |behaviour| behaviour.contact_duty)),
    ("joint gap, mm", |of, _| of.effort.map_or(0.0, |effort| effort.joint_drift_m * 1000.0)),
    ("energy, kJ", |of, _| of.effort.map_or(0.0, |effort| effort.energy_j / 1000.0)),
];

/// Prints and compares the newborns of both engines. As many are healthy in both, up to 3 % of all, and as many gain energy from nothing, up
/// to 1 %. Among those that are healthy in both, the quartiles of each measure differ by at most the share `most` of the greater one.
fn compare(what: &str, settings: &Settings, count: u32, most: f32) {
    let both = [PhysicsEngine::Rapier, PhysicsEngine::Lanes]
        .map(|engine| evaluations(settings, engine, count));
    let [healthy, gaining] = [None, Some(Disqualification::EnergyFromNothing)].map(|end| {
        let ends_so =
            |all: &Vec<Evaluation>| all.iter().filter(|of| of.disqualified == end).count();
        both.each_ref().map(|all| ends_so(all) as f32 / count as f32)
    });
    println!("{what}, of {count}: {healthy:?} healthy, {gaining:?} gain energy");
    let start_y_m = settings.trial.start_y_m;
    let [in_rapier, in_lanes] = &both;
    let is_healthy = |of: &Evaluation| of.disqualified.is_none();
    let pairs = in_rapier.iter().zip(in_lanes);
    let pairs: Vec<_> = pairs.filter(|(a, b)| is_healthy(a) && is_healthy(b)).collect();
    let quartiles = |values: Vec<f32>| {
        let mut values = values;
        values.sort_by(f32::total_cmp);
        [1, 2, 3].map(|quarter| values[(values.len() - 1) * quarter / 4])
    };
    let found = MEASURES.map(|(measure, value)| {
        let of_rapier = quartiles(pairs.iter().map(|(of, _)| value(of, start_y_m)).collect());
        let of_lanes = quartiles(pairs.iter().map(|(_, of)| value(of, start_y_m)).collect());
        println!("{what}, {measure}: rapier {of_rapier:.3?}, lanes {of_lanes:.3?}");
        (measure, of_rapier, of_lanes)
    });
    assert!((healthy[0] - healthy[1]).abs() <= 0.03, "{what}: {healthy:?} healthy");
    assert!((gaining[0] - gaining[1]).abs() <= 0.01, "{what}: {gaining:?} gain energy");
    for (measure, of_rapier, of_lanes) in found {
        for (a, b) in of_rapier.into_iter().zip(of_lanes) {
            let off = (a - b).abs();
            assert!(off <= most * a.max(b) + 0.01, "{what}, {measure}: {a} and {b}");
        }
    }
}

/// Only some fifty creatures of 200 come to rest, so that the bound is wider than for many.
#[test]
fn newborn_creatures_are_alike_in_both_engines() {
    compare("creatures", &settings("creatures", &[("duration_s", "1.5")]), 200, 0.2);
}

#[test]
fn newborn_soft_snakes_are_alike_in_both_engines() {
    compare("soft limbs", &settings("squishy", &[("duration_s", "1.5")]), 32, 0.1);
}

/// Compares newborns of each kind over the whole trial: `cargo test -p snakes-core many_newborns -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn many_newborns_of_each_kind_are_alike_in_both_engines() {
    let own_sizes = [("bodies.soft", "true"), ("steps_per_s", "240"), ("substeps", "1")];
    compare("creatures", &settings("creatures", &[]), 2_000, 0.1);
    compare("soft limbs", &settings("squishy", &[]), 200, 0.1);
    compare("soft limbs of own sizes", &settings("bodies", &own_sizes), 200, 0.1);
}
