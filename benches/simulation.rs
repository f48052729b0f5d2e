//! What a step and an evaluation cost. Compare with `cargo bench -- --save-baseline before` and
//! `cargo bench -- --baseline before`; `snakes bench` gives the ratio to bare rapier.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use snakes_and_stairs::genome::{Genome, GenomeSpace};
use snakes_and_stairs::rng::{Purpose, stream};
use snakes_and_stairs::score::{Rollout, Trial, evaluate};

fn newborn(trial: &Trial) -> Genome {
    let mut rng = stream(1, 1, 0, Purpose::Birth);
    GenomeSpace::default().birth(trial.descent(), &mut rng)
}

/// One step in the middle of a rollout, when the snake is in contact and in motion.
fn one_step(criterion: &mut Criterion) {
    let trial = Trial { duration_s: 600.0, ..Default::default() };
    let genome = newborn(&Trial::default());
    let in_motion = || {
        let mut rollout = Rollout::new(&genome, &trial);
        (0..120).for_each(|_| assert!(rollout.advance(), "a healthy snake"));
        rollout
    };
    criterion.bench_function("one step", |bencher| {
        bencher.iter_batched_ref(in_motion, |rollout| rollout.advance(), BatchSize::LargeInput);
    });
}

/// One evaluation of the default trial: 300 steps, the world's building included.
fn one_evaluation(criterion: &mut Criterion) {
    let trial = Trial::default();
    let genome = newborn(&trial);
    criterion.bench_function("one evaluation", |bencher| {
        bencher.iter(|| evaluate(black_box(&genome), &trial));
    });
}

criterion_group!(benches, one_step, one_evaluation);
criterion_main!(benches);
