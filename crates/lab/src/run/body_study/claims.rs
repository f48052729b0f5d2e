//! The results of the study against what is claimed of evolving bodies.

use super::arm::Arm;
use crate::run::markdown::markdown_table;
use crate::run::report::Quartiles;
use crate::run::sign_test::PairedDifference;
use crate::run::study::StudyArm;
use snakes_core::evolve::{Archive, Settings, body_archive, feasible_cells};
use snakes_core::save::{BodyStudyRun, StudyRuns};
use snakes_core::schema::Choices;

/// Factor by which protection must raise the number of late changes of structure.
const MORE_CHANGES: f64 = 2.0;
/// Share of the feasible cells that MAP-Elites must fill.
const FILLED: f64 = 0.6;
/// Its quality-diversity score, relative to that of all that the genetic algorithm evaluated.
const MORE_DIVERSITY: f64 = 1.3;
/// Largest median change of the share by a split.
const SPLIT_CHANGE: f64 = 0.05;

/// The results as Markdown: what was measured of each arm, and each claim with its verdict.
pub fn claims(runs: &StudyRuns<BodyStudyRun>, settings: &Settings) -> String {
    let overview = markdown_table(&overview(runs), 1);
    let found = [protection(runs), filled(runs, settings), diversity(runs), split(runs)];
    let head = ["claim", "must", "measured", "met"].map(str::to_owned).to_vec();
    let rows: Vec<Vec<String>> = [head].into_iter().chain(found).collect();
    format!(
        "{overview}\nmedian [quartiles] over the seeds; changes: of structure, in the line of the best snake, and those in \
         the second half\nof the run; cells: of an archive of all that was evaluated\n\n{}",
        markdown_table(&rows, 4)
    )
}

fn overview(runs: &StudyRuns<BodyStudyRun>) -> Vec<Vec<String>> {
    let head = ["arm", "runs", "share", "blocks", "changes", "late changes", "cells", "QD score"];
    let row = |arm: &Arm| {
        let of_arm = runs.of_arm(arm.name());
        let show = |value: &dyn Fn(&BodyStudyRun) -> Option<f64>, digits: usize| {
            Quartiles::words(of_arm.iter().filter_map(|run| value(run)), digits)
        };
        vec![
            arm.choice().title.to_owned(),
            of_arm.len().to_string(),
            show(&|run| run.share.map(f64::from), 3),
            show(&|run| Some(run.blocks.into()), 0),
            show(&|run| Some(run.changes.into()), 1),
            show(&|run| Some(run.late_changes.into()), 1),
            show(&|run| Some(run.cells.into()), 0),
            show(&|run| Some(run.qd_score), 1),
        ]
    };
    [head.map(str::to_owned).to_vec()].into_iter().chain(Arm::OPTIONS.iter().map(row)).collect()
}

fn verdict(met: bool) -> String {
    (if met { "yes" } else { "no" }).to_owned()
}

fn not_measured(claim: &str, must: &str) -> Vec<String> {
    [claim, must, "–", "not measured"].map(str::to_owned).to_vec()
}

fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    Quartiles::of(values).map(|quartiles| quartiles.median)
}

/// The values of the runs of two arms with the same seeds.
fn pairs(
    runs: &StudyRuns<BodyStudyRun>,
    arms: [Arm; 2],
    value: impl Fn(&BodyStudyRun) -> f64,
) -> Vec<[f64; 2]> {
    let [first, second] = arms.map(|arm| runs.of_arm(arm.name()));
    let pair = |run: &&BodyStudyRun| {
        let other = second.iter().find(|other| other.seed == run.seed)?;
        Some([value(run), value(other)])
    };
    first.iter().filter_map(pair).collect()
}

/// Compares the values of both arms seed by seed.
fn compared(pairs: &[[f64; 2]]) -> PairedDifference {
    let known: Vec<[Option<f64>; 2]> = pairs.iter().map(|pair| pair.map(Some)).collect();
    PairedDifference::of(&known)
}

fn protection(runs: &StudyRuns<BodyStudyRun>) -> Vec<String> {
    let claim = "protection: changes of structure in the second half, and the share";
    let must = format!("{MORE_CHANGES} times as many or more, share not lower");
    let arms = [Arm::Protected, Arm::Unprotected];
    let changes = pairs(runs, arms, |run| run.late_changes.into());
    let shares = pairs(runs, arms, |run| run.share.unwrap_or(0.0).into());
    let sum = |of: usize| changes.iter().map(|pair| pair[of]).sum::<f64>();
    let (Some(share), Some(other)) =
        (median(shares.iter().map(|pair| pair[0])), median(shares.iter().map(|pair| pair[1])))
    else {
        return not_measured(claim, &must);
    };
    let difference = compared(&shares);
    let is_not_lower = difference.median.is_some_and(|(median, _)| median >= 0.0);
    let is_met = sum(0) >= MORE_CHANGES * sum(1) && sum(0) > 0.0 && is_not_lower;
    let measured = format!(
        "{:.0} against {:.0} in all; share {share:.3} against {other:.3}: {}",
        sum(0),
        sum(1),
        difference.words()
    );
    vec![claim.to_owned(), must, measured, verdict(is_met)]
}

fn filled(runs: &StudyRuns<BodyStudyRun>, settings: &Settings) -> Vec<String> {
    let claim = "MAP-Elites: feasible cells that are filled";
    let must = format!("{:.0} % or more", FILLED * 100.0);
    let bodies = &settings.genome.bodies;
    let rows = settings.evolution.body_map_elites.length_cells;
    let archive: Archive<()> = body_archive(bodies, rows, 0.0);
    let feasible = feasible_cells(&archive, bodies) as f64;
    let cells = runs.of_arm(Arm::Archive.name()).into_iter().map(|run| f64::from(run.cells));
    let Some(Quartiles { low, median, high }) = Quartiles::of(cells) else {
        return not_measured(claim, &must);
    };
    let [low, median, high] = [low, median, high].map(|cells| cells / feasible * 100.0);
    let measured = format!("{median:.0} % [{low:.0} {high:.0}] of {feasible:.0}");
    vec![claim.to_owned(), must, measured, verdict(median >= FILLED * 100.0)]
}

fn diversity(runs: &StudyRuns<BodyStudyRun>) -> Vec<String> {
    let claim = "MAP-Elites: QD score, relative to all that the GA evaluated";
    let must = format!("{MORE_DIVERSITY} or more");
    let scores = pairs(runs, [Arm::Archive, Arm::Protected], |run| run.qd_score);
    let ratios = scores.iter().map(|[archive, ga]| archive / ga.max(f64::MIN_POSITIVE));
    let Some(Quartiles { low, median, high }) = Quartiles::of(ratios) else {
        return not_measured(claim, &must);
    };
    let measured = format!("{median:.2} [{low:.2} {high:.2}]; {}", compared(&scores).words());
    vec![claim.to_owned(), must, measured, verdict(median >= MORE_DIVERSITY)]
}

fn split(runs: &StudyRuns<BodyStudyRun>) -> Vec<String> {
    let claim = "a split of a block changes the share little (GA, protected)";
    let must = format!("median {SPLIT_CHANGE} or less");
    let of_arm = runs.of_arm(Arm::Protected.name());
    let changes = |of: fn(&BodyStudyRun) -> &[f32]| -> Vec<f64> {
        of_arm.iter().flat_map(|run| of(run)).map(|change| f64::from(change.abs())).collect()
    };
    let (splits, insertions) =
        (changes(|run| &run.split_changes), changes(|run| &run.insertion_changes));
    let (count, others) = (splits.len(), insertions.len());
    let Some(Quartiles { low, median: middle, high }) = Quartiles::of(splits) else {
        return not_measured(claim, &must);
    };
    let insertion = median(insertions).map_or("–".to_owned(), |median| format!("{median:.3}"));
    let measured = format!(
        "{middle:.3} [{low:.3} {high:.3}] ({count} splits); {insertion} ({others} insertions)"
    );
    vec![claim.to_owned(), must, measured, verdict(middle <= SPLIT_CHANGE)]
}

/// The records of the CSV file, the header first: one per run.
pub fn study_records(runs: &StudyRuns<BodyStudyRun>) -> Vec<Vec<String>> {
    let head = [
        "arm",
        "seed",
        "evaluations",
        "share",
        "blocks",
        "changes",
        "late_changes",
        "cells",
        "qd_score",
        "median_split_change",
        "median_insertion_change",
        "run_hash",
    ];
    let mut records = vec![head.map(str::to_owned).to_vec()];
    for arm in Arm::OPTIONS {
        for run in runs.of_arm(arm.name()) {
            let change = |changes: &[f32]| {
                let median = median(changes.iter().map(|change| f64::from(change.abs())));
                median.map_or(String::new(), |median| median.to_string())
            };
            records.push(vec![
                arm.name().to_owned(),
                run.seed.to_string(),
                run.evaluations.to_string(),
                run.share.map_or(String::new(), |share| share.to_string()),
                run.blocks.to_string(),
                run.changes.to_string(),
                run.late_changes.to_string(),
                run.cells.to_string(),
                run.qd_score.to_string(),
                change(&run.split_changes),
                change(&run.insertion_changes),
                run.run_hash.clone(),
            ]);
        }
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(seed: u64, share: f32, late_changes: u32, cells: u32, qd_score: f64) -> BodyStudyRun {
        BodyStudyRun {
            seed,
            evaluations: 100,
            share: Some(share),
            blocks: 5,
            changes: late_changes + 1,
            late_changes,
            cells,
            qd_score,
            split_changes: vec![0.01, -0.03, 0.2],
            insertion_changes: vec![0.5, -0.25],
            run_hash: "0".repeat(16),
        }
    }

    #[test]
    fn every_claim_is_held_against_its_bound() {
        let settings = Settings::default();
        let mut runs = StudyRuns::new(String::new(), 100);
        let text = claims(&runs, &settings);
        assert_eq!(text.matches("not measured").count(), 4, "{text}");
        for seed in 1..=6 {
            runs.add("protected", run(seed, 0.8, 4, 40, 10.0));
            runs.add("unprotected", run(seed, 0.7, 2, 20, 5.0));
            runs.add("archive", run(seed, 0.6, 0, 110, 13.5));
        }
        let text = claims(&runs, &settings);
        for expected in [
            "24 against 12 in all; share 0.800 against 0.700: higher with 6 of 6 seeds (sign test p = 0.031), median difference +0.100",
            "65 % [65 65] of 168",
            "1.35 [1.35 1.35]",
            "0.030 [0.010 0.200] (18 splits); 0.375 (12 insertions)",
        ] {
            assert!(text.contains(expected), "{expected} in {text}");
        }
        assert_eq!(text.matches("| yes").count(), 4, "{text}");
        // One change more without protection, and the factor is no longer reached.
        runs.add("unprotected", run(6, 0.7, 3, 20, 5.0));
        assert_eq!(claims(&runs, &settings).matches("| no ").count(), 1, "{text}");
        assert_eq!(study_records(&runs).len(), 19);
    }
}
