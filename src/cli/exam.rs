//! `snakes exam`: champions in other conditions than those of their evolution.

use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use serde_json::{Value, json};

use super::args::{Args, ExamArgs};
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
use snakes_lab::run::markdown::markdown_table;
use snakes_lab::run::mujoco::{
    CLIMBED_STEPS, MUJOCO, Mujoco, MujocoError, MujocoResult, mujoco_trials,
};
use snakes_lab::run::progress_bar::with_bar;
use snakes_lab::run::{Evaluator, RunControl, short};
use snakes_lab::statistics::Share;
use snakes_lab::study::suites_named;

/// Examines champions and prints the results. With --write, also stores them in the champions' files.
pub fn exam(args: &Args, wanted: &ExamArgs) -> Result<(), CliError> {
    let ExamArgs { files, suite, write: writes, .. } = wanted;
    let (suites, asks_mujoco) = asked(suite)?;
    if asks_mujoco && *writes {
        let allowed = format!("other suites; the results of {MUJOCO} are not stored");
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
    let mut mujoco = if asks_mujoco { Some(Mujoco::start()?) } else { None };
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
        let in_mujoco = match &mut mujoco {
            Some(mujoco) => Some(in_mujoco(mujoco, &loaded, &*evaluator, &control)?),
            None => None,
        };
        if args.json {
            results.iter().try_for_each(|result| print_json(&json_line(file, result, matches)))?;
            if let Some((result, mujoco)) = in_mujoco.as_ref().zip(mujoco.as_ref()) {
                print_json(&mujoco_line(file, result, mujoco.version(), matches))?;
            }
        } else {
            rows.push(ExamRow { name: name_of(file), results, in_mujoco });
        }
        Ok(())
    };
    let mut each = files.iter().zip(champions);
    let result = each.try_for_each(|(file, loaded)| examine_one(file, loaded));
    if result.is_err() {
        // The finished rows are printed even after an error, because they took minutes.
        if !rows.is_empty() {
            print(&table(&suites, &rows))?;
        }
        return result;
    }
    if args.json {
        return print_json(&json!({"type": "done", "files": files.len()}));
    }
    print(&table(&suites, &rows))
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

/// Returns the suites that the user names, or the usual suites if none is named; and whether MuJoCo is named.
fn asked(names: &[String]) -> Result<(Vec<ExamSuite>, bool), Invalid> {
    let own: Vec<String> = names.iter().filter(|name| *name != MUJOCO).cloned().collect();
    let default: &[ExamSuite] = if names.is_empty() { &ExamSuite::USUAL } else { &[] };
    let with_mujoco = |mut invalid: Invalid| {
        invalid.allowed += &format!(", {MUJOCO}");
        invalid
    };
    let chosen = if own.is_empty() {
        default.to_vec()
    } else {
        suites_named("--suite", &own).map_err(with_mujoco)?
    };
    Ok((chosen, own.len() < names.len()))
}

/// Examines a champion in MuJoCo, with a progress bar.
fn in_mujoco(
    mujoco: &mut Mujoco,
    loaded: &LoadedChampion,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<MujocoResult, CliError> {
    let bar = ProgressBar::new(mujoco_trials().into());
    let model = |plan: &WorldPlan| mjcf("snake", plan, &[]);
    let examined = || mujoco.examine(&loaded.champion, &model, evaluator, control);
    match with_bar(&bar, control, examined) {
        Err(MujocoError::Cancelled) => Err(HeadlessError::Cancelled { kept: None }.into()),
        other => trusted(evaluator, other),
    }
}

/// A row of the table: the results of a champion.
struct ExamRow {
    name: String,
    results: Vec<SuiteResult>,
    in_mujoco: Option<MujocoResult>,
}

fn json_line(file: &Path, result: &SuiteResult, matches: bool) -> Value {
    let kept_in = match result.suite {
        ExamSuite::HeldOut => &[],
        _ => result.each.as_slice(),
    };
    let each: serde_json::Map<_, _> =
        kept_in.iter().map(|(label, kept)| (label.clone(), short(*kept))).collect();
    let classes: Vec<_> = result.classes().into_iter().map(class_json).collect();
    json!({
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
    })
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

fn mujoco_line(file: &Path, result: &MujocoResult, version: &str, matches: bool) -> Value {
    let of = |engine: usize| {
        json!({
            "climbed": result.climbed[engine],
            "landed": result.landed[engine],
            "way": short(result.way[engine]),
        })
    };
    json!({
        "type": "suite",
        "file": file.display().to_string(),
        "suite": MUJOCO,
        "version": version,
        "trials": result.trials,
        "here": of(0),
        "there": of(1),
        "kept": short(result.kept),
        "matches": matches,
    })
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
    if champions.iter().any(|row| row.in_mujoco.is_some()) {
        let steps = format!("{CLIMBED_STEPS} steps");
        head.push(format!("{steps} here"));
        head.push(format!("{steps} in MuJoCo"));
        head.extend(["way here", "way in MuJoCo", "kept in MuJoCo"].map(str::to_owned));
    }
    let row = |ExamRow { name, results, in_mujoco }: &ExamRow| {
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
        if let Some(MujocoResult { trials, climbed, way, kept, .. }) = in_mujoco {
            cells.extend(climbed.map(|climbed| format!("{climbed} of {trials}")));
            cells.extend([way[0], way[1], *kept].map(|share| format!("{share:.2}")));
        }
        cells
    };
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(champions.iter().map(row)).collect();
    markdown_table(&rows, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::shipped_champion;

    #[test]
    fn r10_a_named_suite_that_says_nothing_of_the_champions_is_refused() {
        let champions = [shipped_champion().expect("well formed")];
        let checked = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            let (suites, _) = asked(&names).expect("suites");
            check_suites(&names, &suites, &champions).map_err(|error| error.to_string())
        };
        assert_eq!(checked(&[]), Ok(()), "usual suites that say nothing are left out");
        assert_eq!(checked(&["stairs", "step-rate"]), Ok(()));
        let message = checked(&["stairs", "lesion"]).expect_err("a gait has no senses");
        let expected = "--suite is lesion; allowed: trials, step-rate, stairs, surprise, shove, held-out, engine for \
                        these champions";
        assert_eq!(message, expected);
    }

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
        let text = table(&suites, &["climber", "b"].map(|name| row(name, results(), None)));
        let expected = "\
| champion |    trials | 60 Hz | 240 Hz |
|:---------|----------:|------:|-------:|
| climber  | 97 of 100 |  1.00 |   0.70 |
| b        | 97 of 100 |  1.00 |   0.70 |
";
        assert_eq!(text, expected);
    }

    fn row(name: &str, results: Vec<SuiteResult>, in_mujoco: Option<MujocoResult>) -> ExamRow {
        ExamRow { name: name.to_owned(), results, in_mujoco }
    }

    #[test]
    fn held_out_stairs_have_an_interval_and_alone_a_column_for_each_class() {
        let classes = [("equal", 0.6), ("irregular", 1.0), ("house", 0.0), ("nosing", 0.2)];
        let result =
            || SuiteResult { trials: 60, landed: 27, ..result(ExamSuite::HeldOut, &classes) };
        let row = || row("climber", vec![result()], None);
        let alone = table(&[ExamSuite::HeldOut], &[row()]);
        let last = alone.lines().last().expect("a row");
        for cell in ["27 of 60 (0.33–0.58)", "9 of 15 (0.36–0.80)", "0 of 15 (0.00–0.20)"] {
            assert!(last.contains(cell), "{cell} in {last}");
        }
        let among = table(&[ExamSuite::Trials, ExamSuite::HeldOut], &[row()]);
        assert!(among.contains("27 of 60 (0.33–0.58)") && !among.contains("of 15"), "{among}");
    }

    #[test]
    fn mujoco_adds_columns_for_both_engines() {
        let result = MujocoResult {
            trials: 20,
            climbed: [20, 7],
            landed: [19, 0],
            way: [1.0, 0.45],
            kept: 0.5,
        };
        let text = table(&[], &[row("climber", Vec::new(), Some(result))]);
        let expected = "\
| champion | 3 steps here | 3 steps in MuJoCo | way here | way in MuJoCo | kept in MuJoCo |
|:---------|-------------:|------------------:|---------:|--------------:|---------------:|
| climber  |     20 of 20 |           7 of 20 |     1.00 |          0.45 |           0.50 |
";
        assert_eq!(text, expected);
    }

    #[test]
    fn mujoco_is_examined_only_if_it_is_named() {
        let names =
            |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        assert_eq!(asked(&[]), Ok((ExamSuite::USUAL.to_vec(), false)));
        assert_eq!(asked(&names(&["mujoco"])), Ok((Vec::new(), true)));
        assert_eq!(asked(&names(&["mujoco", "shove"])), Ok((vec![ExamSuite::Shove], true)));
        let error = asked(&names(&["stars"])).expect_err("unknown").to_string();
        assert!(error.ends_with(", mujoco"), "{error}");
    }

    #[test]
    fn an_unknown_suite_is_refused_with_the_known_ones() {
        let error =
            suites_named("--suite", &["stars".to_owned()]).expect_err("unknown").to_string();
        assert!(error.contains("\"stars\"") && error.contains("step-rate, stairs"), "{error}");
        let twice = ["shove", "trials", "shove"].map(str::to_owned);
        assert_eq!(
            suites_named("--suite", &twice).expect("known"),
            [ExamSuite::Trials, ExamSuite::Shove]
        );
    }
}
