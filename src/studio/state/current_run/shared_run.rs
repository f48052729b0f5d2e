//! The run on other computers: which evaluator it uses, and what happens when their results turn out to be wrong.

use std::sync::Arc;

use super::{CurrentRun, RunStatus};
use snakes_core::save::{ExistingRun, run_name};
use snakes_lab::run::{Evaluator, RunSource};

impl CurrentRun {
    /// The evaluator of the next generation.
    pub(super) fn evaluator(&self) -> Arc<dyn Evaluator> {
        let shared = self.shared.as_ref().map(|(evaluator, _)| evaluator);
        Arc::clone(shared.unwrap_or(&self.context.evaluator))
    }

    /// Uses an evaluator on other computers from the next generation of this run on, or the threads of this computer
    /// again. Results do not depend on it.
    pub fn share(&mut self, shared: Option<Arc<dyn Evaluator>>) {
        self.shared = shared.map(|evaluator| (evaluator, self.reports.len()));
        if let Some(background) = &self.background {
            background.set_evaluator(self.evaluator());
        }
    }

    /// Whether other computers evaluate the next generation, too.
    #[cfg(test)]
    pub fn is_shared(&self) -> bool {
        self.shared.is_some()
    }

    /// Whether other computers evaluate the generation in progress, too.
    pub fn is_shared_by_now(&self) -> bool {
        self.shared.as_ref().is_some_and(|(_, before)| self.reports.len() > *before)
    }

    /// Whether a run is in progress that other computers could evaluate, and its name.
    pub fn to_share(&self) -> Option<String> {
        let is_open = matches!(self.status(), RunStatus::Running | RunStatus::Paused);
        is_open.then(|| run_name(&self.source.plan))
    }

    /// Stops the run, because results in it cannot be trusted, and holds it before its first generation. What was saved
    /// of it is discarded, so that nobody continues it.
    ///
    /// # Errors
    /// The run cannot be opened again, with the reason.
    pub fn end_untrusted(&mut self, reason: String) -> Result<(), String> {
        self.context.set_run_folder(None);
        self.replace(RunSource { earlier: ExistingRun::Discard, ..self.source.clone() });
        self.fault = Some(reason);
        self.background().map(drop)
    }

    /// Stops the run because the window closes, and lets go of its evaluator.
    pub fn stop_at_the_end(&mut self) {
        (self.background, self.before) = (None, None);
    }

    /// Why results cannot be trusted that other computers sent; once.
    pub fn take_fault(&mut self) -> Option<String> {
        self.fault.take()
    }
}
