//! `snakes exam`: champions in other conditions than those of their evolution.

use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use serde_json::{Value, json};

use super::args::{Args, ExamArgs};
use super::endings::{add_endings, endings_table};
use super::error::CliError;
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print, print_json};
use super::replay::{equals_record, name_of};
use snakes_core::check::Invalid;
use snakes_core::genome::StairsClass;
use snakes_core::save::{LoadedChampion, SaveError, check_examinable, load_champion, store_exam};
use snakes_core::schema::Choices;
use snakes_core::score::{ExamSuite, SuiteResult};
use snakes_core::world::WorldPlan;
use snakes_lab::export::mjcf;
use snakes_lab::run::exam::{exam_trials, examine};
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::run::judge::{CLIMBED_STEPS, Court, JUDGES, Judge, JudgeResult, judge_trials};
use snakes_lab::run::markdown::markdown_table;
use snakes_lab::run::progress_bar::with_bar;
use snakes_lab::run::{Evaluator, RunControl, short};
use snakes_lab::statistics::Share;
use snakes_lab::study::suites_named;

/// Examines champions and prints the results. With --write, also stores them in the champions' files.
pub fn exam(args: &Args, wanted: &ExamArgs) -> Result<(), CliError> {
    let ExamArgs { files, suite, write: writes, .. } = wanted;
    let (suites, judges) = asked(suite)?;
    if let Some(judge) = judges.first().filter(|_| *writes) {
        let allowed = format!("other suites; the results of {} are not stored", judge.name);
        return Err(Invalid::new("--write", "set", allowed).into());
    }
    let load = |file: &PathBuf| {
        let loaded = load_champion(file)?;
        if *writes {
            check_examinable(file, &loaded)?;
        }
        Ok(loaded)
    };
    let champions = files.iter().map(load).collect::<Result<Vec<_>, SaveError>>()?;
    check_suites(suite, &suites, &champions)?;
    // On a server, the name of the first file identifies the command.
    let first = files.first().map_or(Path::new(""), PathBuf::as_path);
    let evaluator = evaluator(args, "exam", first)?;
    let control = cancel_on_interrupt()?;
    let mut courts = judges
        .into_iter()
        .map(Court::start)
        .collect::<Result<Vec<_>, _>>()
        .map_err(HeadlessError::from)?;
    let mut rows = Vec::new();
    let mut examine_one = |file: &PathBuf, loaded: LoadedChampion| -> Result<(), CliError> {
        let matches = equals_record(file, &loaded)?;
        let bar = ProgressBar::new(exam_trials(&loaded.champion, &suites).into());
        let examined = || examine(&loaded.champion, &suites, &*evaluator, &control);
        let results = with_bar(&bar, &control, examined);
        let results = results.map_err(|_| HeadlessError::Cancelled { kept: None });
        let results = trusted(&*evaluator, results)?;
        if *writes {
            store_exam(file, &loaded, &results)?;
        }
        let judge = |court: &mut Court| judged(court, &loaded, &*evaluator, &control);
        let judged = courts.iter_mut().map(judge).collect::<Result<Vec<_>, CliError>>()?;
        if args.json {
            results.iter().try_for_each(|result| print_json(&json_line(file, result, matches)))?;
            for (result, court) in judged.iter().zip(&courts) {
                print_json(&judge_line(file, result, court.version(), matches))?;
            }
        } else {
            rows.push(ExamRow { name: name_of(file), results, judged });
        }
        Ok(())
    };
    let mut each = files.iter().zip(champions);
    let result = each.try_for_each(|(file, loaded)| examine_one(file, loaded));
    if result.is_err() {
        // The finished rows are printed even after an error, because they took minutes.
        if !rows.is_empty() {
            print(&tables(&suites, &rows))?;
        }
        return result;
    }
    if args.json {
        return print_json(&json!({"type": "done", "files": files.len()}));
    }
    print(&tables(&suites, &rows))
}

/// Refuses a named suite that can say nothing of any of the champions.
fn check_suites(
    named: &[String],
    suites: &[ExamSuite],
    champions: &[LoadedChampion],
) -> Result<(), Invalid> {
    let concerns =
        |suite: ExamSuite| champions.iter().any(|loaded| suite.concerns(&loaded.champion.genome));
    let idle = suites.iter().copied().find(|suite| !named.is_empty() && !concerns(*suite));
    let Some(suite) = idle else { return Ok(()) };
    let others = ExamSuite::OPTIONS.iter().copied().filter(|suite| concerns(*suite));
    let names: Vec<&str> = others.map(|suite| suite.choice().name).collect();
    let allowed = format!("{} for these champions", names.join(", "));
    Err(Invalid::new("--suite", suite.choice().name, allowed))
}

/// Returns the suites that the user names, or the usual suites if none is named; and the judges that are named.
fn asked(names: &[String]) -> Result<(Vec<ExamSuite>, Vec<&'static Judge>), Invalid> {
    let own: Vec<String> =
        names.iter().filter(|name| Judge::named(name).is_none()).cloned().collect();
    let default: &[ExamSuite] = if names.is_empty() { &ExamSuite::USUAL } else { &[] };
    let with_judges = |mut invalid: Invalid| {
        JUDGES.iter().for_each(|judge| invalid.allowed += &format!(", {}", judge.name));
        invalid
    };
    let chosen = if own.is_empty() {
        default.to_vec()
    } else {
        suites_named("--suite", &own).map_err(with_judges)?
    };
    let is_named = |judge: &&Judge| names.iter().any(|name| name == judge.name);
    Ok((chosen, JUDGES.iter().filter(is_named).collect()))
}

/// Examines a champion with a judge, with a progress bar.
fn judged(
    court: &mut Court,
    loaded: &LoadedChampion,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<JudgeResult, CliError> {
    let bar = ProgressBar::new(judge_trials().into());
    let model = |plan: &WorldPlan| mjcf("snake", plan, &[]);
    let examined = || court.examine(&loaded.champion, &model, evaluator, control);
    trusted(evaluator, with_bar(&bar, control, examined).map_err(HeadlessError::from))
}

/// A row of the table: the results of a champion.
struct ExamRow {
    name: String,
    results: Vec<SuiteResult>,
    judged: Vec<JudgeResult>,
}

fn json_line(file: &Path, result: &SuiteResult, matches: bool) -> Value {
    let kept_in = match result.suite {
        ExamSuite::HeldOut => &[],
        _ => result.each.as_slice(),
    };
    let each: serde_json::Map<_, _> =
        kept_in.iter().map(|(label, kept)| (label.clone(), short(*kept))).collect();
    let classes: Vec<_> = result.classes().into_iter().map(class_json).collect();
    let mut line = json!({
        "type": "suite",
        "file": file.display().to_string(),
        "suite": result.suite.choice().name,
        "trials": result.trials,
        "landed": result.landed,
        "disqualified": result.disqualified,
        "median_steps": short(result.median_steps),
        "kept": short(result.kept),
        "kept_in": each,
        "classes": classes,
        "matches": matches,
    });
    add_endings(&mut line, &result.endings);
    line
}

/// Returns a class of the held-out stairs as JSON, with the 95 % interval of the share of landings.
fn class_json((class, landed, trials): (&str, u32, u32)) -> Value {
    let Share { seen, least, most } = Share::of(landed, trials);
    json!({
        "class": class, "trials": trials, "landed": landed, "share": seen, "least": least, "most": most,
    })
}

/// Formats a number of landings with the 95 % interval of their share.
fn with_interval(landed: u32, trials: u32) -> String {
    let Share { least, most, .. } = Share::of(landed, trials);
    format!("{landed} of {trials} ({least:.2}–{most:.2})")
}

fn judge_line(file: &Path, result: &JudgeResult, version: &str, matches: bool) -> Value {
    let of = |engine: usize| {
        let mut of = json!({
            "climbed": result.climbed[engine],
            "landed": result.landed[engine],
            "way": short(result.way[engine]),
        });
        add_endings(&mut of, &result.endings[engine]);
        of
    };
    json!({
        "type": "suite",
        "file": file.display().to_string(),
        "suite": result.judge.name,
        "version": version,
        "trials": result.trials,
        "here": of(0),
        "there": of(1),
        "kept": short(result.kept),
        "matches": matches,
    })
}

/// Makes the table of results, and below it the one of how the trials ended.
fn tables(suites: &[ExamSuite], champions: &[ExamRow]) -> String {
    let mut rows = Vec::new();
    for ExamRow { name, results, judged } in champions {
        let mut add = |of: &'static str, endings| rows.push((name.clone(), of, endings));
        results.iter().for_each(|result| add(result.suite.choice().name, &result.endings));
        for (number, JudgeResult { judge, endings: [here, there], .. }) in judged.iter().enumerate()
        {
            // All judges compare with equal trials in this program, which therefore have one row.
            if number == 0 {
                add("here", here);
            }
            add(judge.title, there);
        }
    }
    format!("{}\n{}", table(suites, champions), endings_table(&rows))
}

/// Makes a Markdown table with a row for each champion. A suite shows the landings of all trials; the step rates show the share of
/// the way that is kept at each rate; the other engine shows both. The held-out stairs have 95 % intervals, and columns for their
/// classes if there is no other suite.
fn table(suites: &[ExamSuite], champions: &[ExamRow]) -> String {
    let mut head = vec!["champion".to_owned()];
    let shows_classes = suites == [ExamSuite::HeldOut];
    for suite in suites {
        match (suite, champions.first()) {
            (ExamSuite::StepRate, Some(first)) => {
                let of_rates = first.results.iter().filter(|result| result.suite == *suite);
                head.extend(
                    of_rates.flat_map(|result| &result.each).map(|(label, _)| label.clone()),
                );
            }
            (ExamSuite::Engine, _) => {
                head.extend(["landed in the other engine", "kept there"].map(str::to_owned));
            }
            _ => head.push(suite.choice().name.to_owned()),
        }
    }
    if shows_classes {
        head.extend(StairsClass::names().into_iter().map(str::to_owned));
    }
    // All judges compare with equal trials in this program, which therefore have one pair of columns.
    let judges = champions.first().map_or(&[][..], |row| &row.judged).iter().map(|of| of.judge);
    for (number, title) in judges.map(|judge| judge.title).enumerate() {
        let steps = format!("{CLIMBED_STEPS} steps");
        if number == 0 {
            head.extend([format!("{steps} here"), "way here".to_owned()]);
        }
        head.push(format!("{steps} in {title}"));
        head.extend(["way", "kept"].map(|what| format!("{what} in {title}")));
    }
    let row = |ExamRow { name, results, judged }: &ExamRow| {
        let mut cells = vec![name.clone()];
        for suite in suites {
            match results.iter().find(|result| result.suite == *suite) {
                // The suite has no conditions for this champion.
                None => {
                    cells.push("–".to_owned());
                    if *suite == ExamSuite::Engine {
                        cells.push("–".to_owned());
                    }
                }
                Some(result) if *suite == ExamSuite::HeldOut => {
                    cells.push(with_interval(result.landed, result.trials));
                    let classes = result.classes().into_iter().filter(|_| shows_classes);
                    cells.extend(classes.map(|(_, landed, of)| with_interval(landed, of)));
                }
                Some(result) if *suite == ExamSuite::Engine => {
                    cells.push(format!("{} of {}", result.landed, result.trials));
                    cells.push(format!("{:.2}", result.kept));
                }
                Some(result) if result.each.is_empty() => {
                    cells.push(format!("{} of {}", result.landed, result.trials));
                }
                Some(result) => {
                    cells.extend(result.each.iter().map(|(_, kept)| format!("{kept:.2}")));
                }
            }
        }
        for (number, JudgeResult { trials, climbed, way, kept, .. }) in judged.iter().enumerate() {
            let [here, there] = climbed.map(|climbed| format!("{climbed} of {trials}"));
            if number == 0 {
                cells.extend([here, format!("{:.2}", way[0])]);
            }
            cells.extend([there, format!("{:.2}", way[1]), format!("{kept:.2}")]);
        }
        cells
    };
    markdown_table([head].into_iter().chain(champions.iter().map(row)), 1)
}

#[cfg(test)]
mod tests;
