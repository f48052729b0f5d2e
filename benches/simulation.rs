//! Benchmarks of a step, of an evaluation, of seeking, and of listing a large folder of saves. `cargo bench -- --save-baseline
//! before` and `cargo bench -- --baseline before` compare two versions; `snakes bench` measures the ratio to bare rapier.

#![expect(clippy::expect_used, reason = "a benchmark that cannot start has to fail")]

mod library;

use std::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use snakes_core::genome::{Genome, GenomeSpace};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::shipped_champion;
use snakes_core::score::{KeyframeHistory, Rollout, Trial, evaluate};

fn random_genome(trial: &Trial) -> Genome {
    let mut rng = stream(1, 1, 0, Purpose::Birth);
    GenomeSpace::default().random_genome(trial.genome_shape(), &mut rng)
}

/// Measures one step in the middle of a rollout, when the snake moves and touches the ground.
fn one_step(criterion: &mut Criterion) {
    let trial = Trial { duration_s: 600.0, ..Default::default() };
    let genome = random_genome(&Trial::default());
    let in_motion = || {
        let mut rollout = Rollout::new(&genome, &trial);
        (0..120).for_each(|_| assert!(rollout.advance(), "a healthy snake"));
        rollout
    };
    criterion.bench_function("one step", |bencher| {
        bencher.iter_batched_ref(in_motion, |rollout| rollout.advance(), BatchSize::LargeInput);
    });
}

/// Measures one evaluation of the default trial: building the world and 300 steps.
fn one_evaluation(criterion: &mut Criterion) {
    let trial = Trial::default();
    let genome = random_genome(&trial);
    criterion.bench_function("one evaluation", |bencher| {
        bencher.iter(|| evaluate(black_box(&genome), &trial));
    });
}

/// Measures seeking from the nearest keyframe to the middle and to the end of the shipped champion's 15 s, as in the studio's
/// timeline. Also measures computing the whole history, which the studio does once in the background.
fn seeking(criterion: &mut Criterion) {
    let champion = shipped_champion().expect("well formed").champion;
    let whole_history =
        || KeyframeHistory::of(&champion.genome, &champion.trial, |_| true).expect("not stopped");
    let history = whole_history();
    let steps = champion.trial.steps();
    let mut group = criterion.benchmark_group("seeking");
    for (name, step) in [("to the middle", steps / 2), ("to the end", steps - 1)] {
        group.bench_function(name, |bencher| bencher.iter(|| history.rollout_at(black_box(step))));
    }
    group.sample_size(20);
    group.bench_function("a whole history", |bencher| bencher.iter(whole_history));
}

criterion_group!(benches, one_step, one_evaluation, seeking, library::listing);
criterion_main!(benches);
