//! The rows of a comparison against its first, seed by seed.

use super::compare::ComparisonRow;
use super::sign_test::{median_difference, sign_test};
use crate::save::Comparison;

impl Comparison {
    /// For each row but the first, how often its best fitness beats that of the first row with the same seed, and by how
    /// much; empty without seeds in common.
    pub fn paired_text(&self) -> String {
        let rows = self.rows();
        let Some((reference, others)) = rows.split_first() else { return String::new() };
        others.iter().filter_map(|row| against(row, reference)).collect()
    }
}

fn against(row: &ComparisonRow<'_>, reference: &ComparisonRow<'_>) -> Option<String> {
    let fitness = |of: &ComparisonRow<'_>, seed: u64| {
        let run = of.runs.iter().find(|run| run.seed == seed)?;
        Some(f64::from(run.best?.fitness))
    };
    let pair = |seed| Some(fitness(row, seed)? - fitness(reference, seed)?);
    let differences: Vec<f64> = row.runs.iter().filter_map(|run| pair(run.seed)).collect();
    let count = |of: fn(f64) -> bool| differences.iter().filter(|by| of(**by)).count() as u32;
    let (more, fewer, pairs) = (count(|by| by > 0.0), count(|by| by < 0.0), differences.len());
    let (median, interval) = median_difference(differences)?;
    let name = |row: &ComparisonRow<'_>| format!("{}, {}", row.strategy, row.controller);
    let interval = interval.map_or("no interval below 6 seeds".to_owned(), |[from, to]| {
        format!("95 % interval {from:+.3} to {to:+.3}")
    });
    Some(format!(
        "{} against {}: higher best fitness with {more} of {pairs} seeds (sign test p = {:.3}), median difference \
         {median:+.3} ({interval})\n",
        name(row),
        name(reference),
        sign_test(more, fewer),
    ))
}
