//! Results of a lesson's runs.

use crate::evolve::Champion;
use crate::run::GenerationReport;

/// Results of a lesson's run.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Name of the run.
    pub name: String,
    /// Reports of the finished generations.
    pub reports: Vec<GenerationReport>,
    /// Hash, once the run is finished.
    pub run_hash: Option<u64>,
}

impl Found {
    /// The best champion so far.
    pub fn best(&self) -> Option<&Champion> {
        let champions = self.reports.iter().filter_map(|report| report.champion.as_ref());
        champions.max_by(|a, b| a.evaluation.fitness.total_cmp(&b.evaluation.fitness))
    }
}
