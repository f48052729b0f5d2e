//! The results of families as tables: Markdown for people, records for files.

use super::family::Family;
use super::measure::{Measure, number};
use super::results::{FamilyResults, Results};
use crate::run::markdown::markdown_table;
use snakes_core::schema::Choices;
use snakes_core::score::{ExamSuite, SuiteResult};

/// A row of the table of demands: family, demand, must, hard, measured, and whether it is met.
fn demand_rows(results: &Results, families: &[Family]) -> Vec<[String; 6]> {
    let mut rows = Vec::new();
    for family in named(results, families) {
        for demand in family.family.info().demands {
            let verdict = demand.verdict(family, results);
            let bound = |bound: Option<f64>| match bound {
                Some(bound) => demand.measure.bound(bound),
                None => "–".to_owned(),
            };
            rows.push([
                family.family.name().to_owned(),
                demand.measure.name(),
                bound(demand.must),
                bound(demand.hard),
                verdict
                    .measured
                    .as_ref()
                    .map_or("–".to_owned(), |measured| measured.text.clone()),
                verdict.words(),
            ]);
        }
    }
    rows
}

/// The results of the named families.
fn named<'a>(
    results: &'a Results,
    families: &'a [Family],
) -> impl Iterator<Item = &'a FamilyResults> {
    results.0.iter().filter(|results| families.contains(&results.family))
}

/// Both tables of the named families as Markdown: the results of each, and the demands. The other results are only
/// compared with.
pub fn tables(results: &Results, families: &[Family], suites: &[ExamSuite]) -> String {
    let mut head = ["family", "runs", "land", "first landing", "steps"].map(str::to_owned).to_vec();
    head.extend(suites.iter().map(|suite| suite.choice().name.to_owned()));
    let of_family = |family: &FamilyResults| {
        let cell = |measure: Measure| {
            measure.of(family, results).map_or("–".to_owned(), |measured| measured.text)
        };
        // The number of values stands in the second column.
        let short = |text: String| text.split(", n =").next().unwrap_or_default().to_owned();
        let landed = family.champions().filter(|champion| champion.has_landed).count();
        let mut cells = vec![family.family.name().to_owned(), family.runs.len().to_string()];
        cells.push(landed.to_string());
        cells.push(short(cell(Measure::FirstLanding)));
        cells.push(short(cell(Measure::Steps)));
        cells.extend(suites.iter().map(|suite| match suite {
            ExamSuite::StepRate => kept(family),
            _ => short(cell(Measure::Exam(*suite))),
        }));
        cells
    };
    let overview: Vec<Vec<String>> =
        [head].into_iter().chain(named(results, families).map(of_family)).collect();
    let demands = demand_rows(results, families);
    let mut text = markdown_table(&overview, 1);
    text += "\nmedian [quartiles] over the seeds; land: champions that end on the landing in their own trial; exam: \
             landings of 100 trials,\nat other step rates the least share of the way; on standard stairs that of the best \
             champion; –: none, or never\n";
    if !demands.is_empty() {
        let head = ["family", "demand", "must", "hard", "measured", "met"].map(str::to_owned);
        let rows: Vec<Vec<String>> = [head].into_iter().chain(demands).map(Vec::from).collect();
        text += &format!("\n{}", markdown_table(&rows, 6));
        text +=
            "\nmeasured: median [quartiles], or a count with the 95 % interval of its percentage\n";
    }
    text
}

/// Share of its way that the champion keeps at other step rates: the median of the examined ones.
fn kept(family: &FamilyResults) -> String {
    let results = family.examined.iter().flat_map(|champion| &champion.suites);
    let kept = results.filter(|result| result.suite == ExamSuite::StepRate);
    let quartiles = crate::run::Quartiles::of(kept.map(|result| f64::from(result.kept)));
    quartiles.map_or("–".to_owned(), |quartiles| format!("{:.2}", quartiles.median))
}

/// The records of the exam's CSV file, the header first: one for each champion and suite.
pub fn exam_records(results: &Results) -> Vec<Vec<String>> {
    let head = [
        "family",
        "seed",
        "suite",
        "trials",
        "landed",
        "disqualified",
        "median_steps",
        "kept",
        "kept_in",
    ];
    let mut records = vec![head.map(str::to_owned).to_vec()];
    for family in &results.0 {
        for champion in &family.examined {
            for SuiteResult { suite, trials, landed, disqualified, median_steps, kept, each } in
                &champion.suites
            {
                let each = each.iter().map(|(label, kept)| format!("{label}: {kept}"));
                records.push(vec![
                    family.family.name().to_owned(),
                    champion.seed.to_string(),
                    suite.choice().name.to_owned(),
                    trials.to_string(),
                    landed.to_string(),
                    disqualified.to_string(),
                    number(f64::from(*median_steps)),
                    kept.to_string(),
                    each.collect::<Vec<_>>().join("; "),
                ]);
            }
        }
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::families::fixtures::{family, landings, results};

    #[test]
    fn the_tables_show_what_was_measured_beside_the_demands() {
        let stairs = ExamSuite::Stairs;
        let rules = landings(Family::Rules, stairs, &[40]);
        let gait = landings(Family::Gait, stairs, &[45]);
        let zcs = family(Family::Zcs, &[2, 2, 3]);
        let text = tables(
            &results(&[&gait, &zcs, &rules]),
            &[Family::Zcs, Family::Rules],
            &[ExamSuite::StepRate, stairs],
        );
        for line in [
            "| family | runs | land | first landing |   steps | step-rate | stairs |",
            "| zcs    |    3 |    0 |       – [– –] | 2 [2 2.5] |         – |      – |",
            "| rules  |    1 |    1 |           100 |      10 |         – |     80 |",
            "| zcs    | steps climbed                             | ≥ 2       | ≥ 4   | 2 [2 2.5], n = 3       | must: yes, hard: no |",
            "| rules  | other stairs, landings more than the gait | –         | ≥ +10 | -10: 80, gait 90       | hard: no            |",
        ] {
            let cells = |line: &str| -> Vec<String> {
                line.split('|').map(|cell| cell.trim().to_owned()).collect()
            };
            assert!(text.lines().any(|written| cells(written) == cells(line)), "{line}\n{text}");
        }
        assert!(!text.contains("| gait"), "{text}");
    }

    #[test]
    fn the_records_have_a_line_for_each_champion_and_suite() {
        let gait = landings(Family::MixedGait, ExamSuite::Shove, &[45, 9]);
        let records = exam_records(&results(&[&gait]));
        assert_eq!(records.len(), 3);
        assert_eq!(records[2], ["mixed-gait", "2", "shove", "50", "9", "0", "4.5", "0.5", ""]);
    }
}
