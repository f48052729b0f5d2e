//! `snakes exam`: champions in other conditions than those in which they evolved.

use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use serde_json::json;

use super::args::Args;
use super::error::CliError;
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use super::replay::equals_record;
use crate::run::exam::{exam_trials, examine};
use crate::run::headless::HeadlessError;
use crate::run::markdown::markdown_table;
use crate::run::progress_bar::with_bar;
use crate::run::short;
use crate::save::{LoadedChampion, SaveError, check_examinable, load_champion, store_exam};
use crate::schema::Choices;
use crate::score::{ExamSuite, SuiteResult};

/// Examines champions and prints the results; if `writes`, also into their files.
pub fn exam(
    args: &Args,
    files: &[PathBuf],
    suites: &[String],
    writes: bool,
) -> Result<(), CliError> {
    let suites = chosen(suites, ExamSuite::OPTIONS)?;
    let load = |file: &PathBuf| {
        let loaded = load_champion(file)?;
        if writes {
            check_examinable(file, &loaded)?;
        }
        Ok(loaded)
    };
    let champions = files.iter().map(load).collect::<Result<Vec<_>, SaveError>>()?;
    let evaluator = evaluator(args, "exam", &place_of(files))?;
    let control = cancel_on_interrupt();
    let mut rows = Vec::new();
    let mut examine_one = |file: &PathBuf, loaded: LoadedChampion| -> Result<(), CliError> {
        let matches = equals_record(file, &loaded)?;
        let bar = ProgressBar::new(exam_trials(&loaded.champion, &suites).into());
        let examined = || examine(&loaded.champion, &suites, &*evaluator, &control);
        let results = with_bar(&bar, &control, examined);
        let results = results.map_err(|_| HeadlessError::Cancelled { kept: None });
        let results = trusted(&*evaluator, results)?;
        if writes {
            store_exam(file, &loaded, &results)?;
        }
        if args.json {
            results.iter().try_for_each(|result| print(&json_line(file, result, matches)))?;
        } else {
            rows.push((name(file), results));
        }
        Ok(())
    };
    let mut each = files.iter().zip(champions);
    let result = each.try_for_each(|(file, loaded)| examine_one(file, loaded));
    if result.is_err() {
        // What is finished took minutes.
        if !rows.is_empty() {
            print(&table(&suites, &rows))?;
        }
        return result;
    }
    if args.json {
        return print(&format!("{}\n", json!({"done": true, "files": files.len()})));
    }
    print(&table(&suites, &rows))
}

/// The place of the first file, which stands for all.
pub(super) fn place_of(files: &[PathBuf]) -> PathBuf {
    let first = files.first().cloned().unwrap_or_default();
    std::path::absolute(&first).unwrap_or(first)
}

/// The suites that the user names; the default ones, if none.
pub(super) fn chosen(names: &[String], default: &[ExamSuite]) -> Result<Vec<ExamSuite>, CliError> {
    if names.is_empty() {
        return Ok(default.to_vec());
    }
    let named = names.iter().map(|name| ExamSuite::named("--suite", name));
    let mut suites = named.collect::<Result<Vec<_>, _>>()?;
    suites.sort_unstable();
    suites.dedup();
    Ok(suites)
}

fn name(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn json_line(file: &Path, result: &SuiteResult, matches: bool) -> String {
    let each: serde_json::Map<_, _> =
        result.each.iter().map(|(label, kept)| (label.clone(), short(*kept))).collect();
    let line = json!({
        "file": file.display().to_string(),
        "suite": result.suite.choice().name,
        "trials": result.trials,
        "landed": result.landed,
        "disqualified": result.disqualified,
        "median_steps": short(result.median_steps),
        "kept": short(result.kept),
        "kept_in": each,
        "matches": matches,
    });
    format!("{line}\n")
}

/// A Markdown table with a row for each champion: in each suite the landings of all trials, and of the step rates the
/// share of the way that it keeps in each.
fn table(suites: &[ExamSuite], champions: &[(String, Vec<SuiteResult>)]) -> String {
    let mut head = vec!["champion".to_owned()];
    for suite in suites {
        match (suite, champions.first()) {
            (ExamSuite::StepRate, Some((_, results))) => {
                let of_rates = results.iter().filter(|result| result.suite == *suite);
                head.extend(
                    of_rates.flat_map(|result| &result.each).map(|(label, _)| label.clone()),
                );
            }
            _ => head.push(suite.choice().name.to_owned()),
        }
    }
    let row = |(name, results): &(String, Vec<SuiteResult>)| {
        let mut cells = vec![name.clone()];
        for suite in suites {
            match results.iter().find(|result| result.suite == *suite) {
                // The suite has no conditions for this champion.
                None => cells.push("–".to_owned()),
                Some(result) if result.each.is_empty() => {
                    cells.push(format!("{} of {}", result.landed, result.trials));
                }
                Some(result) => {
                    cells.extend(result.each.iter().map(|(_, kept)| format!("{kept:.2}")));
                }
            }
        }
        cells
    };
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(champions.iter().map(row)).collect();
    markdown_table(&rows, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(suite: ExamSuite, each: &[(&str, f32)]) -> SuiteResult {
        SuiteResult {
            suite,
            trials: 100,
            landed: 97,
            disqualified: 0,
            median_steps: 10.0,
            kept: 0.7,
            each: each.iter().map(|&(label, kept)| (label.to_owned(), kept)).collect(),
        }
    }

    #[test]
    fn the_table_has_a_row_for_each_champion_and_a_column_for_each_step_rate() {
        let suites = [ExamSuite::Trials, ExamSuite::StepRate];
        let results = || {
            let rates = [("60 Hz", 1.0), ("240 Hz", 0.7)];
            vec![result(ExamSuite::Trials, &[]), result(ExamSuite::StepRate, &rates)]
        };
        let text =
            table(&suites, &[("climber".to_owned(), results()), ("b".to_owned(), results())]);
        let expected = "\
| champion |    trials | 60 Hz | 240 Hz |
|:---------|----------:|------:|-------:|
| climber  | 97 of 100 |  1.00 |   0.70 |
| b        | 97 of 100 |  1.00 |   0.70 |
";
        assert_eq!(text, expected);
    }

    #[test]
    fn an_unknown_suite_is_refused_with_the_known_ones() {
        let error = chosen(&["stars".to_owned()], &[]).expect_err("unknown").to_string();
        assert!(error.contains("\"stars\"") && error.contains("step-rate, stairs"), "{error}");
        let twice = ["shove", "trials", "shove"].map(str::to_owned);
        assert_eq!(chosen(&twice, &[]).expect("known"), [ExamSuite::Trials, ExamSuite::Shove]);
    }
}
