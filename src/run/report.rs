//! What a generation was like, in numbers.

use std::collections::BTreeMap;

use xxhash_rust::xxh3::Xxh3Default;

use super::compare::Quartiles;
use crate::evolve::Champion;
use crate::save::{GenerationRecord, StatisticsRecord};
use crate::score::{Evaluation, Trial};
use crate::world::Disqualification;

/// The result of one generation.
#[derive(Debug, Clone, PartialEq)]
pub struct GenerationReport {
    /// The first is 1.
    pub generation: u32,
    /// Individuals that were evaluated.
    pub evaluations: u32,
    /// How many of them were disqualified, for whatever reason.
    pub disqualified: u32,
    /// How many for which reason; nothing of a generation that is known from its log.
    pub reasons: BTreeMap<Disqualification, u32>,
    /// On how many of them the program failed.
    pub crashed: u32,
    /// The first few of these.
    pub crashes: Vec<Crash>,
    /// How many ended on the landing, in good health.
    pub on_landing: u32,
    /// The index of the first of them.
    pub first_on_landing: Option<u32>,
    /// Fitness statistics over the others; none if all were disqualified.
    pub statistics: Option<Statistics>,
    /// What the mean means, in the words of the report's Table 1.
    pub meaning: String,
    /// Hash over the bits of every evaluation, in the order of the individuals.
    pub hash: u64,
    /// Wall-clock time the generation took, in seconds. Not part of any hash.
    pub elapsed_s: f64,
    /// The best individual; none if all were disqualified.
    pub champion: Option<Champion>,
}

/// A genome on which the program failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Crash {
    /// The individual; its evaluation is void.
    pub individual: Champion,
    /// What the program said.
    pub message: String,
}

impl GenerationReport {
    /// The line of the log.
    pub fn record(&self) -> GenerationRecord {
        GenerationRecord {
            generation: self.generation,
            evaluations: self.evaluations,
            disqualified: self.disqualified,
            crashed: self.crashed,
            on_landing: self.on_landing,
            first_on_landing: self.first_on_landing,
            statistics: self.statistics.map(|statistics| {
                let Statistics { mean, best, median, std, worst, mean_centre_y_m, quartiles } =
                    statistics;
                let (lower_quartile, upper_quartile) = quartiles.unzip();
                StatisticsRecord {
                    mean,
                    best,
                    median,
                    std,
                    worst,
                    mean_centre_y_m,
                    lower_quartile,
                    upper_quartile,
                }
            }),
            hash: format!("{:016x}", self.hash),
            elapsed_s: self.elapsed_s,
        }
    }

    /// The report that is in a line of the log, under the trial of its run.
    pub fn of_record(record: &GenerationRecord, champion: Option<Champion>, trial: &Trial) -> Self {
        let statistics = record.statistics.map(|statistics| {
            let StatisticsRecord { mean, best, median, std, worst, mean_centre_y_m, .. } =
                statistics;
            let quartiles = statistics.lower_quartile.zip(statistics.upper_quartile);
            Statistics { mean, best, median, std, worst, mean_centre_y_m, quartiles }
        });
        Self {
            generation: record.generation,
            evaluations: record.evaluations,
            disqualified: record.disqualified,
            reasons: BTreeMap::new(),
            crashed: record.crashed,
            crashes: Vec::new(),
            on_landing: record.on_landing,
            first_on_landing: record.first_on_landing,
            statistics,
            meaning: meaning(statistics.as_ref(), trial),
            // Reading the log has checked it.
            hash: record.generation_hash().unwrap_or(0),
            elapsed_s: record.elapsed_s,
            champion,
        }
    }
}

/// What a generation's mean means.
pub fn meaning(statistics: Option<&Statistics>, trial: &Trial) -> String {
    match statistics {
        Some(statistics) => trial.meaning(statistics.mean_centre_y_m),
        None => "all disqualified".to_owned(),
    }
}

/// How many were disqualified for which reason.
pub fn reasons(evaluations: &[Evaluation]) -> BTreeMap<Disqualification, u32> {
    let mut counts = BTreeMap::new();
    for reason in evaluations.iter().filter_map(|evaluation| evaluation.disqualified) {
        *counts.entry(reason).or_default() += 1;
    }
    counts
}

/// Statistics over the fitness of those agents of one generation that were not disqualified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Arithmetic mean.
    pub mean: f64,
    /// Greatest fitness.
    pub best: f64,
    /// Median; of an even number, the mean of the two middle ones.
    pub median: f64,
    /// Standard deviation of the whole population (divided by n).
    pub std: f64,
    /// Least fitness.
    pub worst: f64,
    /// Mean y of the centre at the end, in m, whatever is rewarded.
    pub mean_centre_y_m: f64,
    /// Below the first lies a quarter, above the second another; none where an earlier version of the program left
    /// them out.
    pub quartiles: Option<(f64, f64)>,
}

impl Statistics {
    /// The statistics of the healthy ones among `evaluations`, in a fixed order of summation.
    pub fn of(evaluations: &[Evaluation]) -> Option<Self> {
        let healthy = evaluations.iter().filter(|evaluation| evaluation.disqualified.is_none());
        let mut fitness: Vec<f64> = healthy.map(|e| f64::from(e.fitness)).collect();
        fitness.sort_by(f64::total_cmp);
        let (&worst, &best) = (fitness.first()?, fitness.last()?);
        let count = fitness.len() as f64;
        let mean = fitness.iter().sum::<f64>() / count;
        let variance = fitness.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
        let (low, high) = (fitness[(fitness.len() - 1) / 2], fitness[fitness.len() / 2]);
        let healthy = evaluations.iter().filter(|evaluation| evaluation.disqualified.is_none());
        let mean_centre_y_m = healthy.map(|e| f64::from(e.centre_y_m)).sum::<f64>() / count;
        let median = (low + high) / 2.0;
        let quartiles = Quartiles::of(fitness).map(|quartiles| (quartiles.low, quartiles.high));
        Some(Self { mean, best, median, std: variance.sqrt(), worst, mean_centre_y_m, quartiles })
    }
}

/// The hash of a generation: every evaluation's bits, in the order of the individuals.
pub fn generation_hash(evaluations: &[Evaluation]) -> u64 {
    let mut hash = Xxh3Default::new();
    for evaluation in evaluations {
        hash.update(&evaluation.trace_hash.to_le_bytes());
        hash.update(&evaluation.fitness.to_bits().to_le_bytes());
        hash.update(&evaluation.steps.to_le_bytes());
        hash.update(&[u8::from(evaluation.disqualified.is_some())]);
    }
    hash.digest()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluation(fitness: f32, disqualified: Option<Disqualification>) -> Evaluation {
        let centre_y_m = fitness + 1.0;
        Evaluation { centre_y_m, disqualified, ..Evaluation::of_fitness(fitness) }
    }

    #[test]
    fn statistics_leave_the_disqualified_out() {
        let evaluations = [
            evaluation(4.0, None),
            evaluation(180.0, Some(Disqualification::TooFast)),
            evaluation(-2.0, None),
            evaluation(1.0, None),
            evaluation(5.0, None),
        ];
        let statistics = Statistics::of(&evaluations).expect("four are healthy");
        assert_eq!((statistics.mean, statistics.median), (2.0, 2.5));
        assert_eq!((statistics.best, statistics.worst), (5.0, -2.0));
        assert_eq!(statistics.mean_centre_y_m, 3.0);
        assert_eq!(statistics.std, 7.5_f64.sqrt());
        assert_eq!(statistics.quartiles, Some((0.25, 4.25)), "of -2, 1, 4, 5");
        assert_eq!(Statistics::of(&evaluations[1..2]), None);
    }

    #[test]
    fn the_disqualified_are_counted_by_reason() {
        let evaluations = [
            evaluation(4.0, None),
            evaluation(180.0, Some(Disqualification::TooFast)),
            evaluation(-2.0, Some(Disqualification::LeftArena)),
            evaluation(190.0, Some(Disqualification::TooFast)),
        ];
        let counts = [(Disqualification::TooFast, 2), (Disqualification::LeftArena, 1)];
        assert_eq!(reasons(&evaluations), BTreeMap::from(counts));
    }

    #[test]
    fn the_hash_depends_on_the_order_of_the_individuals() {
        let [a, b] = [evaluation(1.0, None), evaluation(2.0, None)];
        assert_ne!(generation_hash(&[a, b]), generation_hash(&[b, a]));
    }
}
