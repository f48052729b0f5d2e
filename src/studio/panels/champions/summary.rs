//! Summary of a run's generations: which have champions, and which of these are better than all earlier ones.

use std::cmp::Ordering;
use std::sync::Arc;

use snakes_core::evolve::Champion;
use snakes_lab::run::GenerationReport;

/// Summary of a run, which is computed once for each new report instead of in every frame.
#[derive(Debug, Clone)]
pub(super) struct ReportSummary {
    /// Number of generations that have a champion.
    pub champions: usize,
    /// Generation of the best champion of the run, and the word for it; `None` without any champion. The champion on the
    /// highest stairs may have less fitness than one on lower stairs.
    pub best: Option<(u32, &'static str)>,
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
        let marked = best.map(|(champion, _)| {
            let height_m = |champion: &Champion| champion.trial.stairs.highest_m();
            let is_lower = |other: &Champion| height_m(other) < height_m(champion);
            let has_lower = champions.clone().any(|(other, _)| is_lower(other));
            (champion.origin.generation, if has_lower { "highest" } else { "best" })
        });
        let mut most = [f32::MIN; 2];
        let is_better = |report: &GenerationReport| {
            let rank = report.champion_rank().filter(|rank| *rank > most);
            most = rank.unwrap_or(most);
            rank.is_some()
        };
        let all = reports.iter().map(is_better).enumerate();
        let better = all.filter(|(_, is_better)| *is_better).map(|(index, _)| index).collect();
        Self { champions: champions.count(), best: marked, better }
    }
}
