//! Every family of controllers over several seeds, and the demands that its results are held against.
//!
//! Nothing here reads a number that belongs to a learner: the settings of each family are those of a preset, and the
//! list in `family` only says which preset, which controller, and which demands.

mod champion;
mod demand;
mod family;
#[cfg(test)]
pub mod fixtures;
mod measure;
mod results;
mod table;
mod training;

pub use demand::{Demand, Verdict};
pub use family::{DEFAULT_SUITES, Family, FamilyInfo, Training};
pub use measure::{Measure, Measured};
pub use results::{ExaminedChampion, FamilyResults, Results, seeds_to_examine};
pub use table::{exam_records, tables};
pub use training::{FinishedRun, PlannedFamilyRun, missing, train};
