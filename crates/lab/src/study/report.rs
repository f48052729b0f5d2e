//! The results of a study: tables for people, records for files, lines of JSON for scripts.

use serde_json::{Map, Value, json};

use super::compare::{ArmComparison, comparisons};
use super::definition::{Arm, Demand};
use super::driver::StudyFiles;
use super::measure::{Results, quartiles_text};
use super::values::{Form, ValueInfo, number, signed, values};
use crate::run::markdown::markdown_table;
use crate::statistics::Quartiles;
use snakes_core::save::{StudiedRun, StudyValue};
use snakes_core::score::Fitness;

/// The start of the names of lists with a number for each generation.
const OF_GENERATIONS: &str = "generation_";

/// All tables of a study as Markdown: the arms, the generations, the comparisons, and the demands with their verdicts.
pub fn tables(results: &Results<'_>) -> String {
    let study = results.study;
    let mut text = format!("{}\n\n", study.title);
    text += &markdown_table(&overview(results), 1);
    text += &format!(
        "\nmedian [quartiles] over {} seeds from {}; –: none, or never\n",
        study.seeds, study.first_seed
    );
    for arm in study.selected_arms() {
        let rows = generations(results, arm);
        if rows.len() > 1 {
            text += &format!("\n{}\n\n{}", arm.title(), markdown_table(&rows, 0));
        }
    }
    let compared = comparisons(results);
    if !compared.is_empty() {
        text += &format!("\n{}", markdown_table(&comparison_rows(&compared), 3));
        text += "\nhigher: seeds with a higher value than the baseline; p: sign test, and corrected by Holm's method; difference: \
                 median with its 95 % interval;\nA: chance that a run is higher than one of the baseline, with its 95 % interval\n";
    }
    text += &findings(results);
    let demands = demand_rows(results);
    if demands.len() > 1 {
        text += &format!("\n{}", markdown_table(&demands, 6));
        text +=
            "\nmeasured: median [quartiles], or a count with the 95 % interval of its percentage\n";
    }
    text
}

/// The values that are shown, without lists.
fn shown(results: &Results<'_>) -> Vec<&'static ValueInfo> {
    let shown = results.study.shown();
    let is_shown = |info: &&ValueInfo| shown.contains(&info.name) && info.form != Form::List;
    values().iter().filter(is_shown).collect()
}

fn overview(results: &Results<'_>) -> Vec<Vec<String>> {
    let shown = shown(results);
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
            // The unit stands in the head of the column.
            let words = quartiles_text(&quartiles, count, &ValueInfo { unit: "", ..info.clone() });
            if info.form == Form::Until { format!("{words}: {came} of {count}") } else { words }
        }
    }
}

/// Means of a generation over the runs of an arm.
struct Spread {
    mean: f64,
    /// Standard deviation between the runs (divided by n - 1); 0 for one run.
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

/// The table of an arm's generations: the published numbers, and mean and spread over the runs of the lists that are shown.
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
    // The words of the report are about this fitness.
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
        // Of a count the mean is enough.
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
            // Fewer than six seeds have no interval.
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

/// A row for each demand: arm, demand, must, hard, measured, and whether it is met.
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

/// The tables of newborns and of built-in champions.
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
        let rows: Vec<Vec<String>> = [head].into_iter().chain(rows).collect();
        let [healthy, all] = findings.healthy;
        text += &format!(
            "\n{}\nmedian [quartiles] of the {healthy} of {all} newborns that are healthy in both engines\n",
            markdown_table(&rows, 1)
        );
    }
    if !findings.built_in.is_empty() {
        let head = ["built-in champion", "keeps in the other engine"].map(str::to_owned).to_vec();
        let rows = findings
            .built_in
            .iter()
            .map(|(name, kept)| vec![name.clone(), percent(Some(f64::from(*kept)))]);
        let rows: Vec<Vec<String>> = [head].into_iter().chain(rows).collect();
        text += &format!("\n{}", markdown_table(&rows, 1));
    }
    text
}

/// The values that any of the runs has, in their usual order.
fn known_values(results: &Results<'_>) -> Vec<&'static ValueInfo> {
    let runs: Vec<&StudiedRun> =
        results.study.selected_arms().flat_map(|arm| results.of(arm)).collect();
    let is_known = |info: &&ValueInfo| runs.iter().any(|run| run.values.contains_key(&info.name));
    values().iter().filter(is_known).collect()
}

/// The records of the file of runs, the header first: one per run.
pub(super) fn run_records(results: &Results<'_>) -> Vec<Vec<String>> {
    let columns = known_values(results);
    let names = columns.iter().map(|info| info.name.as_str());
    let head = ["study", "arm", "seed"].into_iter().chain(names).chain(["run_hash"]);
    let mut records = vec![head.map(str::to_owned).collect()];
    for arm in results.study.selected_arms() {
        for run in results.of(arm) {
            let cells = columns
                .iter()
                .map(|info| run.values.get(&info.name).map_or(String::new(), text_of));
            let first = [results.study.name.clone(), arm.name.clone(), run.seed.to_string()];
            records.push(first.into_iter().chain(cells).chain([run.run_hash.clone()]).collect());
        }
    }
    records
}

fn text_of(value: &StudyValue) -> String {
    match value {
        StudyValue::Number(number) => number.to_string(),
        StudyValue::Text(text) => text.clone(),
        StudyValue::Numbers(numbers) => {
            let texts = numbers
                .iter()
                .map(|number| number.map_or(String::new(), |number| number.to_string()));
            texts.collect::<Vec<_>>().join(" ")
        }
    }
}

/// The lines of JSON, each with its `type`: `run`, `arm`, `comparison`, `demand`, and at last `done`.
pub fn json_lines(results: &Results<'_>, files: &StudyFiles) -> Vec<Value> {
    let study = results.study;
    let mut lines = Vec::new();
    let mut runs = 0;
    for arm in study.selected_arms() {
        for run in results.of(arm) {
            runs += 1;
            let mut line =
                json!({"type": "run", "study": study.name, "arm": arm.name, "seed": run.seed});
            if let Some(fields) = line.as_object_mut() {
                fields.extend(run.values.iter().map(|(name, value)| (name.clone(), json!(value))));
                fields.insert("run_hash".to_owned(), json!(run.run_hash));
                let champion = files.champion(arm, run.seed);
                fields.insert("champion".to_owned(), json!(champion.exists().then_some(champion)));
            }
            lines.push(line);
        }
    }
    lines.extend(typed_results(results).into_iter().map(Value::Object));
    lines.push(json!({"type": "done", "study": study.name, "runs": runs, "files": files.all()}));
    lines
}

/// The results of arms, comparisons and demands, each with its `type` and the study.
fn typed_results(results: &Results<'_>) -> Vec<Map<String, Value>> {
    let kinds = [
        ("arm", arm_results(results)),
        ("comparison", comparison_results(results)),
        ("demand", demand_results(results)),
    ];
    let typed = |(kind, records): (&'static str, Vec<Map<String, Value>>)| {
        records.into_iter().map(move |mut record| {
            record.insert("type".to_owned(), json!(kind));
            record.insert("study".to_owned(), json!(results.study.name));
            record
        })
    };
    kinds.into_iter().flat_map(typed).collect()
}

/// The fields of an object.
fn fields(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(fields) => fields,
        _ => Map::new(),
    }
}

/// An infinite number is no JSON.
fn finite(value: Option<f64>) -> Value {
    json!(value.filter(|value| value.is_finite()))
}

/// For each arm and shown value, the number of runs that have it, and its quartiles.
fn arm_results(results: &Results<'_>) -> Vec<Map<String, Value>> {
    let mut all = Vec::new();
    for arm in results.study.selected_arms() {
        for info in shown(results).into_iter().filter(|info| info.form != Form::Text) {
            let numbers = results.values(arm, info);
            let count = numbers.len();
            let quartiles = Quartiles::of(numbers);
            all.push(fields(json!({
                "arm": arm.name,
                "value": info.name,
                "runs": count,
                "low_quartile": finite(quartiles.map(|of| of.low)),
                "median": finite(quartiles.map(|of| of.median)),
                "high_quartile": finite(quartiles.map(|of| of.high)),
            })));
        }
    }
    all
}

fn comparison_results(results: &Results<'_>) -> Vec<Map<String, Value>> {
    let one = |of: ArmComparison<'_>| {
        let interval = of.difference.median.and_then(|(_, interval)| interval);
        fields(json!({
            "arm": of.arm.name,
            "baseline": of.baseline.name,
            "value": of.value.name,
            "pairs": of.difference.pairs,
            "higher": of.difference.more,
            "lower": of.difference.fewer,
            "p": of.difference.p,
            "p_holm": of.corrected_p,
            "difference": finite(of.difference.median.map(|(median, _)| median)),
            "difference_least": finite(interval.map(|[least, _]| least)),
            "difference_most": finite(interval.map(|[_, most]| most)),
            "superiority": of.superiority.map(|of| of.seen),
            "superiority_least": of.superiority.map(|of| of.least),
            "superiority_most": of.superiority.map(|of| of.most),
        }))
    };
    comparisons(results).into_iter().map(one).collect()
}

fn demand_results(results: &Results<'_>) -> Vec<Map<String, Value>> {
    let one = |(arm, demand): (&Arm, &Demand)| {
        let verdict = results.verdict(arm, demand);
        fields(json!({
            "arm": arm.name,
            "demand": demand.words(results.study, arm),
            "must": demand.must,
            "hard": demand.hard,
            "measure": finite(verdict.measured.as_ref().map(|measured| measured.value)),
            "measured": verdict.measured.map(|measured| measured.text),
            "meets_must": verdict.meets_must,
            "meets_hard": verdict.meets_hard,
        }))
    };
    results.study.demands_by_arm().into_iter().map(one).collect()
}

/// The records of the file of results, the header first: a line for each value of an arm, each comparison and each demand.
pub(super) fn result_records(results: &Results<'_>) -> Vec<Vec<String>> {
    let records = typed_results(results);
    let mut columns: Vec<&str> = ["study", "type", "arm"].to_vec();
    for name in records.iter().flat_map(Map::keys) {
        if !columns.contains(&name.as_str()) {
            columns.push(name);
        }
    }
    let cell = |value: &Value| match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let of_record = |record: &Map<String, Value>| {
        columns.iter().map(|name| record.get(*name).map_or(String::new(), cell)).collect()
    };
    let head = columns.iter().map(|name| (*name).to_owned()).collect();
    [head].into_iter().chain(records.iter().map(of_record)).collect()
}

/// A page with all values that a study may name: `docs/studies.md` has it as a table.
pub fn values_as_markdown() -> String {
    let head = ["value", "unit", "meaning"].map(str::to_owned).to_vec();
    let row = |info: &ValueInfo| {
        vec![format!("`{}`", info.name), info.unit.to_owned(), info.about.clone()]
    };
    let rows: Vec<Vec<String>> = [head].into_iter().chain(values().iter().map(row)).collect();
    markdown_table(&rows, 3)
}
