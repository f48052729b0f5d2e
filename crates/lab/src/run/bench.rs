//! Measures the speed of the simulation: this program's evaluation against rapier alone, and one thread against many. The
//! measurements alternate within one run, so that a noisy machine slows all of them alike.

use std::convert::Infallible;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use serde::Serialize;

use super::evaluator::EvaluationResult;
use super::{Evaluator, LocalPool, RunControl, WorkersError};
use snakes_core::control::ControlLoop;
use snakes_core::evolve::Settings;
use snakes_core::genome::Genome;
use snakes_core::rng::{Purpose, stream};
use snakes_core::score::{Trial, evaluate};
use snakes_core::world::{JointTorque, LANES, PhysicsEngine, Simulation, VectorLevel};

/// Results of the benchmark. Rates are medians over its rounds; ratios are medians of the ratios of each round.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BenchReport {
    /// The engine that computed the motion.
    pub engine: PhysicsEngine,
    /// Number of snakes that the engine steps side by side.
    pub lanes: usize,
    /// Vector instructions of the engine *lanes*; `None` for rapier, whose instructions are those for which the program was built.
    pub simd: Option<&'static str>,
    /// Number of worker threads in the measurements with many threads.
    pub threads: usize,
    /// Physics steps per wall second, all threads together.
    pub steps_per_s: f64,
    /// Simulated seconds per wall second, all threads together.
    pub sim_s_per_s: f64,
    /// Simulated seconds per wall second and thread.
    pub sim_s_per_s_per_thread: f64,
    /// Simulated seconds per wall second on one thread.
    pub one_thread_sim_s_per_s: f64,
    /// Simulated seconds per wall second on one thread, stepped by rapier alone: no checks, no trace.
    pub bare_rapier_sim_s_per_s: f64,
    /// Rate of this program's evaluation on one thread, divided by the rate of rapier alone.
    pub ratio_to_bare_rapier: f64,
    /// Rate with many threads, divided by the rate with one thread.
    pub scaling: f64,
}

/// Number of genomes that a thread evaluates in a round, which takes a quarter of a second in rapier. A multiple of eight fills the
/// lanes of an engine that steps eight snakes at once.
const GENOMES: usize = 64;

/// Genomes of a benchmark, all simulated in the same trial.
#[derive(Debug)]
pub struct Workload {
    genomes: Vec<Genome>,
    trial: Trial,
}

impl Workload {
    /// Makes a workload of newborns of a run with these settings. Disqualified newborns are left out, because they stop early, and
    /// rapier alone would take more steps than the evaluation.
    pub fn newborns(settings: &Settings) -> Self {
        let trial = settings.trial.clone();
        let genomes = (0..10 * GENOMES as u32)
            .map(|individual| {
                let mut rng = stream(1, 1, individual, Purpose::Birth);
                settings.genome.random_genome(trial.genome_shape(), &mut rng)
            })
            .filter(|genome| evaluate(genome, &trial).disqualified.is_none())
            .take(GENOMES)
            .collect();
        Self { genomes, trial }
    }

    /// Makes a workload that repeats one champion. Returns `None` if it is disqualified, because its trial then ends early.
    pub fn champion(genome: Genome, trial: Trial) -> Option<Self> {
        let runs_to_the_end = evaluate(&genome, &trial).disqualified.is_none();
        runs_to_the_end.then(|| Self { genomes: vec![genome; GENOMES], trial })
    }
}

/// Measures a workload for about `duration`, and calls `progress` with the share that is done, from 0 to 1.
///
/// # Errors
/// The threads could not be started.
pub fn bench(
    Workload { genomes, trial }: &Workload,
    threads: usize,
    duration: Duration,
    mut progress: impl FnMut(f64),
) -> Result<BenchReport, WorkersError> {
    let (one, many) = (LocalPool::new(1)?, LocalPool::new(threads)?);
    let started = Instant::now();
    let mut in_rapier = trial.clone();
    in_rapier.physics.engine = PhysicsEngine::Rapier;
    let mut rounds: Vec<Round> = Vec::new();
    loop {
        rounds.push(Round {
            ours: steps_per_s(|| evaluated_steps(&one, 1, genomes, trial)),
            bare: steps_per_s(|| {
                let steps = |index: usize| {
                    step_bare(&genomes[index], &in_rapier);
                    Ok::<_, Infallible>(u64::from(trial.steps()))
                };
                one.map(genomes.len(), steps).into_iter().flatten().sum()
            }),
            many: steps_per_s(|| evaluated_steps(&many, threads, genomes, trial)),
        });
        let elapsed = started.elapsed();
        progress((elapsed.as_secs_f64() / duration.as_secs_f64()).min(1.0));
        if elapsed >= duration {
            break;
        }
    }
    // The first round only warms the caches, and is dropped if there are others.
    if rounds.len() > 1 {
        rounds.remove(0);
    }
    let median_of = |value: fn(&Round) -> f64| median(rounds.iter().map(value).collect());
    let step_s = f64::from(trial.physics.step_s());
    let many = median_of(|round| round.many);
    let engine = trial.physics.engine;
    let (lanes, simd) = match engine {
        PhysicsEngine::Rapier => (1, None),
        PhysicsEngine::Lanes => (LANES, Some(VectorLevel::in_use().name())),
    };
    Ok(BenchReport {
        engine,
        lanes,
        simd,
        threads,
        steps_per_s: many,
        sim_s_per_s: many * step_s,
        sim_s_per_s_per_thread: many * step_s / threads as f64,
        one_thread_sim_s_per_s: median_of(|round| round.ours) * step_s,
        bare_rapier_sim_s_per_s: median_of(|round| round.bare) * step_s,
        ratio_to_bare_rapier: median_of(|round| round.ours / round.bare),
        scaling: median_of(|round| round.many / round.ours),
    })
}

/// Steps per second in one round: of this program, of rapier alone, and of many threads.
struct Round {
    ours: f64,
    bare: f64,
    many: f64,
}

/// Measures the steps per wall second of `work`, which returns its number of steps.
fn steps_per_s(work: impl FnOnce() -> u64) -> f64 {
    let started = Instant::now();
    let steps = work();
    steps as f64 / started.elapsed().as_secs_f64()
}

/// Evaluates every genome once per thread of the pool, as a run does, and returns the number of steps.
fn evaluated_steps(pool: &LocalPool, threads: usize, genomes: &[Genome], trial: &Trial) -> u64 {
    let all: Vec<&Genome> = std::iter::repeat_n(genomes, threads).flatten().collect();
    let steps = AtomicU64::new(0);
    let count = |_, result: EvaluationResult| {
        let of_one = result.map_or(0, |scored| scored.evaluation.steps);
        steps.fetch_add(of_one.into(), Ordering::Relaxed);
    };
    // The control is never cancelled.
    let _ = pool.evaluate_batch(trial, &all, &RunControl::default(), &count);
    steps.into_inner()
}

/// Simulates a snake with rapier alone: with the world and the torques of `evaluate`, but without health checks, copies of poses
/// and trace. Returns the world at the end.
fn step_bare(genome: &Genome, trial: &Trial) -> Simulation {
    let plan = trial.world_plan(genome);
    let mut simulation = Simulation::new(&plan);
    let mut control = ControlLoop::new(genome, &plan, trial.agent.senses);
    let mut torques = vec![JointTorque::default(); simulation.body().joints.len()];
    for step in 0..trial.steps() {
        control.act(step, &simulation, &mut torques);
        simulation.step_bare(&torques);
    }
    simulation
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::score::Rollout;
    use snakes_core::world::Pose;

    #[test]
    fn the_bare_loop_computes_the_motion_that_is_scored() {
        let settings = Settings::default();
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = settings.genome.random_genome(settings.trial.genome_shape(), &mut rng);
        let bare: Vec<Pose> = step_bare(&genome, &settings.trial).poses().collect();
        let mut rollout = Rollout::new(&genome, &settings.trial);
        while rollout.advance() {}
        assert_eq!(rollout.evaluation().disqualified, None);
        assert_eq!(bare, rollout.poses());
    }

    #[test]
    fn a_bench_reports_rates_and_ratios() {
        let mut settings = Settings::default();
        settings.trial.duration_s = 0.1;
        let report =
            bench(&Workload::newborns(&settings), 2, Duration::ZERO, |_| ()).expect("threads");
        assert_eq!((report.threads, report.engine), (2, PhysicsEngine::Rapier));
        assert_eq!((report.lanes, report.simd), (1, None));
        assert!(report.steps_per_s > 0.0 && report.ratio_to_bare_rapier > 0.0);
        assert!((report.sim_s_per_s * 60.0 / report.steps_per_s - 1.0).abs() < 1e-6);
    }
}
