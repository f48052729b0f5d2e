//! Lines of a run's logs: finished generations, and the evaluations of the current generation.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::change::load_changed_plan;
use super::files::refuse_link;
use super::log::{parse_log, read_log_bytes};
use super::run_name::fingerprint;
use crate::check::{Invalid, within};
use crate::evolve::{GenerationRecord, RunPlan};
use crate::score::Evaluation;
use crate::world::Disqualification;

pub const LOG_FILE: &str = "log.jsonl";
pub const EVALUATIONS_FILE: &str = "evaluations.jsonl";

/// An evaluation of the current generation, as a line of the log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvaluationRecord {
    /// Fingerprint of the run's plan.
    pub plan: String,
    pub generation: u32,
    pub individual: u32,
    pub disqualified: Option<Disqualification>,
    pub recorded: Evaluation,
}

/// Counts the finished generations in a run's folder: the complete lines of its log, without parsing them.
pub fn count_records(folder: &Path) -> Result<u32, SaveError> {
    let bytes = read_log_bytes(&folder.join(LOG_FILE))?;
    Ok(bytes.iter().filter(|byte| **byte == b'\n').count() as u32)
}

/// Reads the finished generations from a run's folder.
pub fn read_records(folder: &Path, plan: &RunPlan) -> Result<Vec<GenerationRecord>, SaveError> {
    let path = folder.join(LOG_FILE);
    parse_records(&path, &read_log_bytes(&path)?, plan)
}

/// Reads the plan of the run in a folder after all its changes, and the log of its finished generations. Does not read the champions.
///
/// # Errors
/// Fails if the folder has no run, if another engine recorded the run, or if a file is damaged.
pub fn load_log(folder: &Path) -> Result<(RunPlan, Vec<GenerationRecord>), SaveError> {
    let plan = load_changed_plan(folder)?;
    let records = read_records(folder, &plan)?;
    Ok((plan, records))
}

/// Parses finished generations. Errors name the log `path`; `plan` is the plan of the run after all its changes.
///
/// # Errors
/// Fails if a complete line is damaged, is out of order, or is beyond the end of the run.
pub fn parse_records(
    path: &Path,
    bytes: &[u8],
    plan: &RunPlan,
) -> Result<Vec<GenerationRecord>, SaveError> {
    let records: Vec<GenerationRecord> = parse_log(path, bytes)?;
    let mut numbered = (1..).zip(&records);
    let checked = numbered.try_for_each(|(number, record)| record.check(number, plan));
    checked.map_err(SaveError::invalid(path))?;
    Ok(records)
}

/// Reads the evaluations of the current generation in the order in which they were written. Returns none if the log is damaged: the
/// evaluations are then computed again.
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

/// Parses the evaluations of a generation; errors name the log `path`. Returns none if the log belongs to another generation or run.
///
/// # Errors
/// Fails if a complete line is damaged, or has a value that is not allowed.
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
        recorded.check()?;
        Ok((individual, Evaluation { disqualified, ..recorded }))
    };
    let read = records.into_iter().map(read).collect::<Result<_, Invalid>>();
    read.map_err(SaveError::invalid(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{BandCount, Rung, Settings, SpeciesCount};
    use crate::score::EndingKind;

    fn record() -> GenerationRecord {
        GenerationRecord::of_test(1, 5)
    }

    /// Writes a log of one generation, and reads it.
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
            (vec![of(1, 3, None), of(2, 3, None)], "species.sum of size is 6; allowed: 0 to 5"),
            (vec![of(2, 1, None), of(2, 1, None)], "species.id is 2; allowed: one after 2"),
            (vec![of(1, 1, Some(f32::MAX))], "species.best is 3.4028235e38"),
            (vec![of(1, 1, None); 25], "species.number of counts is 25; allowed: 0 to 24"),
        ] {
            let error = with(species).expect_err("refused").to_string();
            assert!(error.contains(problem), "{error}");
        }
        let ending = |id| BandCount { id, size: 1, best: None };
        let endings = [EndingKind::OffTheSide, EndingKind::Landed].map(ending).to_vec();
        let error = read_again(&GenerationRecord { endings, ..record() }).expect_err("refused");
        let problem = "endings.id is \"landed\"; allowed: one after \"off-the-side\"";
        assert!(error.to_string().contains(problem), "{error}");
    }
}
