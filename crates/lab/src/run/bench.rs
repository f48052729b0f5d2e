//! Measures the speed of the simulation: our scoring path against bare rapier, one thread against many, in turn
//! within one run, so that a noisy machine slows all of them alike.

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
use snakes_core::world::{JointTorque, PhysicsEngine, Simulation};

/// Results of the benchmark. Rates are medians over its rounds, ratios medians of per-round ratios.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BenchReport {
    /// Worker threads of the many-threads figures.
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
    /// Our one-thread rate over bare rapier's.
    pub ratio_to_bare_rapier: f64,
    /// The many-threads rate over the one-thread rate.
    pub scaling: f64,
}

/// Genomes evaluated per thread in a round: a quarter of a second in rapier. A multiple of eight fills the lanes of an engine that steps
/// eight snakes side by side.
const GENOMES: usize = 64;

/// The work of a benchmark: genomes that are simulated in one trial.
#[derive(Debug)]
pub struct Workload {
    genomes: Vec<Genome>,
    trial: Trial,
}

impl Workload {
    /// Newborns of a run with these settings that are not disqualified: those stop early, and without them ours and
    /// bare rapier take the same steps.
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

    /// One champion, again and again. None if it is disqualified, since its trial then ends early.
    pub fn champion(genome: Genome, trial: Trial) -> Option<Self> {
        let runs_to_the_end = evaluate(&genome, &trial).disqualified.is_none();
        runs_to_the_end.then(|| Self { genomes: vec![genome; GENOMES], trial })
    }
}

/// Measures a workload for about `duration`, calling `progress` with the share done.
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
    // The first round warms the caches.
    if rounds.len() > 1 {
        rounds.remove(0);
    }
    let median_of = |value: fn(&Round) -> f64| median(rounds.iter().map(value).collect());
    let step_s = f64::from(trial.physics.step_s());
    let many = median_of(|round| round.many);
    Ok(BenchReport {
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

/// Steps per second of the three variants, measured one after the other.
struct Round {
    ours: f64,
    bare: f64,
    many: f64,
}

/// Steps per wall second of some work, which returns its number of steps.
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

/// Drives a snake with rapier as any program would: with the world and the torques of `evaluate`, without health checks, pose
/// copies and trace. Returns the world at the end.
fn step_bare(genome: &Genome, trial: &Trial) -> Simulation {
    let plan = trial.world_plan(genome);
    let mut simulation = Simulation::new(&plan);
    let mut control = ControlLoop::new(genome, &plan, trial.agent.senses);
    let mut torques = vec![JointTorque::default(); simulation.body().joints.len()];
    for step in 0..trial.steps() {
        control.act(step, &simulation, &mut torques);
        simulation.apply(&torques);
        simulation.physics_mut().step();
        simulation.dampen_half_step();
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
        assert_eq!(report.threads, 2);
        assert!(report.steps_per_s > 0.0 && report.ratio_to_bare_rapier > 0.0);
        assert!((report.sim_s_per_s * 60.0 / report.steps_per_s - 1.0).abs() < 1e-6);
    }
}
