//! The run on other computers: the choice of its evaluator, and the reaction to wrong results.

use std::sync::Arc;

use super::CurrentRun;
use snakes_core::save::ExistingRun;
use snakes_lab::run::{Evaluator, RunSource};

impl CurrentRun {
    /// Returns the evaluator of the next generation.
    pub(super) fn evaluator(&self) -> Arc<dyn Evaluator> {
        let shared = self.shared.as_ref().map(|(evaluator, _)| evaluator);
        Arc::clone(shared.unwrap_or(&self.context.evaluator))
    }

    /// Evaluates on other computers from the run's next generation on or, with `None`, on this computer only. Results
    /// do not depend on the evaluator.
    pub fn share(&mut self, shared: Option<Arc<dyn Evaluator>>) {
        self.shared = shared.map(|evaluator| (evaluator, self.reports.len()));
        if let Some(background) = &self.background {
            background.set_evaluator(self.evaluator());
        }
    }

    /// Returns whether other computers take part in the evaluation of the generation in progress.
    pub fn is_shared_by_now(&self) -> bool {
        self.shared.as_ref().is_some_and(|(_, before)| self.reports.len() > *before)
    }

    /// Stops the run because its results cannot be trusted, and holds it before its first generation. The saved
    /// generations are discarded, so that nobody resumes them.
    ///
    /// # Errors
    /// The run cannot be opened again, for the returned reason.
    pub fn end_untrusted(&mut self, reason: String) -> Result<(), String> {
        self.context.set_run_folder(None);
        self.replace(RunSource { earlier: ExistingRun::Discard, ..self.source.clone() });
        self.fault = Some(reason);
        self.background().map(drop)
    }

    /// Stops the run and releases its evaluator, because the window closes.
    pub fn stop_at_the_end(&mut self) {
        (self.background, self.before) = (None, None);
    }
}
