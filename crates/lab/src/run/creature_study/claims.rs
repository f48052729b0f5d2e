//! The results of the study against what is claimed of creatures.

use std::collections::BTreeSet;

use super::arm::{CreatureArm, GOAL_STEPS, GOAL_WAY_M};
use crate::run::markdown::markdown_table;
use crate::run::report::Quartiles;
use crate::run::sign_test::PairedDifference;
use crate::run::study::StudyArm;
use snakes_core::save::{CreatureStudyRun, StudyRuns};
use snakes_core::schema::Choices;

/// Share of the seeds that must reach the goal on flat ground, and on the stairs.
const FLAT_SHARE: f64 = 0.8;
const STAIRS_SHARE: f64 = 0.5;
/// Number of different trees of joints among the best creatures of ten seeds.
const SHAPES: usize = 4;

/// The results as Markdown: what was measured of each arm, and each claim with its verdict.
pub fn creature_claims(runs: &StudyRuns<CreatureStudyRun>) -> String {
    let found = [
        reached(runs, CreatureArm::Flat, FLAT_SHARE, &format!("{GOAL_WAY_M} m on flat ground")),
        reached(runs, CreatureArm::Stairs, STAIRS_SHARE, &format!("{GOAL_STEPS} steps of 0.25 m")),
        shapes(runs),
        neurons(runs),
    ];
    let head = ["claim", "must", "measured", "met"].map(str::to_owned).to_vec();
    let claims: Vec<Vec<String>> = [head].into_iter().chain(found).collect();
    format!(
        "{}\nmedian [quartiles] over the seeds; way: of the middle of the best creature; shapes: different trees of joints\n\n{}",
        markdown_table(&overview(runs), 1),
        markdown_table(&claims, 4)
    )
}

fn overview(runs: &StudyRuns<CreatureStudyRun>) -> Vec<Vec<String>> {
    let head = ["arm", "runs", "reached", "evaluations", "way in m", "steps", "parts", "shapes"];
    let row = |arm: &CreatureArm| {
        let of_arm = runs.of_arm(arm.name());
        let show = |value: &dyn Fn(&CreatureStudyRun) -> f64, digits: usize| {
            Quartiles::words(of_arm.iter().map(|run| value(run)), digits)
        };
        let reached = of_arm.iter().filter(|run| run.reached_after.is_some()).count();
        vec![
            arm.choice().title.to_owned(),
            of_arm.len().to_string(),
            reached.to_string(),
            show(&|run| run.evaluations.into(), 0),
            show(&|run| run.way_m.into(), 1),
            show(&|run| run.steps.into(), 0),
            show(&|run| run.parts.into(), 0),
            trees(&of_arm).len().to_string(),
        ]
    };
    let rows = CreatureArm::OPTIONS.iter().map(row);
    [head.map(str::to_owned).to_vec()].into_iter().chain(rows).collect()
}

fn trees<'a>(runs: &[&'a CreatureStudyRun]) -> BTreeSet<&'a str> {
    runs.iter().map(|run| run.tree.as_str()).collect()
}

fn row(claim: &str, must: String, measured: Option<(String, bool)>) -> Vec<String> {
    let (measured, verdict) = match measured {
        None => ("–".to_owned(), "not measured"),
        Some((measured, met)) => (measured, if met { "yes" } else { "no" }),
    };
    vec![claim.to_owned(), must, measured, verdict.to_owned()]
}

fn reached(
    runs: &StudyRuns<CreatureStudyRun>,
    arm: CreatureArm,
    share: f64,
    goal: &str,
) -> Vec<String> {
    let of_arm = runs.of_arm(arm.name());
    let after: Vec<u32> = of_arm.iter().filter_map(|run| run.reached_after).collect();
    let median = Quartiles::of(after.iter().map(|&after| f64::from(after)));
    let measured = (!of_arm.is_empty()).then(|| {
        let words = median.map_or(String::new(), |median| {
            format!(", the median after {:.0} evaluations", median.median)
        });
        let is_met = after.len() as f64 >= share * of_arm.len() as f64;
        (format!("{} of {}{words}", after.len(), of_arm.len()), is_met)
    });
    let budget = arm.evaluations(0);
    let must = format!("{:.0} % of the seeds within {budget} evaluations", 100.0 * share);
    row(goal, must, measured)
}

fn shapes(runs: &StudyRuns<CreatureStudyRun>) -> Vec<String> {
    let of_arm = runs.of_arm(CreatureArm::Standard.name());
    let trees = trees(&of_arm);
    let measured = (!of_arm.is_empty())
        .then(|| (format!("{} of {} runs", trees.len(), of_arm.len()), trees.len() >= SHAPES));
    row("different trees of joints", format!("{SHAPES} or more"), measured)
}

/// Whether standard neurons are not worse than those of Sims.
fn neurons(runs: &StudyRuns<CreatureStudyRun>) -> Vec<String> {
    let [standard, sims] =
        [CreatureArm::Standard, CreatureArm::Sims].map(|arm| runs.of_arm(arm.name()));
    let fitness = |run: &CreatureStudyRun| run.fitness.map(f64::from);
    let pairs: Vec<[Option<f64>; 2]> = standard
        .iter()
        .filter_map(|run| {
            let other = sims.iter().find(|other| other.seed == run.seed)?;
            Some([fitness(run), fitness(other)])
        })
        .collect();
    let difference = PairedDifference::of(&pairs);
    let measured = difference.median.map(|(median, _)| (difference.words(), median >= 0.0));
    row("share with standard neurons, against those of Sims", "not lower".to_owned(), measured)
}

/// The runs as records for a CSV file, the names of the columns first.
pub fn creature_records(runs: &StudyRuns<CreatureStudyRun>) -> Vec<Vec<String>> {
    let head = [
        "arm",
        "seed",
        "evaluations",
        "reached_after",
        "fitness",
        "way_m",
        "steps",
        "parts",
        "tree",
        "run_hash",
    ];
    let mut records = vec![head.map(str::to_owned).to_vec()];
    for arm in CreatureArm::OPTIONS {
        for run in runs.of_arm(arm.name()) {
            records.push(vec![
                arm.name().to_owned(),
                run.seed.to_string(),
                run.evaluations.to_string(),
                run.reached_after.map_or(String::new(), |after| after.to_string()),
                run.fitness.map_or(String::new(), |fitness| fitness.to_string()),
                run.way_m.to_string(),
                run.steps.to_string(),
                run.parts.to_string(),
                run.tree.clone(),
                run.run_hash.clone(),
            ]);
        }
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(seed: u64, fitness: f32, reached_after: Option<u32>, tree: &str) -> CreatureStudyRun {
        CreatureStudyRun {
            seed,
            evaluations: 100,
            reached_after,
            fitness: Some(fitness),
            way_m: 6.0,
            steps: 3,
            parts: 4,
            tree: tree.to_owned(),
            run_hash: "0".repeat(16),
        }
    }

    #[test]
    fn every_claim_is_held_against_its_bound() {
        let mut runs = StudyRuns::new(String::new(), 100);
        assert_eq!(creature_claims(&runs).matches("not measured").count(), 4);
        for seed in 1..=10 {
            runs.add("flat", run(seed, 9.0, (seed > 2).then_some(500), "O(R)"));
            runs.add("stairs", run(seed, 0.5, (seed > 5).then_some(900), "O(R)"));
            let tree = format!("O({})", "R ".repeat(seed as usize % 4 + 1));
            runs.add("standard", run(seed, 0.6, None, &tree));
            runs.add("sims", run(seed, 0.5, None, &tree));
        }
        let text = creature_claims(&runs);
        for expected in
            ["8 of 10, the median after 500", "5 of 10, the median after 900", "4 of 10 runs"]
        {
            assert!(text.contains(expected), "{expected} in {text}");
        }
        assert_eq!(text.matches("| yes").count(), 4, "{text}");
        runs.add("flat", run(3, 1.0, None, "O(R)"));
        runs.add("stairs", run(6, 1.0, None, "O(R)"));
        runs.add("standard", run(3, 0.6, None, "O(R )"));
        runs.add("standard", run(7, 0.6, None, "O(R )"));
        assert_eq!(
            creature_claims(&runs).matches("| no ").count(),
            3,
            "{}",
            creature_claims(&runs)
        );
        assert_eq!(creature_records(&runs).len(), 41);
    }
}
