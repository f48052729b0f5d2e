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

    /// Number of generations in the second half whose best snake has another structure of its body than the best of the
    /// generation before.
    pub fn late_body_changes(&self) -> usize {
        let structure = |report: &GenerationReport| {
            report.champion.as_ref().map(|champion| champion.genome.body.block_ids())
        };
        let structures: Vec<_> = self.reports.iter().map(structure).collect();
        let first_late = structures.len() / 2;
        let pairs = structures.iter().zip(structures.iter().skip(1)).skip(first_late.max(1) - 1);
        pairs.filter(|(before, after)| before != after).count()
    }
}
