//! Motions of newborns in both physics engines.

use crate::run::{Cancelled, EvaluationResult, Evaluator, Job, RunControl, evaluate_in_order};
use crate::statistics::Quartiles;
use snakes_core::evolve::Settings;
use snakes_core::genome::Genome;
use snakes_core::rng::{Purpose, stream};
use snakes_core::schema::Choices;
use snakes_core::score::Evaluation;
use snakes_core::world::PhysicsEngine;

/// Statistics of a measure of newborns' motion, in both engines.
#[derive(Debug, Clone, PartialEq)]
pub struct NewbornStatistics {
    /// Name of the measure, with its unit.
    pub measure: &'static str,
    /// Quartiles of the measure in rapier and in lanes; `None` without healthy newborns.
    pub quartiles: Option<[Quartiles; 2]>,
}

impl NewbornStatistics {
    /// Returns the greatest relative difference of a quartile between the engines; `None` without quartiles.
    pub fn greatest_difference(&self) -> Option<f64> {
        let [a, b] = self.quartiles.as_ref()?;
        let pairs = [(a.low, b.low), (a.median, b.median), (a.high, b.high)];
        let difference = |(a, b): (f64, f64)| {
            let greater = a.abs().max(b.abs());
            if greater > 0.0 { (a - b).abs() / greater } else { 0.0 }
        };
        Some(pairs.into_iter().map(difference).fold(0.0, f64::max))
    }
}

/// Simulates newborns of a run with these settings and seed in both engines, and compares their motions. Only newborns that are
/// healthy in both engines count. Also returns their number.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn newborn_statistics(
    settings: &Settings,
    seed: u64,
    newborns: u32,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<(Vec<NewbornStatistics>, usize), Cancelled> {
    let genomes: Vec<Genome> = (0..newborns)
        .map(|individual| {
            let mut rng = stream(seed, 1, individual, Purpose::Birth);
            settings.genome.random_genome(settings.trial.genome_shape(), &mut rng)
        })
        .collect();
    let mut in_engines = Vec::new();
    for arm in PhysicsEngine::OPTIONS {
        let mut trial = settings.trial.clone();
        trial.physics.engine = *arm;
        trial.repeats.trials = 1;
        let jobs: Vec<Job<'_>> = genomes.iter().map(|genome| Job { genome, trial: 0 }).collect();
        let trials = [trial];
        in_engines.push(evaluate_in_order(&trials, &jobs, evaluator, control)?);
    }
    let healthy = |result: &EvaluationResult| {
        let evaluation = result.as_ref().ok().map(|scored| scored.evaluation)?;
        evaluation.disqualified.is_none().then_some(evaluation)
    };
    let [in_rapier, in_lanes] = [0, 1].map(|engine| in_engines[engine].iter().map(healthy));
    let pairs: Vec<[Evaluation; 2]> =
        in_rapier.zip(in_lanes).filter_map(|(a, b)| Some([a?, b?])).collect();
    let start_y_m = settings.trial.start_y_m;
    let statistics = MEASURES.map(|(measure, value)| {
        let of =
            |engine: usize| Quartiles::of(pairs.iter().map(|pair| value(&pair[engine], start_y_m)));
        NewbornStatistics { measure, quartiles: of(0).zip(of(1)).map(|(a, b)| [a, b]) }
    });
    Ok((statistics.to_vec(), pairs.len()))
}

/// Name of a measure, and a function that computes it from an evaluation and the y coordinate of its start, in m.
type NewbornMeasure = (&'static str, fn(&Evaluation, f32) -> f64);

const MEASURES: [NewbornMeasure; 4] = [
    ("distance covered, m", |of, start_y_m| f64::from((of.centre_y_m - start_y_m).abs())),
    ("share of limbs in contact", |of, _| {
        of.behaviour.map_or(0.0, |behaviour| behaviour.contact_duty.into())
    }),
    ("greatest gap of a joint, mm", |of, _| {
        of.effort.map_or(0.0, |effort| f64::from(effort.joint_drift_m) * 1000.0)
    }),
    ("energy spent, kJ", |of, _| {
        of.effort.map_or(0.0, |effort| f64::from(effort.energy_j) / 1000.0)
    }),
];
