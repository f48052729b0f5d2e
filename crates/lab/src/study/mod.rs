//! Studies: runs of several arms over several seeds, measured by the same values, compared, and checked against demands.
//!
//! A study is data, built in or written by a user: see `docs/studies.md`. Only POET has a study with code of its own.

mod bodies;
mod champion;
mod checks;
mod compare;
mod definition;
mod driver;
mod edits;
mod figure;
mod findings;
mod measure;
mod newborns;
mod plans;
pub mod poet;
mod records;
mod report;
mod results;
mod run;
mod values;
mod words;

pub use checks::SEEDS;
pub use compare::{ArmComparison, comparisons};
pub use definition::{
    Arm, Changes, Demand, Examined, Goal, Methods, Plain, Study, built_in_studies, suites_named,
};
pub use driver::{StudyFiles, perform, picture};
pub use figure::{controllers, curve, curves, short_title};
pub use findings::Findings;
pub use measure::Measure;
pub use newborns::NewbornStatistics;
pub use plans::EVALUATIONS;
pub use records::json_lines;
pub use report::{tables, values_as_markdown};
pub use results::{Measured, Results, Verdict};
pub use run::{FinishedRun, PlannedRun};
pub use values::{Form, ValueInfo, number, value, values};

#[cfg(test)]
mod tests;
