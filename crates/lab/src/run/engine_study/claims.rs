//! The results of the study against what is claimed of the second engine.

use super::newborns::NewbornStatistics;
use crate::run::markdown::markdown_table;
use crate::run::report::Quartiles;
use crate::run::sign_test::median_difference;
use crate::run::study::StudyArm;
use snakes_core::save::{EngineStudyRun, StudyRuns};
use snakes_core::schema::Choices;
use snakes_core::world::PhysicsEngine;

/// How much a quartile may differ between the engines.
const MOST_DIFFERENCE: f64 = 0.1;
/// Share of its way that a champion must keep in the other engine, and the share of champions that must.
const KEPT: f32 = 0.8;
const MUST_KEEP: [usize; 2] = [4, 7];

/// Measurements beside those of the runs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EngineFindings {
    /// Motions of newborns.
    pub newborns: Vec<NewbornStatistics>,
    /// Number of newborns that are healthy in both engines, and of all.
    pub healthy: [usize; 2],
    /// The share of its way that each shipped champion keeps in the other engine, by its name.
    pub shipped: Vec<(String, f32)>,
}

/// The results as Markdown: tables of newborns, champions and runs, and the claims with their verdicts.
pub fn engine_claims(runs: &StudyRuns<EngineStudyRun>, findings: &EngineFindings) -> String {
    let head = ["claim", "must", "measured", "met"].map(str::to_owned).to_vec();
    let rows = [head, of_newborns(findings)]
        .into_iter()
        .chain(of_champions(runs, findings))
        .chain([of_landings(runs), of_means(runs)]);
    format!(
        "{}\nmedian [quartiles] of the {} of {} newborns that are healthy in both engines\n\n{}\nshare of its way that each shipped \
         champion keeps in the other engine: median over 20 starts\n\n{}\nmedian [quartiles] over the seeds\n\n{}",
        markdown_table(&newborn_table(findings), 1),
        findings.healthy[0],
        findings.healthy[1],
        markdown_table(&shipped_table(findings), 1),
        markdown_table(&run_table(runs), 1),
        markdown_table(&rows.collect::<Vec<_>>(), 4),
    )
}

fn newborn_table(findings: &EngineFindings) -> Vec<Vec<String>> {
    let head = ["newborns", "rapier", "lanes", "greatest difference"].map(str::to_owned).to_vec();
    let words = |of: &Quartiles| format!("{:.3} [{:.3} {:.3}]", of.median, of.low, of.high);
    let rows = findings.newborns.iter().map(|of| {
        let [a, b] = match &of.quartiles {
            Some([a, b]) => [words(a), words(b)],
            None => ["–".to_owned(), "–".to_owned()],
        };
        vec![of.measure.to_owned(), a, b, percent(of.greatest_difference())]
    });
    [head].into_iter().chain(rows).collect()
}

fn percent(share: Option<f64>) -> String {
    share.map_or("–".to_owned(), |share| format!("{:.1} %", share * 100.0))
}

fn shipped_table(findings: &EngineFindings) -> Vec<Vec<String>> {
    let head = ["champion", "keeps"].map(str::to_owned).to_vec();
    let rows = findings
        .shipped
        .iter()
        .map(|(name, kept)| vec![name.clone(), percent(Some(f64::from(*kept)))]);
    [head].into_iter().chain(rows).collect()
}

fn run_table(runs: &StudyRuns<EngineStudyRun>) -> Vec<Vec<String>> {
    let head = ["learned in", "runs", "landed", "first landing", "last mean", "kept in rapier"]
        .map(str::to_owned)
        .to_vec();
    let rows = PhysicsEngine::OPTIONS.iter().map(|arm| {
        let of_arm = runs.of_arm(arm.name());
        let landed = of_arm.iter().filter(|run| run.first_on_landing.is_some()).count();
        vec![
            arm.name().to_owned(),
            of_arm.len().to_string(),
            landed.to_string(),
            Quartiles::words(first_landings(&of_arm), 0),
            Quartiles::words(of_arm.iter().filter_map(|run| run.last_mean), 3),
            Quartiles::words(of_arm.iter().filter_map(|run| run.kept.map(f64::from)), 2),
        ]
    });
    [head].into_iter().chain(rows).collect()
}

fn first_landings<'a>(runs: &'a [&EngineStudyRun]) -> impl Iterator<Item = f64> + 'a {
    // A run that never lands has spent its budget.
    runs.iter().map(|run| f64::from(run.first_on_landing.unwrap_or(run.evaluations)))
}

fn verdict(is_met: Option<bool>) -> String {
    match is_met {
        None => "not measured",
        Some(true) => "yes",
        Some(false) => "no",
    }
    .to_owned()
}

fn of_newborns(findings: &EngineFindings) -> Vec<String> {
    let differences: Option<Vec<f64>> =
        findings.newborns.iter().map(NewbornStatistics::greatest_difference).collect();
    let greatest =
        differences.filter(|all| !all.is_empty()).map(|all| all.into_iter().fold(0.0, f64::max));
    vec![
        "quartiles of newborns agree".to_owned(),
        format!("within {}", percent(Some(MOST_DIFFERENCE))),
        percent(greatest),
        verdict(greatest.map(|difference| difference <= MOST_DIFFERENCE)),
    ]
}

fn of_champions(runs: &StudyRuns<EngineStudyRun>, findings: &EngineFindings) -> [Vec<String>; 2] {
    let row = |claim: &str, kept: Vec<f32>| {
        let (most, all) = (kept.iter().filter(|kept| **kept >= KEPT).count(), kept.len());
        let [must, of] = MUST_KEEP;
        vec![
            claim.to_owned(),
            format!("{must} of {of}"),
            format!("{most} of {all}"),
            verdict((all > 0).then_some(most * of >= must * all)),
        ]
    };
    let of_lanes = runs.of_arm(PhysicsEngine::Lanes.name());
    let shipped = findings.shipped.iter().map(|(_, kept)| *kept).collect();
    [
        row("shipped champions that keep 80 % of their way in the other engine", shipped),
        row(
            "champions of lanes that keep 80 % of their way in rapier",
            // A run without a healthy champion keeps nothing.
            of_lanes.iter().map(|run| run.kept.unwrap_or(0.0)).collect(),
        ),
    ]
}

/// A claim that both engines give the same: the 95 % intervals of the medians overlap.
fn overlap(claim: &str, values: [Vec<f64>; 2], digits: usize) -> Vec<String> {
    let intervals = values.map(|values| {
        let (median, interval) = median_difference(values)?;
        Some((median, interval?))
    });
    let (measured, is_met) = match intervals {
        [Some((a, of_a)), Some((b, of_b))] => {
            let words = |median: f64, [low, high]: [f64; 2]| {
                format!("{median:.digits$} [{low:.digits$}, {high:.digits$}]")
            };
            let overlap = of_a[0] <= of_b[1] && of_b[0] <= of_a[1];
            (format!("rapier {}, lanes {}", words(a, of_a), words(b, of_b)), Some(overlap))
        }
        _ => ("–".to_owned(), None),
    };
    vec![claim.to_owned(), "intervals overlap".to_owned(), measured, verdict(is_met)]
}

fn of_arms(
    runs: &StudyRuns<EngineStudyRun>,
    values: impl Fn(&[&EngineStudyRun]) -> Vec<f64>,
) -> [Vec<f64>; 2] {
    [PhysicsEngine::Rapier, PhysicsEngine::Lanes].map(|arm| values(&runs.of_arm(arm.name())))
}

fn of_landings(runs: &StudyRuns<EngineStudyRun>) -> Vec<String> {
    let values = of_arms(runs, |runs| first_landings(runs).collect());
    overlap("evaluations to the first landing", values, 0)
}

fn of_means(runs: &StudyRuns<EngineStudyRun>) -> Vec<String> {
    let values = of_arms(runs, |runs| runs.iter().filter_map(|run| run.last_mean).collect());
    overlap("mean fitness of the last generation", values, 3)
}

/// The runs as records for a CSV file, the names of the columns first.
pub fn engine_records(runs: &StudyRuns<EngineStudyRun>) -> Vec<Vec<String>> {
    let head = [
        "engine",
        "seed",
        "evaluations",
        "first_on_landing",
        "last_mean",
        "fitness",
        "kept",
        "run_hash",
    ];
    let mut records = vec![head.map(str::to_owned).to_vec()];
    for arm in PhysicsEngine::OPTIONS {
        for run in runs.of_arm(arm.name()) {
            let optional = |value: Option<String>| value.unwrap_or_default();
            records.push(vec![
                arm.name().to_owned(),
                run.seed.to_string(),
                run.evaluations.to_string(),
                optional(run.first_on_landing.map(|number| number.to_string())),
                optional(run.last_mean.map(|mean| mean.to_string())),
                optional(run.fitness.map(|fitness| fitness.to_string())),
                optional(run.kept.map(|kept| kept.to_string())),
                run.run_hash.clone(),
            ]);
        }
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(seed: u64, landing: u32) -> EngineStudyRun {
        EngineStudyRun {
            seed,
            evaluations: 6000,
            first_on_landing: Some(landing),
            last_mean: Some(0.5 + seed as f64 / 100.0),
            fitness: Some(0.9),
            kept: Some(if seed > 6 { 0.5 } else { 0.9 }),
            run_hash: "0".repeat(16),
        }
    }

    #[test]
    fn the_claims_compare_quartiles_champions_landings_and_times() {
        let mut runs = StudyRuns::new(String::new(), 6000);
        let mut findings = EngineFindings::default();
        assert!(engine_claims(&runs, &findings).contains("not measured"));
        for seed in 1..=8 {
            runs.add("rapier", run(seed, 1000 + seed as u32 * 100));
            runs.add("lanes", run(seed, 1100 + seed as u32 * 100));
        }
        let quartiles = |scale: f64| Quartiles { low: scale, median: 2.0, high: 3.0 };
        findings.newborns = vec![NewbornStatistics {
            measure: "m",
            quartiles: Some([quartiles(1.0), quartiles(1.05)]),
        }];
        findings.shipped = vec![("one".to_owned(), 0.95), ("two".to_owned(), 0.3)];
        let text = engine_claims(&runs, &findings);
        assert!(text.contains("| 4.8 %"), "{text}");
        assert!(text.contains("| 1 of 2 ") && text.contains("| 6 of 8 "), "{text}");
        assert_eq!(text.matches("| yes").count(), 4, "{text}");
        assert_eq!(text.matches("| no ").count(), 1, "{text}");
        let records = engine_records(&runs);
        assert_eq!(records.len(), 17);
        assert!(records.iter().all(|record| record.len() == records[0].len()));
    }
}
