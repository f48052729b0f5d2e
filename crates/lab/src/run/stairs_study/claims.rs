//! The results of the study against what is claimed of snakes that learn on many stairs.

use super::arm::StairsArm;
use crate::run::markdown::markdown_table;
use crate::run::report::Quartiles;
use crate::run::robust::Share;
use crate::run::study::StudyArm;
use snakes_core::genome::{HELD_OUT_PER_CLASS, StairsClass};
use snakes_core::save::{StairsStudyRun, StudyRuns};
use snakes_core::schema::Choices;

/// How many times as many held-out stairs a generalist must climb.
const TIMES: f64 = 2.0;

/// The results as Markdown: the share of the held-out stairs that the champions of each arm climb, and the claim with its
/// verdict.
pub fn stairs_claims(runs: &StudyRuns<StairsStudyRun>) -> String {
    let head = ["claim", "must", "measured", "met"].map(str::to_owned).to_vec();
    format!(
        "{}\n95 % intervals over all champions and stairs; {} stairs of each class; median [quartiles] of 60 over the seeds\n\n{}",
        markdown_table(&overview(runs), 1),
        HELD_OUT_PER_CLASS,
        markdown_table(&[head, claim(runs)], 4)
    )
}

fn overview(runs: &StudyRuns<StairsStudyRun>) -> Vec<Vec<String>> {
    let mut head: Vec<String> =
        ["learned as", "runs", "trials", "of 60", "share"].map(str::to_owned).to_vec();
    head.extend(StairsClass::names().into_iter().map(str::to_owned));
    let row = |arm: &StairsArm| {
        let of_arm = runs.of_arm(arm.name());
        let mut row = vec![
            arm.choice().title.to_owned(),
            of_arm.len().to_string(),
            Quartiles::words(of_arm.iter().map(|run| run.trials.into()), 0),
            Quartiles::words(of_arm.iter().map(|run| f64::from(run.climbed_in_all())), 0),
            rate(&of_arm).map_or("–".to_owned(), |rate| words(&rate)),
        ];
        for class in 0..StairsClass::OPTIONS.len() {
            let climbed = of_arm.iter().filter_map(|run| run.climbed.get(class)).sum();
            let rate = Share::of(climbed, HELD_OUT_PER_CLASS * of_arm.len() as u32);
            row.push(if of_arm.is_empty() { "–".to_owned() } else { words(&rate) });
        }
        row
    };
    [head].into_iter().chain(StairsArm::OPTIONS.iter().map(row)).collect()
}

/// The share of all held-out stairs that the champions of some runs climb.
fn rate(runs: &[&StairsStudyRun]) -> Option<Share> {
    let climbed = runs.iter().map(|run| run.climbed_in_all()).sum();
    let all = HELD_OUT_PER_CLASS * StairsClass::OPTIONS.len() as u32 * runs.len() as u32;
    (all > 0).then(|| Share::of(climbed, all))
}

fn words(rate: &Share) -> String {
    format!("{:.2} [{:.2}, {:.2}]", rate.seen, rate.least, rate.most)
}

fn claim(runs: &StudyRuns<StairsStudyRun>) -> Vec<String> {
    let [generalist, specialist] =
        [StairsArm::Generalist, StairsArm::Specialist].map(|arm| rate(&runs.of_arm(arm.name())));
    let (measured, verdict) = match generalist.zip(specialist) {
        None => ("–".to_owned(), "not measured"),
        Some((generalist, specialist)) => {
            let times = generalist.seen / specialist.seen.max(f64::MIN_POSITIVE);
            let is_met = times >= TIMES && generalist.least > specialist.most;
            let times = if specialist.seen > 0.0 {
                format!("{times:.2} times")
            } else {
                "against none".to_owned()
            };
            (
                format!("{times}; {} against {}", words(&generalist), words(&specialist)),
                if is_met { "yes" } else { "no" },
            )
        }
    };
    vec![
        "held-out stairs climbed, generalist against specialist".to_owned(),
        format!("{TIMES} times as many, intervals apart"),
        measured,
        verdict.to_owned(),
    ]
}

/// The runs as records for a CSV file, the names of the columns first.
pub fn stairs_records(runs: &StudyRuns<StairsStudyRun>) -> Vec<Vec<String>> {
    let mut head: Vec<String> =
        ["arm", "seed", "evaluations", "trials", "fitness"].map(str::to_owned).to_vec();
    head.extend(StairsClass::names().into_iter().map(str::to_owned));
    head.push("run_hash".to_owned());
    let mut records = vec![head];
    for arm in StairsArm::OPTIONS {
        for run in runs.of_arm(arm.name()) {
            let mut record = vec![
                arm.name().to_owned(),
                run.seed.to_string(),
                run.evaluations.to_string(),
                run.trials.to_string(),
                run.fitness.map_or(String::new(), |fitness| fitness.to_string()),
            ];
            let classes = 0..StairsClass::OPTIONS.len();
            record.extend(classes.map(|class| {
                run.climbed.get(class).map_or(String::new(), |climbed| climbed.to_string())
            }));
            record.push(run.run_hash.clone());
            records.push(record);
        }
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(seed: u64, climbed: [u32; 4]) -> StairsStudyRun {
        StairsStudyRun {
            seed,
            evaluations: 100,
            trials: 900,
            fitness: Some(0.8),
            climbed: climbed.to_vec(),
            run_hash: "0".repeat(16),
        }
    }

    #[test]
    fn the_claim_needs_twice_as_many_stairs_and_intervals_that_are_apart() {
        let mut runs = StudyRuns::new(String::new(), 100);
        assert!(stairs_claims(&runs).contains("not measured"));
        for seed in 1..=3 {
            runs.add("generalist", run(seed, [14, 12, 6, 12]));
            runs.add("specialist", run(seed, [10, 8, 0, 4]));
        }
        let text = stairs_claims(&runs);
        assert!(text.contains("2.00 times; 0.73 [0.66, 0.79] against 0.37 [0.30, 0.44]"), "{text}");
        assert!(text.contains("| yes"), "{text}");
        runs.add("specialist", run(3, [10, 8, 1, 4]));
        assert!(stairs_claims(&runs).contains("| no "), "{}", stairs_claims(&runs));
        let records = stairs_records(&runs);
        assert_eq!(records.len(), 7);
        assert!(records.iter().all(|record| record.len() == records[0].len()));
    }
}
