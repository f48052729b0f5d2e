//! Lines of a run's logs: finished generations, and the evaluations of the current one.

use std::path::Path;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::SaveError;
use super::change::load_changed_plan;
use super::files::{hash_of, refuse_link};
use super::log::{parse_log, read_log_bytes};
use super::run_name::fingerprint;
use super::v5::RecordedV5;
use crate::check::{Invalid, within};
use crate::evolve::{RunPlan, StairsTree};
use crate::score::{Evaluation, FITNESS_RANGE, Trial};
use crate::world::Disqualification;

pub const LOG_FILE: &str = "log.jsonl";
pub const EVALUATIONS_FILE: &str = "evaluations.jsonl";

/// A finished generation, as a line of the log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenerationRecord {
    /// The first is 1.
    pub generation: u32,
    /// Number of individuals that were evaluated.
    pub evaluations: u32,
    /// Number of these that were disqualified, for any reason.
    pub disqualified: u32,
    /// Number of these on which the program panicked.
    pub crashed: u32,
    /// Number of these that ended on the landing.
    pub on_landing: u32,
    /// Index of the first one on the landing; none if there is none.
    pub first_on_landing: Option<u32>,
    /// Fitness statistics of the healthy individuals; none if all were disqualified.
    pub statistics: Option<Statistics>,
    /// The champion's fitness over the varied trials on which the run chose it; none if it chose by the trial alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen_by: Option<f64>,
    /// The largest species, [`MOST_SPECIES_RECORDED`] at most, in ascending order of their numbers; of evolving bodies the
    /// numbers of blocks. Empty for a strategy without both, and in older logs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub species: Vec<SpeciesCount>,
    /// The rung of the ladder on which it was evaluated; none without a ladder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rung: Option<Rung>,
    /// Numbers of the stairs after it; none unless stairs evolve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stairs: Option<StairsCount>,
    /// Hash over the bits of every evaluation, in 16 hexadecimal digits.
    pub hash: String,
    /// Wall-clock time since the generation began or the program was started, in seconds.
    pub elapsed_s: f64,
}

/// Statistics over the fitness of the healthy individuals of one generation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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
    /// Mean final y of the centre, in m, independent of what is rewarded.
    pub mean_centre_y_m: f64,
    /// Lower quartile; none in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_quartile: Option<f64>,
    /// Upper quartile; none in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_quartile: Option<f64>,
}

impl Statistics {
    /// Lower and upper quartile; none in logs of earlier versions of the program.
    pub fn quartiles(&self) -> Option<(f64, f64)> {
        self.lower_quartile.zip(self.upper_quartile)
    }
}

/// A rung of a ladder of stairs, and the success of a generation on it. The ladder's next rung follows from these of all
/// generations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rung {
    /// Rise of the stairs, in m.
    pub rise_m: f32,
    /// Number of individuals that succeeded.
    pub successes: u32,
}

impl Rung {
    /// A trial on the stairs of this rung.
    pub fn on(&self, mut trial: Trial) -> Trial {
        trial.stairs.rise_m = self.rise_m.into();
        trial
    }
}

/// Numbers of the stairs of a run whose stairs evolve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StairsCount {
    /// Finished rounds.
    pub rounds: u32,
    /// All stairs so far.
    pub all: u32,
    /// Stairs whose snakes still learn.
    pub active: u32,
    /// Stairs that were solved.
    pub solved: u32,
    /// Solved stairs that were neither too easy nor too hard for any snake when they came (ANNECS).
    pub challenges: u32,
}

impl StairsCount {
    /// The numbers of a tree.
    pub fn of(tree: &StairsTree) -> Self {
        Self {
            rounds: tree.rounds,
            all: tree.nodes.len() as u32,
            active: tree.active() as u32,
            solved: tree.solved() as u32,
            challenges: tree.solved_challenges() as u32,
        }
    }

    /// In words.
    pub fn words(self) -> String {
        let Self { rounds, all, active, solved, challenges } = self;
        let round = rounds.saturating_add(1);
        let words = format!("round {round}, {all} stairs, {active} active, {solved} solved");
        match challenges {
            // Not every strategy knows new challenges.
            0 => words,
            _ => format!("{words}, {challenges} new challenges"),
        }
    }

    fn check(self) -> Result<(), Invalid> {
        within("stairs.active", self.active, 0..=self.all)?;
        within("stairs.solved", self.solved, 0..=self.all)?;
        within("stairs.challenges", self.challenges, 0..=self.solved)
    }
}

/// Maximum number of species that the log has of a generation, so that the log of the longest run can be read again.
pub const MOST_SPECIES_RECORDED: usize = 24;

/// A species in a generation. Files have it as a list: number, size, best fitness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(into = "(u32, u32, Option<f32>)", from = "(u32, u32, Option<f32>)")]
pub struct SpeciesCount {
    /// Number of the species; ascending in the order of appearance.
    pub id: u32,
    /// Number of its individuals, at least 1.
    pub size: u32,
    /// The best fitness of its healthy individuals; none if all were disqualified.
    pub best: Option<f32>,
}

/// An evaluation of the current generation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvaluationRecord {
    /// Fingerprint of the run's plan.
    pub plan: String,
    pub generation: u32,
    pub individual: u32,
    pub disqualified: Option<Disqualification>,
    pub recorded: RecordedV5,
}

impl From<SpeciesCount> for (u32, u32, Option<f32>) {
    fn from(SpeciesCount { id, size, best }: SpeciesCount) -> Self {
        (id, size, best)
    }
}

impl From<(u32, u32, Option<f32>)> for SpeciesCount {
    fn from((id, size, best): (u32, u32, Option<f32>)) -> Self {
        Self { id, size, best }
    }
}

impl GenerationRecord {
    /// Hash over the bits of every evaluation.
    ///
    /// # Errors
    /// The field is not a hash.
    pub fn generation_hash(&self) -> Result<u64, Invalid> {
        hash_of("hash", &self.hash)
    }
}

/// Hash over the hashes of all generations: that of a run.
pub fn generations_hash(records: &[GenerationRecord]) -> u64 {
    let mut hash = Xxh3Default::new();
    for record in records {
        // Reading the log has checked it.
        hash.update(&record.generation_hash().unwrap_or(0).to_le_bytes());
    }
    hash.digest()
}

/// Counts the finished generations of a run's folder: the complete lines of its log, without parsing them.
pub fn count_records(folder: &Path) -> Result<u32, SaveError> {
    let bytes = read_log_bytes(&folder.join(LOG_FILE))?;
    Ok(bytes.iter().filter(|byte| **byte == b'\n').count() as u32)
}

/// The finished generations of a run's folder.
pub fn read_records(folder: &Path, plan: &RunPlan) -> Result<Vec<GenerationRecord>, SaveError> {
    let path = folder.join(LOG_FILE);
    parse_records(&path, &read_log_bytes(&path)?, plan)
}

/// Reads the plan of the run in a folder after all its changes, and the log of its finished generations, without the
/// champions.
///
/// # Errors
/// The folder contains no run, another engine recorded it, or a file is damaged.
pub fn load_log(folder: &Path) -> Result<(RunPlan, Vec<GenerationRecord>), SaveError> {
    let plan = load_changed_plan(folder)?;
    let records = read_records(folder, &plan)?;
    Ok((plan, records))
}

/// Parses finished generations; `path` is the log's name in errors, and `plan` is the plan after all changes.
///
/// # Errors
/// A complete line is damaged, out of order, or beyond the end of the run.
pub fn parse_records(
    path: &Path,
    bytes: &[u8],
    plan: &RunPlan,
) -> Result<Vec<GenerationRecord>, SaveError> {
    let records: Vec<GenerationRecord> = parse_log(path, bytes)?;
    let generations = plan.settings.evolution.generations;
    let most = u32::try_from(plan.budget()).unwrap_or(u32::MAX);
    let check = |(record, generation): (&GenerationRecord, u32)| {
        within("generation", record.generation, generation..=generation)?;
        within("generation", generation, 1..=generations)?;
        within("evaluations", record.evaluations, 0..=most)?;
        within("disqualified", record.disqualified, 0..=record.evaluations)?;
        within("crashed", record.crashed, 0..=record.disqualified)?;
        within("on_landing", record.on_landing, 0..=record.evaluations)?;
        if let Some(first) = record.first_on_landing {
            within("first_on_landing", first, 0..=record.evaluations.saturating_sub(1))?;
        }
        within("elapsed_s", record.elapsed_s, 0.0..=1.0e9)?;
        let (least, most) = (f64::from(*FITNESS_RANGE.start()), f64::from(*FITNESS_RANGE.end()));
        if let Some(fitness) = record.chosen_by {
            within("chosen_by", fitness, least..=most)?;
        }
        if let Some(statistics) = record.statistics {
            let Statistics { mean, best, median, std, worst, mean_centre_y_m, .. } = statistics;
            let quartiles = [statistics.lower_quartile, statistics.upper_quartile];
            let values = [mean, best, median, std, worst, mean_centre_y_m];
            let mut values = values.into_iter().chain(quartiles.into_iter().flatten());
            values.try_for_each(|value| within("statistics", value, least..=most))?;
        }
        check_species(record)?;
        if let Some(Rung { rise_m, successes }) = record.rung {
            within("rung.rise_m", rise_m, 0.0..=5.0)?;
            within("rung.successes", successes, 0..=record.evaluations)?;
        }
        record.stairs.map_or(Ok(()), StairsCount::check)?;
        hash_of("hash", &record.hash).map(drop)
    };
    let checked = records.iter().zip(1..).try_for_each(check);
    checked.map_err(SaveError::invalid(path))?;
    Ok(records)
}

/// Checks the species of a generation: each individual belongs to one at most.
fn check_species(record: &GenerationRecord) -> Result<(), Invalid> {
    let evaluations = u64::from(record.evaluations);
    within("number of species", record.species.len(), 0..=MOST_SPECIES_RECORDED)?;
    let (mut members, mut least_id) = (0, 0);
    for SpeciesCount { id, size, best } in &record.species {
        within("species.id", u64::from(*id), least_id..=u64::from(u32::MAX))?;
        within("species.size", u64::from(*size), 1..=evaluations)?;
        if let Some(best) = best {
            within("species.best", *best, FITNESS_RANGE)?;
        }
        least_id = u64::from(*id) + 1;
        members += u64::from(*size);
        within("sum of species.size", members, 0..=evaluations)?;
    }
    Ok(())
}

/// Reads the evaluations of the current generation in the order in which they were written. Damaged ones are ignored:
/// they will be computed again.
pub fn read_evaluations(
    folder: &Path,
    generation: u32,
    plan: &RunPlan,
) -> Result<Vec<(u32, Evaluation)>, SaveError> {
    let path = folder.join(EVALUATIONS_FILE);
    refuse_link(&path).map_err(SaveError::unreadable(&path))?;
    let Ok(bytes) = read_log_bytes(&path) else { return Ok(Vec::new()) };
    Ok(parse_evaluations(&path, &bytes, generation, plan).unwrap_or_default())
}

/// Parses the evaluations of a generation; `path` is the log's name in errors. None are returned if the log belongs to
/// another generation or run.
///
/// # Errors
/// A complete line is damaged, or has a value that is not allowed.
pub fn parse_evaluations(
    path: &Path,
    bytes: &[u8],
    generation: u32,
    plan: &RunPlan,
) -> Result<Vec<(u32, Evaluation)>, SaveError> {
    let records: Vec<EvaluationRecord> = parse_log(path, bytes)?;
    let of = fingerprint(plan);
    if records.iter().any(|record| record.generation != generation || record.plan != of) {
        return Ok(Vec::new());
    }
    let read = |record: EvaluationRecord| {
        let last = plan.budget().saturating_sub(1);
        within("individual", u64::from(record.individual), 0..=last)?;
        let EvaluationRecord { individual, disqualified, recorded, .. } = record;
        Ok((individual, Evaluation { disqualified, ..recorded.evaluation()? }))
    };
    let read = records.into_iter().map(read).collect::<Result<_, Invalid>>();
    read.map_err(SaveError::invalid(path))
}

impl GenerationRecord {
    /// A generation of this number of healthy individuals, of which nothing else is known; for tests.
    pub fn of_test(generation: u32, evaluations: u32) -> Self {
        Self {
            generation,
            evaluations,
            disqualified: 0,
            crashed: 0,
            on_landing: 0,
            first_on_landing: None,
            statistics: None,
            chosen_by: None,
            species: Vec::new(),
            rung: None,
            stairs: None,
            hash: "0123456789abcdef".to_owned(),
            elapsed_s: 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;

    fn record() -> GenerationRecord {
        GenerationRecord::of_test(1, 5)
    }

    /// A log of this generation, read again.
    fn read_again(record: &GenerationRecord) -> Result<Vec<GenerationRecord>, SaveError> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(LOG_FILE);
        super::super::log::Log::open(&path, 0).expect("opened").append(record).expect("written");
        let plan = RunPlan::new("test", 1, Settings::default());
        parse_records(&path, &read_log_bytes(&path).expect("read"), &plan)
    }

    #[test]
    fn a_log_without_species_has_no_word_about_them() {
        let text = serde_json::to_string(&record()).expect("written");
        assert!(!text.contains("species"), "{text}");
        assert_eq!(read_again(&record()).expect("read"), [record()]);
    }

    #[test]
    fn a_rung_is_read_again_and_an_impossible_one_is_refused() {
        assert!(!serde_json::to_string(&record()).expect("written").contains("rung"));
        let with = |rise_m, successes| {
            let rung = Some(Rung { rise_m, successes });
            read_again(&GenerationRecord { rung, ..record() })
        };
        let read = with(0.35, 5).expect("allowed");
        assert_eq!(read[0].rung, Some(Rung { rise_m: 0.35, successes: 5 }));
        let error = with(0.35, 6).expect_err("refused").to_string();
        assert!(error.contains("rung.successes is 6; allowed: 0 to 5"), "{error}");
        let error = with(7.0, 1).expect_err("refused").to_string();
        assert!(error.contains("rung.rise_m is 7; allowed: 0 to 5"), "{error}");
    }

    #[test]
    fn species_are_read_again_and_impossible_ones_are_refused() {
        let of = |id, size, best| SpeciesCount { id, size, best };
        assert_eq!(serde_json::to_string(&of(3, 4, Some(0.1))).expect("written"), "[3,4,0.1]");
        let with = |species| read_again(&GenerationRecord { species, ..record() });
        let good = vec![of(3, 4, Some(0.1)), of(u32::MAX, 1, None)];
        assert_eq!(with(good.clone()).expect("allowed")[0].species, good);
        for (species, problem) in [
            (vec![of(1, 0, None)], "species.size is 0; allowed: 1 to 5"),
            (vec![of(1, 6, None)], "species.size is 6; allowed: 1 to 5"),
            (vec![of(1, 3, None), of(2, 3, None)], "sum of species.size is 6; allowed: 0 to 5"),
            (vec![of(2, 1, None), of(2, 1, None)], "species.id is 2; allowed: 3 to 4294967295"),
            (vec![of(1, 1, Some(f32::MAX))], "species.best is 34028"),
            (vec![of(1, 1, None); 25], "number of species is 25; allowed: 0 to 24"),
        ] {
            let error = with(species).expect_err("refused").to_string();
            assert!(error.contains(problem), "{error}");
        }
    }
}
