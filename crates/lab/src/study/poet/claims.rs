//! The claims about POET with their verdicts, as tables.

use super::controls::{SEEDS, is_enough};
use super::hardest::{HARDEST, TRIALS};
use crate::run::markdown::markdown_table;
use snakes_core::save::{HardStairs, PoetStudy};

/// Number of the hardest stairs that POET must solve but no direct search may.
const ONLY_POET: usize = 3;
/// Wall-clock time that the run may take on two cores, in minutes.
const MINUTES: f64 = 60.0;

/// Verdict on hard stairs: which search solves them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SolvedBy {
    OnlyPoet,
    Direct,
    NotMeasured,
}

fn verdict(study: &PoetStudy, hard: &HardStairs) -> SolvedBy {
    let runs: Vec<_> = study.controls.iter().filter(|run| run.node == hard.node).collect();
    if runs.iter().any(|run| is_enough(run)) {
        SolvedBy::Direct
    } else if runs.len() as u64 >= SEEDS {
        SolvedBy::OnlyPoet
    } else {
        SolvedBy::NotMeasured
    }
}

/// Returns the results as Markdown: the hardest stairs with the best direct search on each, and each claim with its verdict.
pub fn poet_claims(study: &PoetStudy) -> String {
    let head = ["stairs", "shape", "all agents", "POET", "trials", "direct", "solved by"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(study.hardest.iter().map(|hard| row(study, hard)));
    let head = ["claim", "must", "measured", "met"].map(str::to_owned).to_vec();
    let claims = [head, only_poet(study), rising(study), fast(study)];
    format!(
        "seed {}: {} rounds, {} evaluations, {} stairs, {} solved, {} of them new challenges\n\n{}\nall agents: mean share of the agents of all stairs; POET: successes of its agent in {TRIALS} \
         perturbed trials; trials: of these stairs and their ancestors; direct: best share of the searches from scratch and their number\n\n{}",
        study.seed,
        study.rounds,
        study.evaluations,
        study.stairs,
        study.solved,
        study.challenges.last().unwrap_or(&0),
        markdown_table(rows, 2),
        markdown_table(claims, 4)
    )
}

fn row(study: &PoetStudy, hard: &HardStairs) -> Vec<String> {
    let runs = study.controls.iter().filter(|run| run.node == hard.node);
    let best = runs.clone().filter_map(|run| run.share).reduce(f32::max);
    let words = match verdict(study, hard) {
        SolvedBy::OnlyPoet => "POET alone",
        SolvedBy::Direct => "direct search too",
        SolvedBy::NotMeasured => "not measured",
    };
    vec![
        (hard.node + 1).to_string(),
        hard.stairs.to_string(),
        format!("{:.2}", hard.mean_share),
        format!("{} of {TRIALS}", hard.successes),
        hard.trials.to_string(),
        best.map_or("–".to_owned(), |best| format!("{best:.2} of {}", runs.count())),
        words.to_owned(),
    ]
}

fn claim(claim: &str, must: String, measured: Option<(String, bool)>) -> Vec<String> {
    let (measured, verdict) = match measured {
        None => ("–".to_owned(), "not measured"),
        Some((measured, met)) => (measured, if met { "yes" } else { "no" }),
    };
    vec![claim.to_owned(), must, measured, verdict.to_owned()]
}

fn only_poet(study: &PoetStudy) -> Vec<String> {
    let count =
        |of: SolvedBy| study.hardest.iter().filter(|hard| verdict(study, hard) == of).count();
    let (only, open) = (count(SolvedBy::OnlyPoet), count(SolvedBy::NotMeasured));
    // A verdict is shown once no missing search can change it.
    let is_certain = only >= ONLY_POET || only + open < ONLY_POET || open == 0;
    let measured = (study.rounds > 0 && is_certain).then(|| {
        let unknown = if open > 0 { format!(", {open} not measured") } else { String::new() };
        (format!("{only} of {}{unknown}", study.hardest.len()), only >= ONLY_POET)
    });
    claim(
        "hardest solved stairs that no direct search climbs by more than half",
        format!("{ONLY_POET} of {HARDEST}"),
        measured,
    )
}

fn rising(study: &PoetStudy) -> Vec<String> {
    let rounds = study.challenges.len();
    let measured = study.challenges.last().map(|&last| {
        let before = study.challenges[(rounds * 3 / 4).saturating_sub(1)];
        (format!("{before} after three quarters, {last} at the end"), last > before)
    });
    claim("new challenges solved (ANNECS)", "rising in the last quarter".to_owned(), measured)
}

fn fast(study: &PoetStudy) -> Vec<String> {
    let minutes = study.elapsed_s / 60.0;
    let measured = (study.rounds > 0).then(|| (format!("{minutes:.0} minutes"), minutes < MINUTES));
    claim("time of the run", format!("less than {MINUTES} minutes on two cores"), measured)
}

/// Returns the direct searches as records of a CSV file, the header first.
pub fn poet_records(study: &PoetStudy) -> Vec<Vec<String>> {
    let head = ["stairs", "shape", "seed", "evaluations", "share"];
    let shape = |node: u32| {
        let hard = study.hardest.iter().find(|hard| hard.node == node);
        hard.map_or(String::new(), |hard| hard.stairs.to_string())
    };
    let record = |run: &snakes_core::save::ControlRun| {
        vec![
            (run.node + 1).to_string(),
            shape(run.node),
            run.seed.to_string(),
            run.evaluations.to_string(),
            run.share.map_or(String::new(), |share| share.to_string()),
        ]
    };
    let head = head.map(str::to_owned).to_vec();
    [head].into_iter().chain(study.controls.iter().map(record)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::genome::StairsGenome;
    use snakes_core::save::ControlRun;

    fn study() -> PoetStudy {
        let hard = |node| HardStairs {
            node,
            stairs: StairsGenome::default(),
            mean_share: 0.3,
            successes: 9,
            trials: 1000,
        };
        let mut study = PoetStudy::new("plan".to_owned(), 1);
        study.rounds = 8;
        study.elapsed_s = 1800.0;
        study.challenges = vec![0, 0, 1, 1, 2, 3, 3, 4];
        study.hardest = [7, 5, 4, 3, 2].map(hard).to_vec();
        study
    }

    fn control(node: u32, seed: u64, share: f32) -> ControlRun {
        ControlRun { node, seed, evaluations: 1000, share: Some(share) }
    }

    #[test]
    fn a_verdict_is_given_once_it_is_certain() {
        let mut study = study();
        let verdicts = |study: &PoetStudy| {
            let text = poet_claims(study);
            let count = |word: &str| text.matches(word).count();
            (count("| yes"), count("| no "), count("not measured"))
        };
        assert_eq!(verdicts(&study), (2, 0, 6));
        // If direct searches climb three of the five hardest stairs, at most two are left for POET alone.
        study.controls = [7, 5, 4].map(|node| control(node, 2, 0.6)).to_vec();
        assert_eq!(verdicts(&study), (2, 1, 3));
        study.controls = [7, 5, 4]
            .into_iter()
            .flat_map(|node| (2..12).map(move |seed| control(node, seed, 0.54)))
            .collect();
        assert_eq!(verdicts(&study), (3, 0, 3));
        study.challenges[7] = 3;
        study.elapsed_s = 3600.0;
        assert_eq!(verdicts(&study), (1, 2, 3));
        assert_eq!(poet_records(&study).len(), 31);
    }
}
