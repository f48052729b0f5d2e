//! Tests of the search through its public interface: the functions that it solves, the evaluations that it needs, and the completeness of
//! its state.

use std::f64::consts::TAU;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::candidate::finite;
use super::restarts::random_point;
use super::termination::StopReason;
use super::{Cma, CmaParameters, CovarianceShape, RankedCandidate, RestartedCma};
use crate::evolve::settings::RestartKind;

const SEEDS: u64 = 21;

/// Returns the usual number of candidates per iteration: 4 + ⌊3 ln n⌋ (eq. 48).
fn default_population(dimension: usize) -> u32 {
    4 + (3.0 * libm::log(dimension.max(1) as f64)).floor() as u32
}

fn stream(seed: u64, iteration: u32, index: u32) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[0..8].copy_from_slice(&seed.to_le_bytes());
    key[8..12].copy_from_slice(&iteration.to_le_bytes());
    key[12..16].copy_from_slice(&index.to_le_bytes());
    ChaCha8Rng::from_seed(key)
}

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// Has a Hessian with condition number 1e6.
fn ellipsoid(x: &[f64]) -> f64 {
    let last = (x.len() - 1) as f64;
    x.iter().enumerate().map(|(i, x)| libm::pow(1e6, i as f64 / last) * x * x).sum()
}

fn square(x: f64) -> f64 {
    x * x
}

fn rosenbrock(x: &[f64]) -> f64 {
    x.windows(2).map(|p| 100.0 * square(p[1] - p[0] * p[0]) + square(1.0 - p[0])).sum()
}

/// Maps the usual box of ±5.12 to the unit box; the optimum lies off the centre.
fn rastrigin(x: &[f64]) -> f64 {
    let wave = |u: &f64| {
        let x = 10.24 * u - 5.12 - 0.7;
        x * x + 10.0 * (1.0 - libm::cos(TAU * x))
    };
    x.iter().map(wave).sum()
}

fn median(mut counts: Vec<u64>) -> u64 {
    counts.sort_unstable();
    counts[counts.len() / 2]
}

/// Returns the candidates with their values, best first. Candidates with equal values keep their order.
fn best_first<'a>(candidates: &'a [Vec<f64>], values: &[f64]) -> Vec<RankedCandidate<'a>> {
    let pairs = candidates.iter().zip(values);
    let mut ranked: Vec<_> =
        pairs.map(|(point, &value)| RankedCandidate { point, value: finite(value) }).collect();
    ranked.sort_by(|a, b| b.value.total_cmp(&a.value));
    ranked
}

/// Lets the run learn from one iteration of minimising `cost`. Returns the least cost of a candidate.
fn step(run: &mut Cma, cost: impl Fn(&[f64]) -> f64, seed: u64) -> f64 {
    let candidates = run.candidates(|index| stream(seed, run.iteration, index));
    let values: Vec<f64> = candidates.iter().map(|x| -cost(x)).collect();
    let ranked = best_first(&candidates, &values);
    run.update(&ranked).unwrap();
    -ranked[0].value
}

/// Returns the number of evaluations until a candidate costs less than 1e-10; `u64::MAX` if the run ends before.
fn evaluations(mut run: Cma, cost: impl Fn(&[f64]) -> f64, seed: u64) -> u64 {
    while run.stop.is_none() {
        if step(&mut run, &cost, seed) < 1e-10 {
            return u64::from(run.iteration) * u64::from(run.population);
        }
    }
    u64::MAX
}

fn run(dimension: usize, start: f64, step: f64, shape: CovarianceShape, active: bool) -> Cma {
    let population = default_population(dimension);
    Cma::new(vec![start; dimension], step, population, shape, active).unwrap()
}

/// Returns the median number of evaluations over the seeds, for a full covariance and active CMA-ES.
fn usual(cost: fn(&[f64]) -> f64, start: f64, step: f64) -> u64 {
    let counts = |seed| evaluations(run(10, start, step, CovarianceShape::Full, true), cost, seed);
    median((0..SEEDS).map(counts).collect())
}

fn assert_near(name: &str, ours: u64, expected: u64, tolerance: f64) {
    let ratio = ours as f64 / expected as f64;
    assert!((ratio - 1.0).abs() <= tolerance, "{name}: {ours} evaluations, expected {expected}");
}

#[test]
fn evaluations_agree_with_another_implementation() {
    // Medians of the crate `cmaes` 0.2.2 over 21 seeds, measured by tests/oracle.rs. This implementation had 1670, 4260 and 5400.
    assert_near("sphere", usual(sphere, 1.0, 0.5), 1660, 0.3);
    assert_near("ellipsoid", usual(ellipsoid, 1.0, 0.5), 4290, 0.3);
    assert_near("Rosenbrock", usual(rosenbrock, 0.0, 0.2), 5340, 0.3);
}

fn restarting(restart: RestartKind, seed: u64) -> RestartedCma {
    let step = if restart == RestartKind::Bipop { 0.2 } else { 0.5 };
    let population = default_population(5);
    let settings =
        CmaParameters { step, population, shape: CovarianceShape::Full, active: true, restart };
    RestartedCma::new(settings, random_point(5, &mut stream(seed, u32::MAX, 0))).unwrap()
}

/// Lets all runs learn from one iteration; `number` counts iterations over all runs.
fn step_all(runs: &mut RestartedCma, seed: u64, number: u32) -> f64 {
    let candidates = runs.current.candidates(|index| stream(seed, number, index));
    let values: Vec<f64> = candidates.iter().map(|x| -rastrigin(x)).collect();
    let ranked = best_first(&candidates, &values);
    runs.update(&ranked, &mut stream(seed, number, u32::MAX)).unwrap();
    -ranked[0].value
}

fn evaluations_with_restarts(restart: RestartKind, seed: u64) -> u64 {
    let (mut runs, mut count, mut number) = (restarting(restart, seed), 0, 0);
    loop {
        count += u64::from(runs.current.population);
        assert!(count < 1_000_000, "not solved");
        if step_all(&mut runs, seed, number) < 1e-10 {
            return count;
        }
        number += 1;
    }
}

#[test]
fn restarts_solve_rastrigin_as_fast_as_another_implementation() {
    let count = |kind| median((0..101).map(|seed| evaluations_with_restarts(kind, seed)).collect());
    // Medians of `cmaes` over 101 seeds. Those of BIPOP scatter widely: this implementation had 33513 and 22314 with two kinds of random
    // numbers, so the test only requires that it is not slower.
    assert_near("IPOP", count(RestartKind::Ipop), 21_816, 0.3);
    let bipop = count(RestartKind::Bipop);
    assert!((10_000..=48_500).contains(&bipop), "BIPOP: {bipop} evaluations, not some 37345");
}

#[test]
fn a_full_covariance_is_invariant_under_rotation() {
    // Three reflections mix all coordinates. The start is reflected as well.
    let mirror = |x: &[f64], seed: u64| -> Vec<f64> {
        let axis = random_point(x.len(), &mut stream(seed, 0, 0));
        let twice: f64 = 2.0 * x.iter().zip(&axis).map(|(x, a)| x * a).sum::<f64>() / sphere(&axis);
        x.iter().zip(&axis).map(|(x, a)| x - twice * a).collect()
    };
    let turned = |x: &[f64]| ellipsoid(&mirror(&mirror(&mirror(x, 1), 2), 3));
    let start = mirror(&mirror(&mirror(&[1.0; 10], 3), 2), 1);
    let counts = (0..SEEDS).map(|seed| {
        let run = Cma::new(start.clone(), 0.5, default_population(10), CovarianceShape::Full, true);
        evaluations(run.unwrap(), turned, seed)
    });
    assert_near("rotated", median(counts.collect()), usual(ellipsoid, 1.0, 0.5), 0.15);
}

#[test]
fn learning_from_bad_candidates_saves_evaluations() {
    let count = |active| {
        let one =
            |seed| evaluations(run(10, 1.0, 0.5, CovarianceShape::Full, active), ellipsoid, seed);
        median((0..SEEDS).map(one).collect())
    };
    // This implementation had 4260 against 5830 evaluations; `cmaes` has 4290 against 6100.
    let (active, passive) = (count(true), count(false));
    assert!(active * 10 < passive * 9, "{active} active, {passive} passive");
}

#[test]
fn a_diagonal_learns_a_separable_function_in_linear_time() {
    let diagonal = evaluations(run(100, 1.0, 0.5, CovarianceShape::Diagonal, true), ellipsoid, 0);
    let full = evaluations(run(20, 1.0, 0.5, CovarianceShape::Full, true), ellipsoid, 0);
    let short = evaluations(run(20, 1.0, 0.5, CovarianceShape::Diagonal, true), ellipsoid, 0);
    // Measured: 27421 and 4428 against 13152 evaluations. Five times the dimension takes six times the evaluations, where a full covariance
    // would take over twenty times as many.
    assert!(short * 2 < full && diagonal < short * 8);
    let huge = run(20_000, 1.0, 0.5, CovarianceShape::Diagonal, true);
    assert_eq!(huge.candidates(|index| stream(0, 0, index)).len(), 33);
}

#[test]
fn candidates_are_reproducible_and_have_the_covariance() {
    let mut run = Cma::new(vec![1.0; 4], 0.5, 8, CovarianceShape::Full, true).unwrap();
    for _ in 0..60 {
        step(&mut run, ellipsoid, 3);
    }
    let draw = |seed| run.candidates(|index| stream(seed, 0, index));
    assert_eq!(draw(1), draw(1));
    assert_ne!(draw(1), draw(2));
    let mut json = serde_json::to_value(&run).unwrap();
    json["population"] = 100_000.into();
    let many: Cma = serde_json::from_value(json.clone()).unwrap();
    let points = many.candidates(|index| stream(4, 0, index));
    let scale = run.step * run.step;
    let mean = |i: usize| json["mean"][i].as_f64().unwrap();
    let c = |i: usize, j: usize| json["covariance"][i * (i + 1) / 2 + j].as_f64().unwrap();
    for (i, j) in (0..4).flat_map(|i| (0..=i).map(move |j| (i, j))) {
        let products = points.iter().map(|x| (x[i] - mean(i)) * (x[j] - mean(j)) / scale);
        let error = products.sum::<f64>() / 1e5 - c(i, j);
        assert!(error.abs() < 0.02 * (c(i, i) * c(j, j)).sqrt(), "C{i}{j} is off by {error}");
    }
}

#[test]
fn a_state_read_from_text_continues_bit_for_bit() {
    for kind in [RestartKind::Ipop, RestartKind::Bipop] {
        let (mut straight, mut resumed) = (restarting(kind, 5), restarting(kind, 5));
        let mut number = 0;
        while straight.restarts < 3 {
            let text = serde_json::to_string(&resumed).unwrap();
            resumed = serde_json::from_str(&text).unwrap();
            resumed.check().unwrap();
            let costs = (step_all(&mut straight, 5, number), step_all(&mut resumed, 5, number));
            assert_eq!(costs.0.to_bits(), costs.1.to_bits());
            number += 1;
        }
        assert_eq!(
            serde_json::to_string(&straight).unwrap(),
            serde_json::to_string(&resumed).unwrap()
        );
    }
}

#[test]
fn populations_follow_the_kind_of_restart() {
    let populations = |kind, count| {
        let mut runs = restarting(kind, 9);
        let mut seen = vec![runs.current.population];
        for number in 0.. {
            let restarts = runs.restarts;
            step_all(&mut runs, 9, number);
            if runs.restarts > restarts {
                seen.push(runs.current.population);
            }
            if seen.len() == count {
                break;
            }
        }
        seen
    };
    assert_eq!(populations(RestartKind::Ipop, 5), [8, 16, 32, 64, 128]);
    let both = populations(RestartKind::Bipop, 12);
    assert_eq!(both[..2], [8, 16]);
    assert!(both[2] < 16 && both.contains(&32), "{both:?}");
    let mut alone = restarting(RestartKind::None, 9);
    for number in 0..2000 {
        step_all(&mut alone, 9, number);
    }
    assert!(alone.current.stop.is_some() && alone.restarts == 0);
}

#[test]
fn each_criterion_reports_its_reason() {
    let end = |cost: fn(&[f64]) -> f64, seed| {
        let mut run = run(5, 1.0, 0.5, CovarianceShape::Full, true);
        let mut iterations = 0;
        while run.stop.is_none() {
            step(&mut run, cost, seed);
            iterations += 1;
            assert!(iterations < 20_000);
        }
        run.stop.unwrap()
    };
    assert_eq!(end(|_| 0.0, 1), StopReason::EqualValues);
    assert_eq!(end(|_| f64::NAN, 1), StopReason::EqualValues);
    assert_eq!(end(sphere, 1), StopReason::CloseValues);
    assert_eq!(end(|x| 1e30 * sphere(x), 1), StopReason::ShortSteps);
    assert_eq!(end(|x| 1e30 * sphere(&[x[0] - 1e9]), 1), StopReason::LongSteps);
    assert_eq!(end(|x| x[0], 1), StopReason::LongSteps);
    let narrow = |x: &[f64]| x[0] * x[0] + 1e22 * sphere(&x[1..]);
    // Which of the two reasons comes first depends on the random numbers.
    let ends: Vec<StopReason> = (1..10).map(|seed| end(narrow, seed)).collect();
    assert!(ends.contains(&StopReason::Condition), "{ends:?}");
    // The function is pure noise: a hash of the coordinate's bits.
    let noise = |x: &[f64]| (x[0].to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as f64;
    assert_eq!(end(noise, 1), StopReason::Stagnation);
    let mut run = Cma::new(vec![1.0; 5], 1e-17, 8, CovarianceShape::Full, true).unwrap();
    step(&mut run, sphere, 1);
    assert_eq!(run.stop, Some(StopReason::CoordinateWithoutEffect));
}

#[test]
fn invalid_states_are_refused() {
    let mut run = Cma::new(vec![1.0; 4], 0.5, 8, CovarianceShape::Full, true).unwrap();
    for _ in 0..5 {
        step(&mut run, sphere, 1);
    }
    run.check().unwrap();
    let good = serde_json::to_value(&run).unwrap();
    let mangle = |path: &str, value: serde_json::Value| {
        let mut bad = good.clone();
        *bad.pointer_mut(path).unwrap() = value;
        serde_json::from_value::<Cma>(bad).unwrap().check().unwrap_err().field
    };
    assert_eq!(mangle("/mean", vec![1.0; 5].into()), "step_path");
    assert_eq!(mangle("/mean", Vec::<f64>::new().into()), "dimension");
    assert_eq!(mangle("/mean", vec![0.0; 257].into()), "dimension");
    assert_eq!(mangle("/step_path", vec![0.0; 3].into()), "step_path");
    assert_eq!(mangle("/covariance_path", vec![0.0; 5].into()), "covariance_path");
    assert_eq!(mangle("/covariance", vec![1.0; 4].into()), "covariance");
    assert_eq!(mangle("/covariance/2", (-1.0).into()), "covariance");
    assert_eq!(mangle("/shape", "Diagonal".into()), "covariance");
    assert_eq!(mangle("/step", 0.0.into()), "step");
    assert_eq!(mangle("/initial_step", (-1.0).into()), "initial_step");
    assert_eq!(mangle("/population", u32::MAX.into()), "population");
    assert_eq!(mangle("/population", 1.into()), "population");
    assert_eq!(mangle("/history/best", vec![0.0; 200].into()), "history.best");
    assert_eq!(mangle("/history/median", vec![0.0; 4].into()), "history.median");
    assert_eq!(mangle("/iteration", 3.into()), "history.best");
    let mut extra = good.clone();
    extra["surprise"] = 1.into();
    assert!(serde_json::from_value::<Cma>(extra).is_err());

    let runs = serde_json::to_value(restarting(RestartKind::Bipop, 1)).unwrap();
    let mangle_runs = |path: &str, value: serde_json::Value| {
        let mut bad = runs.clone();
        *bad.pointer_mut(path).unwrap() = value;
        serde_json::from_value::<RestartedCma>(bad).unwrap().check().unwrap_err().field
    };
    assert_eq!(mangle_runs("/doublings", 33.into()), "doublings");
    assert_eq!(mangle_runs("/parameters/population", 0.into()), "parameters.population");
    assert_eq!(mangle_runs("/parameters/active", false.into()), "current");
    assert_eq!(mangle_runs("/current/step", 0.0.into()), "current.step");
}

#[test]
fn wrong_candidates_are_refused_and_change_nothing() {
    let mut run = Cma::new(vec![1.0; 3], 0.5, 4, CovarianceShape::Full, true).unwrap();
    let before = run.clone();
    let wrong = [vec![vec![1.0; 3]; 3], vec![vec![1.0; 2]; 4], vec![vec![f64::INFINITY; 3]; 4]];
    for candidates in wrong {
        assert!(run.update(&best_first(&candidates, &[0.0; 4])).is_err());
    }
    assert_eq!(run, before);
    assert!(Cma::new(vec![], 1.0, 4, CovarianceShape::Full, true).is_err());
    assert!(Cma::new(vec![f64::NAN], 1.0, 4, CovarianceShape::Full, true).is_err());
    assert!(Cma::new(vec![0.0], 0.0, 4, CovarianceShape::Diagonal, true).is_err());
}

#[test]
fn the_bits_equal_the_recorded_ones() {
    // Changed bits would break every saved run: the numbers must be the same on every machine.
    let bits = |shape| {
        let mut run = run(7, 0.0, 0.2, shape, true);
        for _ in 0..150 {
            step(&mut run, rosenbrock, 42);
        }
        let mixed = |hash: u64, x: &f64| hash.wrapping_mul(0x0100_0000_01B3) ^ x.to_bits();
        (run.step.to_bits(), run.mean.iter().fold(0, mixed))
    };
    let both = [bits(CovarianceShape::Full), bits(CovarianceShape::Diagonal)];
    assert_eq!(
        both,
        [
            (4_585_541_582_747_349_638, 9_919_190_096_440_026_842),
            (4_601_700_460_741_484_703, 4_063_666_984_528_855_078),
        ]
    );
}

/// On a rung of a ladder, all best snakes may have the greatest possible fitness. The search must not end for that reason.
#[test]
fn a_search_whose_values_are_forgotten_does_not_end_because_they_are_equal() {
    let ends = |forgets: bool| {
        let mut run = run(5, 1.0, 0.5, CovarianceShape::Full, true);
        for _ in 0..60 {
            step(&mut run, |_| 1.0, 1);
            if forgets {
                run.forget_values();
            }
        }
        run.check().expect("a state that can be resumed");
        run.stop
    };
    assert_eq!(ends(false), Some(StopReason::EqualValues));
    assert_eq!(ends(true), None);
}
