//! Studies: runs of several arms over several seeds, measured by the same values, compared, and held against demands.
//!
//! A study is data, built in or written by a user: see `docs/studies.md`. POET alone is studied in a way of its own.

mod bodies;
mod champion;
mod compare;
mod definition;
mod driver;
mod edits;
mod figure;
mod findings;
mod measure;
mod newborns;
pub mod poet;
mod report;
mod run;
mod values;

pub use compare::{ArmComparison, comparisons};
pub use definition::{
    Arm, Changes, DURATION, Demand, Examined, Goal, Methods, Plain, Study, built_in_studies,
    suites_named,
};
pub use driver::{StudyFiles, perform, picture};
pub use figure::{controllers, curve, curves, short_title};
pub use findings::Findings;
pub use measure::{Measure, Measured, Results, Verdict};
pub use newborns::NewbornStatistics;
pub use report::{json_lines, tables, values_as_markdown};
pub use run::{FinishedRun, PlannedRun};
pub use values::{Form, ValueInfo, value, values};

#[cfg(test)]
mod tests;
