//! Summary of a run's generations: which have champions, and which of these are better than all earlier ones.

use std::cmp::Ordering;
use std::sync::Arc;

use snakes_lab::run::GenerationReport;

/// Summary of a run, which is computed once for each new report instead of in every frame.
#[derive(Debug, Clone)]
pub(super) struct ReportSummary {
    /// Number of generations that have a champion.
    pub champions: usize,
    /// Generation of the best champion of the run; `None` without any champion.
    pub best: Option<u32>,
    /// Indices of the reports whose champions are better than all earlier ones.
    pub better: Arc<[usize]>,
}

impl ReportSummary {
    /// Computes the summary of a run.
    pub fn of(reports: &[GenerationReport]) -> Self {
        let champions = reports
            .iter()
            .filter_map(|report| Some((report.champion.as_ref()?, report.champion_rank()?)));
        // Among equally good champions, the earliest counts as the best.
        let best = champions.clone().rev().max_by(|(_, a), (_, b)| {
            let pairs = a.iter().zip(b);
            pairs.fold(Ordering::Equal, |so_far, (a, b)| so_far.then(a.total_cmp(b)))
        });
        let mut most = [f32::MIN; 2];
        let is_better = |report: &GenerationReport| {
            let rank = report.champion_rank().filter(|rank| *rank > most);
            most = rank.unwrap_or(most);
            rank.is_some()
        };
        let all = reports.iter().map(is_better).enumerate();
        let better = all.filter(|(_, is_better)| *is_better).map(|(index, _)| index).collect();
        Self {
            champions: champions.count(),
            best: best.map(|(champion, _)| champion.origin.generation),
            better,
        }
    }
}
