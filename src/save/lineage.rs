//! Who came from whom: a line for each finished generation, so that a run that goes on still knows.
//!
//! Nothing of a run depends on it. What cannot be written, or does not fit the run, is left out: then the lines
//! of descent begin later.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::log::{parse_log, read_log_bytes};
use crate::check::{Invalid, within};
use crate::evolve::{Parents, Place, RunPlan};
use crate::score::FITNESS_RANGE;

pub const LINEAGE_FILE: &str = "lineage.jsonl";

/// The most values of a generation's fitness that are written down.
pub const MOST_SPREAD: usize = 40;

/// What of a generation is known later.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineageRecord {
    /// The first is 1.
    pub generation: u32,
    /// Some of the healthy ones' fitness, from the least to the greatest, spread evenly over them.
    pub spread: Vec<f32>,
    /// Those who may have children, in the strategy's order, and the best if that may have none.
    pub born: Vec<BornRecord>,
}

/// An individual: its index, its fitness unless it was disqualified, and whom it comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BornRecord(pub u32, pub Option<f32>, pub ParentsRecord);

/// [`Parents`] in few letters: a place is a generation and an index in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ParentsRecord {
    /// Nobody.
    #[serde(rename = "n")]
    Newborn,
    /// One.
    #[serde(rename = "1")]
    One(u32, u32),
    /// Two.
    #[serde(rename = "2")]
    Two(u32, u32, u32, u32),
    /// Nobody in particular.
    #[serde(rename = "d")]
    Distribution,
    /// Not known.
    #[serde(rename = "u")]
    Unknown,
}

impl From<Parents> for ParentsRecord {
    fn from(parents: Parents) -> Self {
        match parents {
            Parents::Newborn => Self::Newborn,
            Parents::One(a) => Self::One(a.generation, a.individual),
            Parents::Two(a, b) => Self::Two(a.generation, a.individual, b.generation, b.individual),
            Parents::Distribution => Self::Distribution,
            Parents::Unknown => Self::Unknown,
        }
    }
}

impl From<ParentsRecord> for Parents {
    fn from(record: ParentsRecord) -> Self {
        let place = |generation, individual| Place { generation, individual };
        match record {
            ParentsRecord::Newborn => Self::Newborn,
            ParentsRecord::One(g, i) => Self::One(place(g, i)),
            ParentsRecord::Two(g, i, h, j) => Self::Two(place(g, i), place(h, j)),
            ParentsRecord::Distribution => Self::Distribution,
            ParentsRecord::Unknown => Self::Unknown,
        }
    }
}

/// What is known of the first `finished` generations of a run's folder; nothing, if it is damaged.
pub fn read_lineage(folder: &Path, finished: u32, plan: &RunPlan) -> Vec<LineageRecord> {
    let path = folder.join(LINEAGE_FILE);
    let read = read_log_bytes(&path).and_then(|bytes| parse_lineage(&path, &bytes, plan));
    let mut records = read.unwrap_or_default();
    records.retain(|record| record.generation <= finished);
    records
}

/// Reads who came from whom from the bytes of a log; `path` is what errors call it.
///
/// # Errors
/// A whole line is damaged, out of its order, or has a value that is not allowed.
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
        within("spread", record.spread.len(), 0..=MOST_SPREAD)?;
        record.spread.iter().try_for_each(|&x| within("spread", x, FITNESS_RANGE))?;
        for BornRecord(individual, fitness, parents) in &record.born {
            within("individual", u64::from(*individual), 0..=last)?;
            fitness.map_or(Ok(()), |fitness| within("fitness", fitness, FITNESS_RANGE))?;
            for parent in Parents::from(*parents).places() {
                // Nobody comes from a generation of its own, or a line of descent would have no end.
                let earlier = 1..=generation.saturating_sub(1);
                within("parent's generation", parent.generation, earlier)?;
                within("parent", u64::from(parent.individual), 0..=last)?;
            }
        }
        Ok(())
    };
    let checked = records.iter().try_for_each(&mut check);
    checked.map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    Ok(records)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::save::log::Log;

    fn record(generation: u32, parents: Parents) -> LineageRecord {
        let born =
            vec![BornRecord(3, Some(-7.1), parents.into()), BornRecord(0, None, parents.into())];
        LineageRecord { generation, spread: vec![-8.0, -7.1], born }
    }

    fn plan() -> RunPlan {
        RunPlan::new("test", 1, Settings::default())
    }

    fn place(generation: u32) -> Place {
        Place { generation, individual: 3 }
    }

    #[test]
    fn it_comes_back_as_far_as_the_run_has_come() {
        let folder = tempfile::tempdir().expect("a folder");
        let plan = plan();
        assert_eq!(read_lineage(folder.path(), 9, &plan), []);
        let records = [
            record(1, Parents::Newborn),
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
    fn what_makes_no_sense_is_left_out() {
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
        assert_eq!(whole(&record(7, Parents::Newborn)), 0, "a run of six generations");
        let spread = vec![0.0; MOST_SPREAD + 1];
        assert_eq!(whole(&LineageRecord { spread, ..record(1, Parents::Newborn) }), 0);
    }
}
