//! The results of a study as records of tables and as lines of JSON.

use serde_json::{Map, Value, json};

use super::compare::{ArmComparison, comparisons};
use super::definition::{Arm, Demand};
use super::driver::StudyFiles;
use super::results::Results;
use super::values::{Form, ValueInfo, values};
use crate::statistics::Quartiles;
use snakes_core::save::{StudiedRun, StudyValue};

/// Returns the values that at least one run has, in their usual order.
fn known_values(results: &Results<'_>) -> Vec<&'static ValueInfo> {
    let runs: Vec<&StudiedRun> =
        results.study.selected_arms().flat_map(|arm| results.of(arm)).collect();
    let is_known = |info: &&ValueInfo| runs.iter().any(|run| run.values.contains_key(&info.name));
    values().iter().filter(is_known).collect()
}

/// Returns the records of the file of runs, the header first and then one for each run.
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

/// Returns the results as lines of JSON. Each has a `type`: `run`, `arm`, `comparison`, `demand`, or for the last line `done`.
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

/// Returns the results of arms, comparisons and demands. Each has its `type` and the name of the study.
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

/// Returns the fields of a JSON object.
fn fields(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(fields) => fields,
        _ => Map::new(),
    }
}

/// Converts a number to JSON. An infinite number becomes null, because JSON has none.
fn finite(value: Option<f64>) -> Value {
    json!(value.filter(|value| value.is_finite()))
}

/// Returns, for each arm and shown value, the number of runs that have the value, and its quartiles.
fn arm_results(results: &Results<'_>) -> Vec<Map<String, Value>> {
    let mut all = Vec::new();
    for arm in results.study.selected_arms() {
        for info in results.shown().into_iter().filter(|info| info.form != Form::Text) {
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

/// Returns the records of the file of results, the header first: one for each value of an arm, each comparison and each demand.
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
