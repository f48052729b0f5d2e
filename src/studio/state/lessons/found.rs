//! Results of a lesson's runs.

use snakes_core::evolve::Champion;
use snakes_lab::run::GenerationReport;

/// Results of one run of a lesson.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Name of the run.
    pub name: String,
    /// Reports of the run's finished generations.
    pub reports: Vec<GenerationReport>,
    /// Hash of the run; `None` until the run is finished.
    pub run_hash: Option<u64>,
}

impl Found {
    /// Creates the results of a run with this name, before its first generation.
    pub fn of(name: &str) -> Self {
        Self { name: name.to_owned(), reports: Vec::new(), run_hash: None }
    }

    /// Returns the best champion so far.
    pub fn best(&self) -> Option<&Champion> {
        let ranked = self.reports.iter().filter_map(|report| {
            let [first, second] = report.champion_rank()?;
            Some((report.champion.as_ref()?, [first, second]))
        });
        // On a ladder, higher stairs rank before greater fitness.
        let by_rank = |(_, a): &(_, [f32; 2]), (_, b): &(_, [f32; 2])| {
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
        };
        ranked.max_by(by_rank).map(|(champion, _)| champion)
    }

    /// Counts the generations in the second half of the run whose best snake differs in the structure of its body from
    /// that of the previous generation.
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
