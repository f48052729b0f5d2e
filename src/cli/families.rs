//! `snakes families`: every family of controllers over several seeds, the exam of its champions, and the demands.

use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use serde_json::json;

use super::args::{Args, FamiliesArgs};
use super::compare::{kinds, seeds_from};
use super::error::{CliError, of_size_flag};
use super::evaluators::{evaluator, trusted};
use super::exam::chosen;
use super::output::{cancel_on_interrupt, print};
use snakes_core::check::{Invalid, within};
use snakes_core::save::{
    FamilyRun, FamilyRuns, MAX_FAMILY_RUNS, SaveError, SavesFolder, load_champion, load_families,
    load_preset, store_champion, store_csv, store_exam, store_families, store_picture,
};
use snakes_core::schema::Choices;
use snakes_core::score::ExamSuite;
use snakes_lab::plot;
use snakes_lab::run::exam::{exam_trials, examine};
use snakes_lab::run::families::{
    DEFAULT_SUITES, ExaminedChampion, Family, FamilyResults, FinishedRun, PlannedFamilyRun,
    Results, exam_records, missing, seeds_to_examine, tables, train,
};
use snakes_lab::run::headless::{HeadlessError, say};
use snakes_lab::run::progress_bar::{bar_of, with_bar};
use snakes_lab::run::{Evaluator, RunControl, with_short_numbers};

/// Seed of the first run unless one is given: no setting was chosen by it or by those after it.
const FIRST_SEED: u64 = 201;

/// The files of the results.
struct ResultFiles {
    ron: PathBuf,
    csv: PathBuf,
    png: PathBuf,
    champions: PathBuf,
}

impl ResultFiles {
    /// Those in a folder, which is created.
    fn prepare(folder: &SavesFolder) -> Result<Self, SaveError> {
        let named = |name: &str| folder.path().join(name);
        let champions = named("families");
        SavesFolder::find(Some(&champions)).prepare()?;
        let (ron, csv, png) =
            (named("families.ron"), named("families-exam.csv"), named("families.png"));
        Ok(Self { ron, csv, png, champions })
    }

    /// The file of a run's champion.
    fn champion(&self, family: Family, seed: u64) -> PathBuf {
        self.champions.join(format!("{}-seed{seed}.ron", family.name()))
    }
}

/// Makes the runs and examinations that the result's files do not have yet, and prints the results.
pub fn families(args: &Args, wanted: &FamiliesArgs) -> Result<(), CliError> {
    let families: Vec<Family> = kinds("--families", &wanted.families)?;
    let suites = chosen(&wanted.suite, &DEFAULT_SUITES)?;
    let planned = plans(args, wanted, &families)?;
    within("runs", planned.len(), 1..=MAX_FAMILY_RUNS)?;
    let files = ResultFiles::prepare(&args.results_folder())?;
    let evaluator = evaluator(args, "families", &files.ron)?;
    let mut finished = earlier_runs(&files.ron, &planned, &families, args.restart)?;
    let has_file = |family, seed| files.champion(family, seed).exists();
    let left = missing(&planned, &finished, has_file);
    say(&format!("{} of {} runs left", left.len(), planned.len()));
    let control = cancel_on_interrupt();
    let simulations = left.iter().map(PlannedFamilyRun::simulations).sum();
    let bar = bar_of(simulations, "simulations");
    // An estimate soon after the start, and one that goes on while long generations run.
    bar.enable_steady_tick(std::time::Duration::from_secs(1));
    let result = train(
        &left,
        &*evaluator,
        &control,
        |spent| bar.inc(spent),
        |done: FinishedRun| {
            // The champion first: a run without its file is made again.
            if let Some(champion) = &done.champion {
                store_champion(&files.champion(done.family, done.run.seed), champion, None)?;
            }
            bar.suspend(|| say(&row(done.family, &done.run)));
            finished.add(&done.protocol, done.run);
            Ok(store_families(&files.ron, &finished)?)
        },
    );
    bar.finish_and_clear();
    let cancelled = |error: HeadlessError| error.keeping(&files.ron);
    trusted(&*evaluator, result.map_err(cancelled))?;
    // The gaits that the named families are compared with, if they have been trained before.
    let mut gaits: Vec<Family> = families.iter().map(|family| family.gait()).collect();
    gaits.retain(|gait| !families.contains(gait));
    let gaits = plans(args, wanted, &gaits)?;
    let mut results = results_of(&finished, &[planned, gaits].concat());
    for family in &mut results.0 {
        let found = examined(family, &suites, &files, &*evaluator, &control).map_err(cancelled);
        family.examined = trusted(&*evaluator, found)?;
    }
    store_csv(&files.csv, &exam_records(&results))?;
    store_picture(&files.png, &plot::families(&results, &suites)?)?;
    show(args, &results, &families, &suites, &files)
}

/// The runs of all families, seed by seed, so that an interrupted comparison has about as many of each.
fn plans(
    args: &Args,
    wanted: &FamiliesArgs,
    families: &[Family],
) -> Result<Vec<PlannedFamilyRun>, CliError> {
    let seeds = seeds_from(args.seed_or(FIRST_SEED)?, wanted.seeds)?;
    let duration_s = args.duration_s()?;
    let mut presets = Vec::new();
    for family in families {
        presets.push((*family, load_preset(family.info().preset)?.settings));
    }
    let mut planned = Vec::new();
    for seed in seeds {
        for (family, preset) in &presets {
            let plan = family.plan(preset, seed, wanted.evaluations, duration_s);
            let plan = plan.map_err(of_size_flag)?;
            planned.push(PlannedFamilyRun { family: *family, plan });
        }
    }
    Ok(planned)
}

/// The runs that are finished. A restart forgets those of the named families; runs of these with other settings are
/// refused.
fn earlier_runs(
    ron: &Path,
    planned: &[PlannedFamilyRun],
    families: &[Family],
    restarts: bool,
) -> Result<FamilyRuns, SaveError> {
    if !ron.exists() {
        return Ok(FamilyRuns::new());
    }
    let loaded = load_families(ron);
    if restarts {
        // Where all families begin again, nothing in the file can be lost.
        let mut finished = match loaded {
            Err(_) if families.len() == Family::OPTIONS.len() => FamilyRuns::new(),
            other => other?,
        };
        let is_named = |name: &str| families.iter().any(|family| family.name() == name);
        finished.families.retain(|trained| !is_named(&trained.protocol.family));
        return Ok(finished);
    }
    let finished = loaded?;
    for planned in planned {
        let now = planned.protocol();
        let earlier = finished.family(&now.family).map(|trained| &trained.protocol);
        if let Some(earlier) = earlier.filter(|earlier| **earlier != now) {
            let allowed = format!(
                "{}, the fingerprint of its present settings and budget; --restart begins its runs again, and --out \
                 names another folder",
                now.settings
            );
            let field = format!("settings of {}", now.family);
            let source = Invalid::new(field, &earlier.settings, allowed);
            return Err(SaveError::Invalid { path: ron.to_owned(), source });
        }
    }
    Ok(finished)
}

/// The finished runs among the planned ones, in the order of the list of families.
fn results_of(finished: &FamilyRuns, planned: &[PlannedFamilyRun]) -> Results {
    let mut results: Vec<FamilyResults> = Vec::new();
    for planned in planned {
        let family = planned.family;
        let place = results.iter().position(|results| results.family == family);
        let place = place.unwrap_or_else(|| {
            results.push(FamilyResults { family, runs: Vec::new(), examined: Vec::new() });
            results.len() - 1
        });
        results[place].runs.extend(planned.result(finished).cloned());
    }
    results.sort_by_key(|results| results.family);
    Results(results)
}

/// Examines the champions of a family. Results that are in a champion's file are taken from there, and new ones written
/// into it.
fn examined(
    family: &FamilyResults,
    suites: &[ExamSuite],
    files: &ResultFiles,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<ExaminedChampion>, HeadlessError> {
    let mut champions = Vec::new();
    for seed in seeds_to_examine(family.family, &family.runs) {
        let path = files.champion(family.family, seed);
        let mut loaded = load_champion(&path)?;
        let is_known = |suite: &ExamSuite| loaded.exam.iter().any(|known| known.suite == *suite);
        let left: Vec<ExamSuite> =
            suites.iter().copied().filter(|suite| !is_known(suite)).collect();
        let trials = exam_trials(&loaded.champion, &left);
        if trials > 0 {
            let bar: ProgressBar = bar_of(trials.into(), "trials");
            say(&format!("exam of {}, seed {seed}", family.family.name()));
            let found =
                with_bar(&bar, control, || examine(&loaded.champion, &left, evaluator, control));
            let found = found.map_err(|_| HeadlessError::Cancelled { kept: None })?;
            store_exam(&path, &loaded, &found)?;
            loaded.exam.extend(found);
            loaded.exam.sort_by_key(|result| result.suite);
        }
        loaded.exam.retain(|result| suites.contains(&result.suite));
        champions.push(ExaminedChampion { seed, suites: loaded.exam });
    }
    Ok(champions)
}

/// A finished run in a line.
fn row(family: Family, run: &FamilyRun) -> String {
    let result = match &run.champion {
        None => "all snakes were disqualified".to_owned(),
        Some(champion) => {
            let landed = if champion.has_landed { ", landed" } else { "" };
            format!("fitness {:.2}, {} steps{landed}", champion.fitness, champion.steps_climbed)
        }
    };
    let first =
        run.first_landing.map_or(String::new(), |number| format!(", first landing {number}"));
    let (name, seed, evaluations) = (family.name(), run.seed, run.evaluations);
    format!("{name:<13}  seed {seed}  {evaluations} evaluations: {result}{first}")
}

fn show(
    args: &Args,
    results: &Results,
    families: &[Family],
    suites: &[ExamSuite],
    files: &ResultFiles,
) -> Result<(), CliError> {
    if !args.json {
        let [ron, csv, png, champions] = [&files.ron, &files.csv, &files.png, &files.champions]
            .map(|file| file.display().to_string());
        return print(&format!(
            "{}\nsaved to   {ron}\n           {csv}\n           {png}\nchampions  {champions}\n",
            tables(results, families, suites)
        ));
    }
    let mut runs = 0;
    for family in results.0.iter().filter(|of| families.contains(&of.family)) {
        for run in &family.runs {
            runs += 1;
            let champion = run.champion.as_ref().map(|_| files.champion(family.family, run.seed));
            let line = json!({"family": family.family.name(), "run": run, "file": champion});
            print(&format!("{}\n", with_short_numbers(&line)))?;
        }
        for demand in family.family.info().demands {
            let verdict = demand.verdict(family, results);
            // An infinite value is no JSON.
            let value = verdict.measured.as_ref().map(|measured| measured.value);
            let line = json!({
                "family": family.family.name(),
                "demand": demand.measure.name(),
                "must": demand.must,
                "hard": demand.hard,
                "value": value.filter(|value| value.is_finite()),
                "measured": verdict.measured.map(|measured| measured.text),
                "meets_must": verdict.meets_must,
                "meets_hard": verdict.meets_hard,
            });
            print(&format!("{line}\n"))?;
        }
    }
    let files = [&files.ron, &files.csv, &files.png];
    print(&format!("{}\n", json!({"done": true, "runs": runs, "files": files})))
}
