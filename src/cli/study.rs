//! `snakes study`: the runs, exams and results of a built-in study or of a user's own study.

use std::path::Path;

use super::args::{Args, StudyArgs, number_if};
use super::error::{CliError, of_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print, print_json, print_line, print_names};
use super::poet_study;
use snakes_core::check::Invalid;
use snakes_core::save::SaveError;
use snakes_core::schema::Choices;
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::study::{
    EVALUATIONS, Plain, Results, SEEDS, Study, StudyFiles, built_in_studies, json_lines, perform,
    suites_named, tables, values_as_markdown,
};

/// Makes the runs and exams that are missing in the study's files, and prints the results. Without a name, lists the studies.
pub fn study(args: &Args, wanted: &StudyArgs) -> Result<(), CliError> {
    if wanted.markdown {
        return print(&values_as_markdown());
    }
    let Some(named) = &wanted.study else { return list(args) };
    if named == "poet" {
        return poet_study::poet_study(args, wanted);
    }
    if wanted.rounds.is_some() {
        let problem = "--rounds has no effect with this study; only poet has rounds";
        return Err(CliError::Usage(problem.to_owned()));
    }
    let study = asked(Study::load(named)?, args, wanted)?;
    let folder = args.results_folder();
    folder.prepare()?;
    let files = StudyFiles::within(folder.path(), &study);
    let evaluator = evaluator(args, &format!("study-{}", study.name), &files.ron)?;
    let control = cancel_on_interrupt()?;
    let performed = perform(&study, &files, args.run.restart, &*evaluator, &control);
    let performed = performed.map_err(|error| match error {
        HeadlessError::Save(SaveError::Study(invalid)) => {
            let of_flag = of_its_flag(args, wanted, invalid.clone());
            let is_from_file = of_flag == invalid && Path::new(named).exists();
            if is_from_file {
                SaveError::invalid(Path::new(named))(invalid).into()
            } else {
                of_flag.into()
            }
        }
        HeadlessError::Save(error) => CliError::from(error),
        other => other.into(),
    });
    let (runs, findings) = trusted(&*evaluator, performed)?;
    let results = Results { study: &study, runs: &runs, findings: &findings };
    if args.json {
        return json_lines(&results, &files).iter().try_for_each(print_json);
    }
    print(&format!("{}\n", tables(&results)))?;
    let saved = |file: &Path| print_line(&format!("saved to  {}", file.display()));
    files.all().into_iter().try_for_each(saved)
}

/// Returns an error about a setting of an arm with the name of the flag that gave the value, if there is one.
fn of_its_flag(args: &Args, wanted: &StudyArgs, invalid: Invalid) -> Invalid {
    let field = invalid.field.split(" of ").next().unwrap_or_default().to_owned();
    if field == "evaluations" && wanted.evaluations.is_some() {
        return of_flag("--evaluations")(invalid);
    }
    let of_setting = args.of_its_flag(Invalid { field, ..invalid.clone() });
    if of_setting.field.starts_with("--") { of_setting } else { invalid }
}

/// Lists the built-in studies.
fn list(args: &Args) -> Result<(), CliError> {
    let poet = ("poet".to_owned(), poet_study::ABOUT.to_owned());
    let studies = built_in_studies()?.into_iter().map(|study| (study.name, study.about));
    print_names("study", &studies.chain([poet]).collect::<Vec<_>>(), args.json)
}

/// Returns the study with the changes that the flags make.
fn asked(mut study: Study, args: &Args, wanted: &StudyArgs) -> Result<Study, CliError> {
    if let Some(preset) = &args.run.settings.preset {
        if study.methods.is_none() && study.arms.iter().all(|arm| arm.preset.is_some()) {
            let problem =
                "--preset has no effect with this study, whose arms have presets of their own";
            return Err(CliError::Usage(problem.to_owned()));
        }
        study.preset.clone_from(preset);
    }
    study.first_seed = args.seed_or(study.first_seed)?;
    study.seeds = number_if("--seeds", &wanted.seeds, SEEDS)?.unwrap_or(study.seeds);
    let evaluations = number_if("--evaluations", &wanted.evaluations, EVALUATIONS)?;
    study.evaluations = evaluations.or(study.evaluations);
    study.stairs = args.run.settings.stairs.clone().or(study.stairs);
    let changes = args.changes()?;
    if study.evaluations.is_some() && changes.iter().any(|(name, _)| name.ends_with("generations"))
    {
        let problem = "--generations has no effect with this study; --evaluations sets the budget";
        return Err(CliError::Usage(problem.to_owned()));
    }
    let plain = |(name, value): (&str, String)| (name.to_owned(), Plain::Text(value));
    study.settings.extend(changes.into_iter().map(plain));
    if !(wanted.strategies.is_empty() && wanted.controllers.is_empty()) {
        let Some(methods) = &mut study.methods else {
            let flag = if wanted.strategies.is_empty() { "--controllers" } else { "--strategies" };
            let problem = format!(
                "{flag} has no effect with this study, which does not cross methods; try methods"
            );
            return Err(CliError::Usage(problem));
        };
        if !wanted.strategies.is_empty() {
            methods.strategies = kinds("--strategies", &wanted.strategies)?;
        }
        if !wanted.controllers.is_empty() {
            methods.controllers = kinds("--controllers", &wanted.controllers)?;
        }
    }
    study.set_methods().map_err(|invalid| match invalid.field.as_str() {
        "controllers" => of_flag("--controllers")(invalid),
        _ => invalid,
    })?;
    if !(wanted.strategies.is_empty() && wanted.controllers.is_empty()) {
        study.forget_lacking_baseline();
    }
    study.baseline = wanted.baseline.clone().or(study.baseline);
    for name in &wanted.arms {
        study.named("--arms", name)?;
    }
    study.selected.clone_from(&wanted.arms);
    if !wanted.suite.is_empty() {
        study.set_suites(suites_named("--suite", &wanted.suite)?);
    }
    study.check().map_err(|invalid| match invalid.field.as_str() {
        "baseline" => of_flag("--baseline")(invalid),
        "first_seed" => of_flag("--seed")(invalid),
        "seeds" if wanted.seeds.is_some() => of_flag("--seeds")(invalid),
        _ => invalid,
    })?;
    Ok(study)
}

/// Returns the kinds that a flag names, each once, in the order of the flag. Empty for `all`.
fn kinds<K: Choices + PartialEq>(flag: &str, names: &[String]) -> Result<Vec<K>, Invalid> {
    let mut found: Vec<K> = Vec::new();
    for name in names.iter().filter(|name| *name != "all") {
        let kind = K::named(flag, name.trim())
            .map_err(|error| Invalid { allowed: format!("all, {}", error.allowed), ..error })?;
        if !found.contains(&kind) {
            found.push(kind);
        }
    }
    Ok(found)
}
