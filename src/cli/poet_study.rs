//! `snakes study poet`: whether POET solves stairs that a direct search does not solve.

use std::path::Path;

use serde_json::json;

use super::args::{Args, StudyArgs, number_if};
use super::error::CliError;
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print, print_json, print_line};
use snakes_core::check::Invalid;
use snakes_core::evolve::RunPlan;
use snakes_core::save::{
    ControlRun, ExistingRun, PoetStudy, SaveError, load_poet_study, load_preset,
    settings_fingerprint, store_csv, store_poet_study,
};
use snakes_core::world::PhysicsEngine;
use snakes_lab::run::headless::{HeadlessError, say};
use snakes_lab::run::progress_bar::{bar_of, beneath_bar};
use snakes_lab::run::{Cancelled, Evaluator, RecordedRun, RunControl, RunSource};
use snakes_lab::study::poet::{
    hardest_stairs, planned_controls, poet_claims, poet_records, run_controls,
};

/// Default seed of the run. No setting was chosen with this seed or with the seeds of the direct searches, which follow it.
const FIRST_SEED: u64 = 401;
/// Default number of rounds of the run.
const ROUNDS: u32 = 100;
/// Question of the study, as the list of studies shows it.
pub const ABOUT: &str = "Does POET solve stairs that a direct search does not?";

/// Makes the run and the searches that are missing in the study's file, and prints the results.
pub fn poet_study(args: &Args, wanted: &StudyArgs) -> Result<(), CliError> {
    let given = [
        ("--arms", !wanted.arms.is_empty()),
        ("--baseline", wanted.baseline.is_some()),
        ("--strategies", !wanted.strategies.is_empty()),
        ("--controllers", !wanted.controllers.is_empty()),
        ("--seeds", wanted.seeds.is_some()),
        ("--evaluations", wanted.evaluations.is_some()),
        ("--suite", !wanted.suite.is_empty()),
        ("--preset", args.run.settings.preset.is_some()),
        ("--stairs", args.run.settings.stairs.is_some()),
        (
            "--set, --population, --generations, --duration or --fitness",
            !args.changes()?.is_empty(),
        ),
    ];
    if let Some((flag, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
        return Err(CliError::Usage(format!("{flag} has no effect with snakes study poet")));
    }
    let rounds = number_if("--rounds", &wanted.rounds, 1..=u32::MAX)?.unwrap_or(ROUNDS);
    let mut settings = load_preset("poet")?.settings;
    // The published run was computed with this engine.
    settings.trial.physics.engine = PhysicsEngine::Rapier;
    let plan = RunPlan::new("poet", args.seed_or(FIRST_SEED)?, settings);
    let folder = args.results_folder();
    folder.prepare()?;
    let [ron, csv] = ["ron", "csv"].map(|kind| folder.path().join(format!("poet.{kind}")));
    let fingerprint = settings_fingerprint(&plan);
    let mut study = PoetStudy::new(fingerprint, plan.seed);
    if ron.exists() && !args.run.restart {
        let earlier = load_poet_study(&ron)?;
        if (&earlier.plan, earlier.seed) != (&study.plan, study.seed) {
            let allowed = format!(
                "{} with seed {}; --restart begins again, and --out names another folder",
                study.plan, study.seed
            );
            let found = format!("{} with seed {}", earlier.plan, earlier.seed);
            let source = Invalid::new("plan", found, allowed);
            return Err(SaveError::Invalid { path: ron.clone(), source }.into());
        }
        study = earlier;
    }
    let control = cancel_on_interrupt()?;
    let evaluator = evaluator(args, "study-poet", &ron)?;
    if study.rounds < rounds {
        let earlier = if args.run.restart { ExistingRun::Discard } else { ExistingRun::Keep };
        let source = RunSource::in_saves(&folder, plan.clone(), earlier);
        let measured = measure_poet(source, study, rounds, &*evaluator, &control);
        study = trusted(&*evaluator, measured.map_err(|error| error.keeping(&ron)))?;
        store_poet_study(&ron, &study)?;
    }
    let left = planned_controls(&study, &plan);
    say(&format!("{} direct searches left", left.len()));
    let bar = bar_of(left.iter().map(|of| of.plan.budget()).sum(), "evaluations");
    let done = |run: ControlRun| {
        let share = run.share.map_or("–".to_owned(), |share| format!("{share:.3}"));
        let (node, seed, evaluations) = (run.node + 1, run.seed, run.evaluations);
        say(&format!("stairs {node:<3} seed {seed}: share {share} in {evaluations} evaluations"));
        study.controls.push(run);
        // The study is stored after each run, so that a kill loses no finished run.
        Ok(store_poet_study(&ron, &study)?)
    };
    let spend = |spent| bar.inc(spent);
    let result = beneath_bar(&bar, || run_controls(&left, &*evaluator, &control, spend, done));
    trusted(&*evaluator, result.map_err(|error| error.keeping(&ron)))?;
    report(args, &study, &ron, &csv)
}

/// Writes the table of the direct searches, and prints the claims with their verdicts.
fn report(args: &Args, study: &PoetStudy, ron: &Path, csv: &Path) -> Result<(), CliError> {
    store_csv(csv, &poet_records(study))?;
    if args.json {
        return print_json(&json!({
            "type": "done", "study": "poet", "rounds": study.rounds, "run_hash": study.run_hash, "stairs": study.stairs, "solved": study.solved,
            "challenges": study.challenges.last(), "searches": study.controls.len(), "files": [ron, csv],
        }));
    }
    print(&format!("{}\n", poet_claims(study)))?;
    print_line(&format!("saved to  {}", ron.display()))?;
    print_line(&format!("          {}", csv.display()))
}

/// Continues a run of POET up to its last round, and finds its hardest stairs.
fn measure_poet(
    source: RunSource,
    mut study: PoetStudy,
    rounds: u32,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<PoetStudy, HeadlessError> {
    let plan = source.plan.clone();
    let RecordedRun { mut experiment, mut recorder, mut reports, .. } =
        source.open("snakes study poet")?;
    let cancelled = |Cancelled| HeadlessError::Cancelled { kept: None };
    let bar = bar_of(rounds.into(), "rounds");
    while !experiment.is_over() && experiment.stairs_tree().is_some_and(|tree| tree.rounds < rounds)
    {
        let report = experiment
            .run_generation_recording(evaluator, control, |generation, individual, evaluation| {
                recorder.record_evaluation(generation, individual, evaluation);
            })
            .map_err(cancelled)?;
        for crash in recorder.record_generation(&experiment, &report)? {
            bar.suspend(|| say(&crash));
        }
        bar.set_position(report.stairs.map_or(0, |of| of.rounds).into());
        reports.push(report);
    }
    bar.finish_and_clear();
    let Some(tree) = experiment.stairs_tree() else { return Ok(study) };
    let mut challenges = Vec::new();
    for report in &reports {
        if let Some(count) = report.stairs
            && count.rounds as usize > challenges.len()
        {
            challenges.push(count.challenges);
        }
    }
    study.rounds = tree.rounds;
    study.evaluations = experiment.evaluated();
    study.elapsed_s = reports.iter().map(|report| report.elapsed_s).sum();
    study.stairs = tree.nodes.len() as u32;
    study.solved = tree.solved() as u32;
    study.challenges = challenges;
    let run_hash = format!("{:016x}", experiment.run_hash());
    if study.run_hash != run_hash {
        study.hardest = hardest_stairs(&plan, &tree, evaluator, control).map_err(cancelled)?;
        study.controls = Vec::new();
        study.run_hash = run_hash;
    }
    if tree.rounds < rounds {
        say(&format!("the run is over after {} rounds", tree.rounds));
    }
    Ok(study)
}
