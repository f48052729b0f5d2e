//! Tests of evolving bodies that take longer than usual tests, with tables as output:
//!
//!     cargo test --release --test it bodies:: -- --ignored --nocapture

use std::collections::BTreeMap;

use rayon::prelude::*;
use snakes_core::evolve::{Settings, with_fields};
use snakes_core::genome::Genome;
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::load_preset;
use snakes_core::score::{Evaluation, Rollout, evaluate};
use snakes_core::world::Disqualification;

/// Seed of the random bodies. No setting was chosen with this seed.
const SEED: u64 = 101;

fn settings(changes: &[(&str, &str)]) -> Settings {
    let preset = load_preset("bodies").expect("shipped").settings;
    with_fields(&preset, changes.iter().copied()).expect("allowed")
}

fn random_bodies(settings: &Settings, count: u32) -> Vec<Genome> {
    let one = |individual| {
        let mut rng = stream(SEED, 1, individual, Purpose::Birth);
        settings.genome.random_genome(settings.trial.genome_shape(), &mut rng)
    };
    (0..count).map(one).collect()
}

fn evaluated(settings: &Settings, genomes: &[Genome]) -> Vec<Evaluation> {
    genomes.par_iter().map(|genome| evaluate(genome, &settings.trial)).collect()
}

/// Counts the bodies by the reasons of their disqualification, and prints the counts.
#[expect(clippy::print_stdout, reason = "the test runner shows it with --nocapture")]
fn counted<'r>(reasons: impl Iterator<Item = &'r str>) -> BTreeMap<&'r str, u32> {
    let mut counts = BTreeMap::new();
    reasons.for_each(|reason| *counts.entry(reason).or_default() += 1);
    for (reason, count) in &counts {
        println!("{count:>5}  {reason}");
    }
    counts
}

/// Returns Spearman's rank correlation. Equal values have equal ranks.
fn rank_correlation(a: &[f32], b: &[f32]) -> f64 {
    let ranks = |values: &[f32]| -> Vec<f64> {
        let rank = |value: &f32| {
            let below = values.iter().filter(|other| *other < value).count();
            let equal = values.iter().filter(|other| *other == value).count();
            below as f64 + (equal as f64 - 1.0) / 2.0
        };
        values.iter().map(rank).collect()
    };
    let (a, b) = (ranks(a), ranks(b));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(&a), mean(&b));
    let pairs = || a.iter().zip(&b).map(|(x, y)| (x - mean_a, y - mean_b));
    let covariance: f64 = pairs().map(|(x, y)| x * y).sum();
    let [of_a, of_b] = pairs().fold([0.0, 0.0], |[p, q], (x, y)| [p + x * x, q + y * y]);
    if of_a == 0.0 || of_b == 0.0 { 0.0 } else { covariance / (of_a * of_b).sqrt() }
}

/// Without torques no body gets anywhere, whatever its length.
#[test]
#[ignore = "simulates 2000 bodies for 15 s each"]
fn a_body_without_torques_scores_nothing_whatever_its_length() {
    let settings = settings(&[
        ("max_bend_torque_nm", "0"),
        ("max_twist_torque_nm", "0"),
        ("trial.duration_s", "15"),
    ]);
    let genomes = random_bodies(&settings, 2000);
    let evaluations = evaluated(&settings, &genomes);
    let healthy = || genomes.iter().zip(&evaluations).filter(|(_, of)| of.disqualified.is_none());
    let lengths: Vec<f32> =
        healthy().map(|(genome, _)| settings.trial.agent.body_plan(genome).length_m()).collect();
    let shares: Vec<f32> = healthy().map(|(_, of)| of.fitness).collect();
    let largest = shares.iter().map(|share| share.abs()).fold(0.0, f32::max);
    let not_at_rest = evaluations.len() - shares.len();
    println!("bodies                       {}", genomes.len());
    println!("not at rest at the start     {not_at_rest}");
    println!("largest share, either sign   {largest:.4}   (claim: at most 0.02)");
    println!("rank correlation with length {:.3}", rank_correlation(&lengths, &shares));
    assert!(largest <= 0.02, "a body gains or loses {largest} without torques");
    assert!(not_at_rest * 10 <= genomes.len(), "{not_at_rest} did not come to rest");
}

/// Soft bodies stay together: none reaches a state that is not finite, and at most one in twenty comes apart, which disqualifies
/// it.
#[test]
#[ignore = "simulates 1000 soft bodies for 15 s each"]
fn soft_bodies_stay_together() {
    let soft = [
        ("bodies.soft", "true"),
        ("steps_per_s", "240"),
        ("substeps", "1"),
        ("trial.duration_s", "15"),
    ];
    let settings = settings(&soft);
    let genomes = random_bodies(&settings, 1000);
    let are_soft = |genome: &&Genome| !settings.trial.agent.body_plan(genome).springs.is_empty();
    let soft = genomes.iter().filter(are_soft).count();
    let ends = evaluated(&settings, &genomes);
    println!("{soft:>5}  of {} bodies have soft blocks", genomes.len());
    let reason = |end: &Evaluation| end.disqualified.map_or("healthy", |of| of.words());
    let reasons = counted(ends.iter().map(reason));
    let of = |reason: Disqualification| reasons.get(reason.words()).copied().unwrap_or(0);
    assert!(soft * 2 > genomes.len(), "only {soft} bodies have soft blocks");
    assert_eq!(of(Disqualification::NotFinite), 0);
    assert_eq!(of(Disqualification::EnergyFromNothing), 0);
    assert!(of(Disqualification::JointBroke) <= 50, "{reasons:?}");
}

/// No body gains energy that its joints did not spend, up to 5 % and 1 J, without being disqualified.
#[test]
#[ignore = "simulates 1000 bodies for 15 s each"]
fn no_body_creates_energy_without_being_disqualified() {
    let settings = settings(&[("trial.duration_s", "15")]);
    let genomes = random_bodies(&settings, 1000);
    // For each body: the least share of the spent energy that was lost so far, and the reason of the disqualification.
    let ends: Vec<(f32, &str)> = genomes
        .par_iter()
        .map(|genome| {
            let mut rollout = Rollout::new(genome, &settings.trial);
            let mut least_j = f32::INFINITY;
            while rollout.advance() {
                let simulation = rollout.simulation();
                let allowed_j = 0.05 * simulation.effort().energy_j + 1.0;
                least_j = least_j.min(simulation.energy_lost().total_j + allowed_j);
            }
            let reason = rollout.evaluation().disqualified.map_or("healthy", |of| of.words());
            (least_j, reason)
        })
        .collect();
    let reasons = counted(ends.iter().map(|(_, reason)| *reason));
    let least_j = ends.iter().map(|(least_j, _)| *least_j).fold(f32::INFINITY, f32::min);
    println!("least margin to 5 % and 1 J after a healthy step: {least_j:.3} J");
    assert!(least_j >= 0.0, "a healthy step created {} J too much", -least_j);
    assert!(reasons.get("healthy").is_some_and(|count| *count >= 800), "{reasons:?}");
}
