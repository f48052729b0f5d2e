//! The results of a study as tables for readers.

use super::compare::{ArmComparison, comparisons};
use super::definition::Arm;
use super::results::{Results, quartiles_text};
use super::values::{Form, ValueInfo, number, signed, values};
use crate::run::markdown::markdown_table;
use crate::statistics::Quartiles;
use snakes_core::score::Fitness;

/// Prefix of the names of lists with a number for each generation.
const OF_GENERATIONS: &str = "generation_";

/// Returns all tables of a study as Markdown: the arms, the generations, the comparisons, and the demands with their verdicts.
pub fn tables(results: &Results<'_>) -> String {
    let study = results.study;
    let mut text = format!("{}\n\n", study.title);
    text += &markdown_table(overview(results), 1);
    text += &format!(
        "\nmedian [quartiles] over {} seeds from {}; –: none, or never\n",
        study.seeds, study.first_seed
    );
    for arm in study.selected_arms() {
        let rows = generations(results, arm);
        if rows.len() > 1 {
            text += &format!("\n{}\n\n{}", arm.title(), markdown_table(rows, 0));
        }
    }
    let compared = comparisons(results);
    if !compared.is_empty() {
        text += &format!("\n{}", markdown_table(comparison_rows(&compared), 3));
        text += "\nhigher: seeds with a higher value than the baseline; p: sign test, and corrected by Holm's method; difference: \
                 median with its 95 % interval;\nA: chance that a run is higher than one of the baseline, with its 95 % interval\n";
    }
    text += &findings(results);
    let demands = demand_rows(results);
    if demands.len() > 1 {
        text += &format!("\n{}", markdown_table(demands, 6));
        text +=
            "\nmeasured: median [quartiles], or a count with the 95 % interval of its percentage\n";
    }
    text
}

fn overview(results: &Results<'_>) -> Vec<Vec<String>> {
    let shown = results.shown();
    let head = ["arm".to_owned(), "runs".to_owned()];
    let head = head.into_iter().chain(shown.iter().map(|info| info.label())).collect();
    let row = |arm: &Arm| {
        let cells = shown.iter().map(|info| cell(results, arm, info));
        let runs = results.of(arm).len().to_string();
        [arm.title().to_owned(), runs].into_iter().chain(cells).collect()
    };
    [head].into_iter().chain(results.study.selected_arms().map(row)).collect()
}

fn cell(results: &Results<'_>, arm: &Arm, info: &ValueInfo) -> String {
    if info.form == Form::Text {
        return match results.texts(arm, &info.name).len() {
            0 => "–".to_owned(),
            different => different.to_string(),
        };
    }
    let numbers = results.values(arm, info);
    let (count, sum) = (numbers.len(), numbers.iter().sum::<f64>());
    let came = numbers.iter().filter(|number| number.is_finite()).count();
    match Quartiles::of(numbers) {
        None => "–".to_owned(),
        Some(_) if info.form == Form::Flag => number(sum, 0),
        Some(quartiles) => {
            // The unit is left out of the cell, because the head of the column has it.
            let words = quartiles_text(&quartiles, count, &ValueInfo { unit: "", ..info.clone() });
            if info.form == Form::Until { format!("{words}: {came} of {count}") } else { words }
        }
    }
}

/// Statistics of a number of one generation over the runs of an arm.
struct Spread {
    mean: f64,
    /// Standard deviation between the runs (divided by n - 1); 0 for a single run.
    std: f64,
    least: f64,
    greatest: f64,
}

impl Spread {
    fn of(numbers: &[f64]) -> Option<Self> {
        let count = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / count;
        let squares = numbers.iter().map(|number| (number - mean) * (number - mean)).sum::<f64>();
        let least = numbers.iter().copied().reduce(f64::min)?;
        let greatest = numbers.iter().copied().reduce(f64::max)?;
        Some(Self { mean, std: (squares / (count - 1.0).max(1.0)).sqrt(), least, greatest })
    }
}

/// Makes the table of an arm's generations: the published numbers, and mean and spread over the runs, for each shown list.
fn generations(results: &Results<'_>, arm: &Arm) -> Vec<Vec<String>> {
    let study = results.study;
    let shown = study.shown();
    let is_shown =
        |info: &&ValueInfo| info.name.starts_with(OF_GENERATIONS) && shown.contains(&info.name);
    let of_generations: Vec<&ValueInfo> = values().iter().filter(is_shown).collect();
    if of_generations.is_empty() {
        return Vec::new();
    }
    let runs = results.of(arm);
    let trial = study.plan(arm, study.first_seed).ok().map(|plan| plan.settings.trial);
    // The words of the report describe only this kind of fitness.
    let trial = trial.filter(|trial| trial.fitness == Fitness::Centre);
    let mut columns: Vec<Vec<String>> = Vec::new();
    let mut length = 0;
    for info in of_generations {
        let published = study.references.get(&info.name);
        let of_runs = runs.iter().map(|run| run.numbers(&info.name).len()).max().unwrap_or(0);
        length = length.max(of_runs);
        let at = |index: usize| -> Vec<f64> {
            runs.iter().filter_map(|run| *run.numbers(&info.name).get(index)?).collect()
        };
        let spreads: Vec<Option<Spread>> =
            (0..of_runs).map(|index| Spread::of(&at(index))).collect();
        let mut column = |head: &str, of: &dyn Fn(usize, &Spread) -> String| {
            let cells = spreads.iter().enumerate().map(|(index, spread)| {
                spread.as_ref().map_or("–".to_owned(), |spread| of(index, spread))
            });
            columns.push([head.to_owned()].into_iter().chain(cells).collect());
        };
        let digits = info.digits;
        let fixed = |value: f64| format!("{value:.digits$}");
        if let Some(published) = published {
            let at = |index: usize| published.get(index).copied();
            column("published", &|index, _| at(index).map_or("–".to_owned(), fixed));
            if let Some(trial) = &trial {
                column("in words", &|index, _| {
                    at(index).map_or("–".to_owned(), |mean| trial.meaning(mean))
                });
            }
        }
        column(&info.title, &|_, spread| fixed(spread.mean));
        // For a count the mean is enough.
        if digits > 0 {
            column("std.dev.", &|_, spread| fixed(spread.std));
            column("least", &|_, spread| fixed(spread.least));
            column("greatest", &|_, spread| fixed(spread.greatest));
            if let Some(trial) = &trial {
                column("in words", &|_, spread| trial.meaning(spread.mean));
            }
        }
    }
    let row = |index: usize| {
        let first = if index == 0 { "generation".to_owned() } else { index.to_string() };
        let cells =
            columns.iter().map(|column| column.get(index).cloned().unwrap_or("–".to_owned()));
        [first].into_iter().chain(cells).collect()
    };
    if length == 0 { Vec::new() } else { (0..=length).map(row).collect() }
}

fn comparison_rows(compared: &[ArmComparison<'_>]) -> Vec<Vec<String>> {
    let head = ["arm", "baseline", "value", "higher", "p", "p (Holm)", "difference", "A"];
    let p = |p: f64| if p < 0.001 { "< 0.001".to_owned() } else { format!("{p:.3}") };
    let row = |of: &ArmComparison<'_>| {
        let signed = |value: f64| signed(value, of.value.digits.max(1));
        let difference = match of.difference.median {
            None => "–".to_owned(),
            // With fewer than six seeds there is no interval.
            Some((median, None)) => signed(median),
            Some((median, Some([from, to]))) => {
                format!("{} [{} {}]", signed(median), signed(from), signed(to))
            }
        };
        let superiority = of.superiority.map_or("–".to_owned(), |of| {
            format!("{:.2} [{:.2} {:.2}]", of.seen, of.least, of.most)
        });
        vec![
            of.arm.title().to_owned(),
            of.baseline.title().to_owned(),
            of.value.label(),
            format!("{} of {}", of.difference.more, of.difference.pairs),
            p(of.difference.p),
            p(of.corrected_p),
            difference,
            superiority,
        ]
    };
    [head.map(str::to_owned).to_vec()].into_iter().chain(compared.iter().map(row)).collect()
}

/// Makes a row for each demand: arm, demand, must, hard, measured, and whether it is met.
fn demand_rows(results: &Results<'_>) -> Vec<Vec<String>> {
    let head = ["arm", "demand", "must", "hard", "measured", "met"].map(str::to_owned).to_vec();
    let rows = results.study.demands_by_arm().into_iter().map(|(arm, demand)| {
        let verdict = results.verdict(arm, demand);
        let one = |name: &str, meets: Option<bool>| {
            let word = if meets? { "yes" } else { "no" };
            Some(format!("{name} {word}"))
        };
        let both = [one("must:", verdict.meets_must), one("hard:", verdict.meets_hard)];
        let words = both.into_iter().flatten().collect::<Vec<_>>().join(", ");
        let (measured, met) = match verdict.measured {
            None => ("–".to_owned(), "not measured".to_owned()),
            Some(measured) => (measured.text, words),
        };
        vec![
            arm.title().to_owned(),
            demand.words(results.study, arm),
            demand.bound(demand.must),
            demand.bound(demand.hard),
            measured,
            met,
        ]
    });
    [head].into_iter().chain(rows).collect()
}

/// Makes the tables of newborns and of built-in champions; empty if they were not measured.
fn findings(results: &Results<'_>) -> String {
    let findings = results.findings;
    let mut text = String::new();
    let percent = |share: Option<f64>| {
        share.map_or("–".to_owned(), |share| format!("{:.1} %", share * 100.0))
    };
    if !findings.newborns.is_empty() {
        let head =
            ["newborns", "rapier", "lanes", "greatest difference"].map(str::to_owned).to_vec();
        let words = |of: &Quartiles| format!("{:.3} [{:.3} {:.3}]", of.median, of.low, of.high);
        let rows = findings.newborns.iter().map(|of| {
            let [a, b] = of
                .quartiles
                .as_ref()
                .map_or(["–", "–"].map(str::to_owned), |of| of.each_ref().map(words));
            vec![of.measure.to_owned(), a, b, percent(of.greatest_difference())]
        });
        let [healthy, all] = findings.healthy;
        text += &format!(
            "\n{}\nmedian [quartiles] of the {healthy} of {all} newborns that are healthy in both engines\n",
            markdown_table([head].into_iter().chain(rows), 1)
        );
    }
    if !findings.built_in.is_empty() {
        let head = ["built-in champion", "keeps in the other engine"].map(str::to_owned).to_vec();
        let rows = findings
            .built_in
            .iter()
            .map(|(name, kept)| vec![name.clone(), percent(Some(f64::from(*kept)))]);
        text += &format!("\n{}", markdown_table([head].into_iter().chain(rows), 1));
    }
    text
}

/// Returns a table in Markdown with all values that a study may name, as `docs/studies.md` has it.
pub fn values_as_markdown() -> String {
    let head = ["value", "unit", "meaning"].map(str::to_owned).to_vec();
    let row = |info: &ValueInfo| {
        vec![format!("`{}`", info.name), info.unit.to_owned(), info.about.clone()]
    };
    markdown_table([head].into_iter().chain(values().iter().map(row)), 3)
}
