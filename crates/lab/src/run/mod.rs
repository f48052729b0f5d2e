//! Runs: evaluation, pause and cancel, statistics, saving, background threads and the headless mode.

mod background;
mod background_task;
pub mod bench;
mod evaluated_generation;
mod evaluator;
pub mod evaluators;
pub mod exam;
mod experiment;
mod generation_trials;
pub mod headless;
mod json;
pub mod judge;
mod library_reader;
mod lineage;
mod lookahead;
pub mod markdown;
pub mod names;
mod panics;
mod parallel_runs;
pub mod progress_bar;
mod recorder;
mod replay;
mod report;
pub mod robust;
mod run_control;
pub mod terminal;
mod tune;
pub mod verify;
mod whole_runs;

pub use background::{BackgroundRun, Exploration, OpenedRun, RunEvent};
pub use background_task::BackgroundTask;
pub(crate) use evaluator::evaluate_in_order;
pub use evaluator::{
    EvaluationResult, Evaluator, Job, LocalPool, THREADS_RANGE, WorkersError, available_cores,
    evaluate_caught, examine_caught,
};
pub use experiment::Experiment;
pub use json::{short, with_short_numbers};
pub use library_reader::{LibraryEvent, LibraryReader};
pub use lineage::{Ancestor, Ancestry, FitnessSpread, Generation};
pub use lookahead::Lookahead;
pub use panics::{caught, end_without_threads, report_panics, with_threads};
pub use parallel_runs::{ParallelRuns, ParallelRunsEvent};
pub use recorder::{ChangeError, RecordedRun, RunRecorder, RunSource};
pub use replay::{difference_from_record, replay};
pub use report::{Crash, GenerationReport};
pub use run_control::{Cancelled, RunControl};
pub use tune::{Tuned, tune_controller};
pub(crate) use whole_runs::whole_runs;
