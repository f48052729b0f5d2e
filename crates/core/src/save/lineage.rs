//! Parents of individuals: `lineage.jsonl`, one line per finished generation, from which a resumed run knows them.
//!
//! The results of a run do not depend on this file. Lines that cannot be written or do not fit the run are omitted; lines of descent then
//! begin later.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::log::{parse_log, read_log_bytes};
use crate::check::{Invalid, within};
use crate::evolve::{IndividualId, Parents, RunPlan};
use crate::score::FITNESS_RANGE;

pub const LINEAGE_FILE: &str = "lineage.jsonl";

/// Maximum number of fitness values that are written per generation.
pub const MAX_SPREAD: usize = 40;

/// Fitness values and parents of one generation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineageRecord {
    /// Number of the generation; the first is 1.
    pub generation: u32,
    /// Fitness values of healthy individuals, ascending, sampled evenly.
    pub spread: Vec<f32>,
    /// The individuals that may become parents, in the strategy's order, and the best individual.
    pub born: Vec<IndividualRecord>,
}

/// An individual: its index, its fitness (none if it was disqualified), and its parents.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct IndividualRecord(pub u32, pub Option<f32>, pub ParentsRecord);

/// [`Parents`] in compact form: each parent is a generation and an index in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ParentsRecord {
    /// The individual was drawn at random.
    #[serde(rename = "n")]
    Newborn,
    /// The individual has one parent: generation and index.
    #[serde(rename = "1")]
    One(u32, u32),
    /// The individual has two parents: generation and index of each.
    #[serde(rename = "2")]
    Two(u32, u32, u32, u32),
    /// The individual was drawn from a search distribution.
    #[serde(rename = "d")]
    Distribution,
    /// The parents are unknown.
    #[serde(rename = "u")]
    Unknown,
}

impl From<Parents> for ParentsRecord {
    fn from(parents: Parents) -> Self {
        match parents {
            Parents::None => Self::Newborn,
            Parents::One(a) => Self::One(a.generation, a.individual),
            Parents::Two(a, b) => Self::Two(a.generation, a.individual, b.generation, b.individual),
            Parents::Distribution => Self::Distribution,
            Parents::Unknown => Self::Unknown,
        }
    }
}

impl From<ParentsRecord> for Parents {
    fn from(record: ParentsRecord) -> Self {
        let place = |generation, individual| IndividualId { generation, individual };
        match record {
            ParentsRecord::Newborn => Self::None,
            ParentsRecord::One(g, i) => Self::One(place(g, i)),
            ParentsRecord::Two(g, i, h, j) => Self::Two(place(g, i), place(h, j)),
            ParentsRecord::Distribution => Self::Distribution,
            ParentsRecord::Unknown => Self::Unknown,
        }
    }
}

/// Reads the records of the first `finished` generations from a run's folder; empty if the file is damaged.
pub fn read_lineage(folder: &Path, finished: u32, plan: &RunPlan) -> Vec<LineageRecord> {
    let path = folder.join(LINEAGE_FILE);
    let read = read_log_bytes(&path).and_then(|bytes| parse_lineage(&path, &bytes, plan));
    let mut records = read.unwrap_or_default();
    records.retain(|record| record.generation <= finished);
    records
}

/// Parses lineage records; errors name the file `path`.
///
/// # Errors
/// Fails if a complete line is damaged, is out of order, or has a value that is not allowed.
pub fn parse_lineage(
    path: &Path,
    bytes: &[u8],
    plan: &RunPlan,
) -> Result<Vec<LineageRecord>, SaveError> {
    let records: Vec<LineageRecord> = parse_log(path, bytes)?;
    let last = plan.budget().saturating_sub(1);
    let mut next = 1;
    let mut check = |record: &LineageRecord| -> Result<(), Invalid> {
        let generation = record.generation;
        within("generation", generation, next..=plan.settings.evolution.generations)?;
        next = generation + 1;
        within("spread", record.spread.len(), 0..=MAX_SPREAD)?;
        record.spread.iter().try_for_each(|&x| within("spread", x, FITNESS_RANGE))?;
        for IndividualRecord(individual, fitness, parents) in &record.born {
            within("individual", u64::from(*individual), 0..=last)?;
            fitness.map_or(Ok(()), |fitness| within("fitness", fitness, FITNESS_RANGE))?;
            for parent in Parents::from(*parents).ids() {
                // A parent is of an earlier generation. Otherwise a line of descent could be endless.
                let earlier = 1..=generation.saturating_sub(1);
                within("parent's generation", parent.generation, earlier)?;
                within("parent", u64::from(parent.individual), 0..=last)?;
            }
        }
        Ok(())
    };
    let checked = records.iter().try_for_each(&mut check);
    checked.map_err(SaveError::invalid(path))?;
    Ok(records)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::save::log::Log;

    fn record(generation: u32, parents: Parents) -> LineageRecord {
        let born = vec![
            IndividualRecord(3, Some(-7.1), parents.into()),
            IndividualRecord(0, None, parents.into()),
        ];
        LineageRecord { generation, spread: vec![-8.0, -7.1], born }
    }

    fn plan() -> RunPlan {
        RunPlan::new("test", 1, Settings::default())
    }

    fn place(generation: u32) -> IndividualId {
        IndividualId { generation, individual: 3 }
    }

    #[test]
    fn lineage_is_read_back_up_to_the_last_finished_generation() {
        let folder = tempfile::tempdir().expect("a folder");
        let plan = plan();
        assert_eq!(read_lineage(folder.path(), 9, &plan), []);
        let records = [
            record(1, Parents::None),
            record(2, Parents::One(place(1))),
            record(4, Parents::Two(place(1), place(2))),
            record(5, Parents::Unknown),
            record(6, Parents::Distribution),
        ];
        let mut log = Log::open(&folder.path().join(LINEAGE_FILE), 0).expect("opened");
        records.iter().for_each(|record| log.append_lightly(record).expect("written"));
        assert_eq!(read_lineage(folder.path(), 6, &plan), records);
        assert_eq!(read_lineage(folder.path(), 4, &plan), records[..3]);
    }

    #[test]
    fn impossible_records_are_ignored() {
        let plan = plan();
        let whole = |record: &LineageRecord| {
            let folder = tempfile::tempdir().expect("a folder");
            let mut log = Log::open(&folder.path().join(LINEAGE_FILE), 0).expect("opened");
            log.append_lightly(record).expect("written");
            read_lineage(folder.path(), 9, &plan).len()
        };
        assert_eq!(whole(&record(2, Parents::One(place(1)))), 1);
        assert_eq!(whole(&record(2, Parents::One(place(2)))), 0, "its own parent");
        assert_eq!(whole(&record(1, Parents::One(place(1)))), 0, "a line without an end");
        assert_eq!(whole(&record(7, Parents::None)), 0, "a run of six generations");
        let spread = vec![0.0; MAX_SPREAD + 1];
        assert_eq!(whole(&LineageRecord { spread, ..record(1, Parents::None) }), 0);
    }
}
