//! The rows of a comparison against its first, seed by seed.

use super::compare::{ComparisonRow, ComparisonTables};
use super::sign_test::PairedDifference;
use snakes_core::save::Comparison;

/// For each row but the first, how often its best fitness beats that of the first row with the same seed, and by how
/// much. A run whose snakes were all disqualified is beaten by any other.
pub fn paired_text(comparison: &Comparison) -> String {
    let rows = comparison.rows();
    let Some((reference, others)) = rows.split_first() else { return String::new() };
    others.iter().map(|row| against(row, reference)).collect()
}

fn against(row: &ComparisonRow<'_>, reference: &ComparisonRow<'_>) -> String {
    let mut failed = 0;
    let mut pairs = Vec::new();
    for run in &row.runs {
        let Some(other) = reference.runs.iter().find(|other| other.seed == run.seed) else {
            continue;
        };
        let pair = [run, other].map(|run| run.best.map(|best| f64::from(best.fitness)));
        failed += pair.iter().filter(|fitness| fitness.is_none()).count();
        pairs.push(pair);
    }
    let name = |row: &ComparisonRow<'_>| format!("{}, {}", row.strategy, row.controller);
    let words = PairedDifference::of(&pairs).words();
    let failed = match failed {
        0 => String::new(),
        count => format!("; {count} runs without a healthy snake count as lower"),
    };
    format!("{} against {}: best fitness {words}{failed}\n", name(row), name(reference))
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::StrategyKind;
    use snakes_core::genome::ControllerKind;
    use snakes_core::save::{CURVE_POINTS, ComparedBest, ComparedRun};

    fn run(strategy: StrategyKind, seed: u64, fitness: Option<f32>) -> ComparedRun {
        let best = fitness.map(|fitness| ComparedBest {
            fitness,
            steps_climbed: 0,
            energy_j_per_m: None,
            cost_of_transport: None,
            climbing_efficiency: None,
        });
        ComparedRun {
            strategy,
            controller: ControllerKind::Gait,
            seed,
            evaluations: 1,
            best,
            first_on_landing: None,
            last_mean: None,
            curve: vec![fitness; CURVE_POINTS],
            run_hash: String::new(),
        }
    }

    #[test]
    fn rows_are_compared_with_the_first_seed_by_seed() {
        let mut comparison = Comparison::new("test", String::new(), 1, Default::default());
        for seed in 1..=6 {
            comparison.add(run(StrategyKind::Ga, seed, Some(seed as f32)));
            comparison.add(run(StrategyKind::CmaEs, seed, Some(seed as f32 + 2.0)));
            comparison.add(run(StrategyKind::Random, seed, (seed > 2).then_some(9.0)));
        }
        let text = paired_text(&comparison);
        let lines: Vec<&str> = text.lines().collect();
        let expected = "cma_es, gait against ga, gait: best fitness higher with 6 of 6 seeds (sign test p = 0.031), median \
                        difference +2.000 (95 % interval +2.000 to +2.000)";
        assert_eq!(lines[0], expected);
        assert!(
            lines[1].starts_with("random, gait against ga, gait: best fitness higher with 4 of 6")
        );
        assert!(lines[1].ends_with("; 2 runs without a healthy snake count as lower"), "{text}");
    }
}
