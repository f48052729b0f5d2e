//! Results of a generation in numbers.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::ops::Deref;
use std::time::Duration;

use xxhash_rust::xxh3::Xxh3Default;

use super::evaluated_generation::EvaluatedGeneration;
use crate::statistics::Quartiles;
use snakes_core::evolve::{
    BandCount, Champion, GenerationRecord, MOST_SPECIES_RECORDED, Rung, SpeciesCount, StairsCount,
    StairsTree, Statistics,
};
use snakes_core::score::{EndingKind, Evaluation, Trial};
use snakes_core::world::Disqualification;

/// Report of one generation: its record, which is available by dereferencing, and data that the log does not keep.
#[derive(Debug, Clone, PartialEq)]
pub struct GenerationReport {
    /// Numbers of the generation, as the log keeps them.
    pub record: GenerationRecord,
    /// Number of disqualified individuals by reason. Empty for a generation that was read from its log.
    pub reasons: BTreeMap<Disqualification, u32>,
    /// The first individuals whose simulation panicked, at most three.
    pub crashes: Vec<Crash>,
    /// Meaning of the generation's mean fitness, in the words of the report's Table 1.
    pub meaning: String,
    /// Champion of the generation. `None` if all individuals were disqualified, or a run that keeps only better champions found
    /// none.
    pub champion: Option<Champion>,
}

impl Deref for GenerationReport {
    type Target = GenerationRecord;

    fn deref(&self) -> &GenerationRecord {
        &self.record
    }
}

/// An individual whose simulation panicked.
#[derive(Debug, Clone, PartialEq)]
pub struct Crash {
    /// The individual. Its evaluation is void.
    pub individual: Champion,
    /// Message of the panic.
    pub message: String,
}

/// Maximum number of crashes in a report.
const MAX_CRASHES: usize = 3;

impl GenerationReport {
    /// Makes the report of a generation. `messages` are those of panics, in the order of the individuals.
    pub(super) fn of(
        evaluated: &EvaluatedGeneration<'_>,
        champion: Option<Champion>,
        messages: Vec<Option<String>>,
        elapsed: Duration,
    ) -> Self {
        let EvaluatedGeneration { plan, generation, trials, rung, evaluations, .. } = *evaluated;
        let is_goal = trials.common.stairs == plan.settings.trial.stairs;
        let crashes = messages.into_iter().enumerate().filter_map(|(index, message)| {
            Some(Crash { individual: evaluated.individual(index), message: message? })
        });
        let reasons = reasons(evaluations);
        let landed =
            |index: &usize| is_goal && evaluations[*index].is_on_landing(&trials.of(*index).stairs);
        let first_on_landing = (0..evaluations.len()).find(landed);
        let record = GenerationRecord {
            generation,
            evaluations: evaluations.len() as u32,
            simulations: None,
            disqualified: reasons.values().sum(),
            crashed: reasons.get(&Disqualification::Crashed).copied().unwrap_or(0),
            on_landing: (0..evaluations.len()).filter(landed).count() as u32,
            first_on_landing: first_on_landing.map(|index| index as u32),
            statistics: statistics(evaluations),
            chosen_by: champion.as_ref().and_then(|of| of.chosen_by).map(f64::from),
            species: species(&evaluated.species(), evaluations),
            endings: endings(evaluations),
            rung,
            stairs: None,
            hash: generation_hash(evaluations),
            elapsed_s: elapsed.as_secs_f64(),
        };
        Self {
            meaning: meaning(&record, &trials.common),
            record,
            reasons,
            crashes: crashes.take(MAX_CRASHES).collect(),
            champion,
        }
    }

    /// Adds the numbers of the stairs, if stairs evolve.
    pub fn set_stairs(&mut self, tree: Option<&StairsTree>) {
        self.record.stairs = tree.map(StairsCount::of);
        if let Some(count) = self.record.stairs {
            self.meaning = count.words();
        }
    }

    /// Returns the numbers by which champions of a run are compared in order. Greater numbers are better. `None` without a
    /// champion.
    pub fn champion_rank(&self) -> Option<[f32; 2]> {
        let champion = self.champion.as_ref()?;
        match self.stairs {
            // A run in which stairs evolve keeps only champions that are better than all before, so the latest is the best.
            Some(_) => Some([self.generation as f32, 0.0]),
            None => Some(champion.rank()),
        }
    }

    /// Makes the report of a generation that was read from its log, under the trial of its run.
    pub fn of_record(record: GenerationRecord, champion: Option<Champion>, trial: &Trial) -> Self {
        let meaning = meaning(&record, trial);
        Self { record, reasons: BTreeMap::new(), crashes: Vec::new(), meaning, champion }
    }
}

/// Returns the meaning of a generation's mean fitness in words, with the rise of its rung if there is a ladder. Where stairs
/// evolve, returns the words about them.
fn meaning(record: &GenerationRecord, trial: &Trial) -> String {
    if let Some(count) = record.stairs {
        return count.words();
    }
    let words = match record.statistics {
        Some(statistics) => trial.meaning(statistics.mean_centre_y_m),
        None => "all disqualified".to_owned(),
    };
    match record.rung {
        Some(Rung { rise_m, .. }) => {
            format!("{words}, rise {} m", (rise_m * 1000.0).round() / 1000.0)
        }
        None => words,
    }
}

/// Counts the disqualified individuals by reason.
fn reasons(evaluations: &[Evaluation]) -> BTreeMap<Disqualification, u32> {
    let mut counts = BTreeMap::new();
    for reason in evaluations.iter().filter_map(|evaluation| evaluation.disqualified) {
        *counts.entry(reason).or_default() += 1;
    }
    counts
}

/// Counts the largest species of a generation. `numbers` has the species of each individual.
fn species(numbers: &[u32], evaluations: &[Evaluation]) -> Vec<SpeciesCount> {
    let mut species = SpeciesCount::of(numbers.iter().copied(), evaluations);
    species.sort_by_key(|count| (Reverse(count.size), count.id));
    species.truncate(MOST_SPECIES_RECORDED);
    species.sort_by_key(|count| count.id);
    species
}

/// Counts the ways in which the trials of a generation ended; empty if a trial has no ending, because its evaluation is of an earlier version.
fn endings(evaluations: &[Evaluation]) -> Vec<BandCount<EndingKind>> {
    let kinds = evaluations.iter().map(|evaluation| Some(evaluation.ending?.kind));
    let kinds: Option<Vec<EndingKind>> = kinds.collect();
    BandCount::of(kinds.unwrap_or_default(), evaluations)
}

/// Computes statistics over the healthy individuals, summed in a fixed order; `None` if all were disqualified.
fn statistics(evaluations: &[Evaluation]) -> Option<Statistics> {
    let healthy = || evaluations.iter().filter(|evaluation| evaluation.disqualified.is_none());
    let mut fitness: Vec<f64> = healthy().map(|e| f64::from(e.fitness)).collect();
    fitness.sort_by(f64::total_cmp);
    let (&worst, &best) = (fitness.first()?, fitness.last()?);
    let count = fitness.len() as f64;
    let mean = fitness.iter().sum::<f64>() / count;
    let variance = fitness.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
    let (low, high) = (fitness[(fitness.len() - 1) / 2], fitness[fitness.len() / 2]);
    let quartiles = Quartiles::of(fitness);
    Some(Statistics {
        mean,
        best,
        median: (low + high) / 2.0,
        std: variance.sqrt(),
        worst,
        mean_centre_y_m: healthy().map(|e| f64::from(e.centre_y_m)).sum::<f64>() / count,
        lower_quartile: quartiles.map(|quartiles| quartiles.low),
        upper_quartile: quartiles.map(|quartiles| quartiles.high),
    })
}

/// Returns the hash of a generation over the bits of every evaluation, in the order of the individuals.
fn generation_hash(evaluations: &[Evaluation]) -> u64 {
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
        let found = statistics(&evaluations).expect("four are healthy");
        assert_eq!((found.mean, found.median), (2.0, 2.5));
        assert_eq!((found.best, found.worst), (5.0, -2.0));
        assert_eq!(found.mean_centre_y_m, 3.0);
        assert_eq!(found.std, 7.5_f64.sqrt());
        assert_eq!(found.quartiles(), Some((0.25, 4.25)), "of -2, 1, 4, 5");
        assert_eq!(statistics(&evaluations[1..2]), None);
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
    fn species_are_counted_in_order_with_the_best_of_their_healthy_members() {
        let evaluations = [
            evaluation(4.0, None),
            evaluation(180.0, Some(Disqualification::TooFast)),
            evaluation(-2.0, None),
            evaluation(5.0, None),
        ];
        let counts = [
            SpeciesCount { id: 2, size: 2, best: Some(5.0) },
            SpeciesCount { id: 7, size: 1, best: None },
            SpeciesCount { id: 9, size: 1, best: Some(-2.0) },
        ];
        assert_eq!(species(&[2, 7, 9, 2], &evaluations), counts);
        assert_eq!(species(&[], &evaluations), []);
        // Of 30 species only the largest are kept. Of equally large species the older are kept.
        let numbers: Vec<u32> = (0..60).map(|index| index % 30).chain([29, 28]).collect();
        let kept = species(&numbers, &vec![evaluation(1.0, None); numbers.len()]);
        let ids: Vec<u32> = kept.iter().map(|count| count.id).collect();
        assert_eq!(ids, (0..22).chain([28, 29]).collect::<Vec<u32>>());
    }

    #[test]
    fn the_hash_depends_on_the_order_of_the_individuals() {
        let [a, b] = [evaluation(1.0, None), evaluation(2.0, None)];
        assert_ne!(generation_hash(&[a, b]), generation_hash(&[b, a]));
    }
}
