//! The registry of evaluators, from which the command line chooses.
//!
//! A new evaluator is a file in `evaluators/` and a row of [`EVALUATORS`].

use std::sync::Arc;

use super::evaluator::{Evaluator, LocalPool, WorkersError};

/// A row of the registry: an evaluator that the command line offers.
#[derive(Debug, Clone, Copy)]
pub struct EvaluatorInfo {
    /// Name of the evaluator in the flag `--evaluator`.
    pub name: &'static str,
    /// Where its simulations run, in a few words.
    pub words: &'static str,
    /// Starts the evaluator with this number of workers.
    pub start: fn(usize) -> Result<Arc<dyn Evaluator>, WorkersError>,
}

/// All evaluators, the default first.
pub const EVALUATORS: &[EvaluatorInfo] = &[EvaluatorInfo {
    name: "threads",
    words: "in threads of this process",
    start: |workers| Ok(Arc::new(LocalPool::new(workers)?)),
}];
