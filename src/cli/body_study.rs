//! `snakes body-study`: whether protection and an archive pay while bodies evolve.

use super::args::{Args, BodyStudyArgs};
use super::compare::seeds_from;
use super::error::{CliError, of_size_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use crate::check::{Invalid, within};
use crate::evolve::{RunPlan, Settings};
use crate::run::body_study::{Arm, PlannedArm, claims, study_records, train_arms};
use crate::run::headless::say;
use crate::run::progress_bar::bar_of;
use crate::save::{
    BodyStudyRuns, MAX_BODY_STUDY_RUNS, SaveError, load_body_study, load_preset,
    settings_fingerprint, store_body_study, store_csv,
};
use crate::schema::Choices;

/// Seed of the first run unless one is given: no setting was chosen by it or by those after it.
const FIRST_SEED: u64 = 101;

/// Makes the runs that the study's file does not have yet, and prints the results.
pub fn body_study(args: &Args, wanted: &BodyStudyArgs) -> Result<(), CliError> {
    let mut settings = load_preset("bodies")?.settings;
    if let Some(duration_s) = args.duration_s()? {
        settings.trial.duration_s = duration_s;
    }
    let planned = plans(args, wanted, &settings)?;
    within("runs", planned.len(), 1..=MAX_BODY_STUDY_RUNS)?;
    let folder = args.results_folder();
    folder.prepare()?;
    let [ron, csv] = ["ron", "csv"].map(|kind| folder.path().join(format!("body-study.{kind}")));
    let fingerprint = settings_fingerprint(&RunPlan::new("bodies", 0, settings.clone()));
    let mut runs = BodyStudyRuns::new(fingerprint, wanted.evaluations);
    if ron.exists() && !args.restart {
        let earlier = load_body_study(&ron)?;
        let now = (&runs.settings, runs.evaluations);
        if (&earlier.settings, earlier.evaluations) != now {
            let allowed = format!(
                "{} with {} evaluations, the fingerprint of the preset's settings; --restart begins again, and --out names \
                 another folder",
                runs.settings, runs.evaluations
            );
            let found = format!("{} with {}", earlier.settings, earlier.evaluations);
            let source = Invalid::new("settings", found, allowed);
            return Err(SaveError::Invalid { path: ron, source }.into());
        }
        runs = earlier;
    }
    let is_done = |planned: &PlannedArm| {
        let known = runs.of_arm(planned.arm.name());
        known.iter().any(|run| run.seed == planned.plan.seed)
    };
    let left: Vec<PlannedArm> = planned.iter().filter(|of| !is_done(of)).cloned().collect();
    say(&format!("{} of {} runs left", left.len(), planned.len()));
    let control = cancel_on_interrupt();
    let evaluator = evaluator(args, "body-study", &ron)?;
    let bar = bar_of(left.iter().map(|planned| planned.plan.budget()).sum(), "evaluations");
    let result = train_arms(
        &left,
        &*evaluator,
        &control,
        |spent| bar.inc(spent),
        |done| {
            let share = done.run.share.map_or("–".to_owned(), |share| format!("{share:.3}"));
            let (name, seed, blocks) = (done.arm.name(), done.run.seed, done.run.blocks);
            bar.suspend(|| say(&format!("{name:<12} seed {seed}: share {share}, {blocks} blocks")));
            runs.add(done.arm.name(), done.run);
            // After each run, so that a kill loses none that is finished.
            Ok(store_body_study(&ron, &runs)?)
        },
    );
    bar.finish_and_clear();
    trusted(&*evaluator, result.map_err(|error| error.keeping(&ron)))?;
    store_body_study(&ron, &runs)?;
    let records = study_records(&runs);
    store_csv(&csv, &records)?;
    if args.json {
        let line =
            serde_json::json!({"done": true, "runs": records.len() - 1, "files": [ron, csv]});
        return print(&format!("{line}\n"));
    }
    let [ron, csv] = [ron, csv].map(|file| file.display().to_string());
    print(&format!("{}\nsaved to  {ron}\n          {csv}\n", claims(&runs, &settings)))
}

/// The runs of all arms, seed by seed, so that an interrupted study has about as many of each.
fn plans(
    args: &Args,
    wanted: &BodyStudyArgs,
    settings: &Settings,
) -> Result<Vec<PlannedArm>, CliError> {
    let mut planned = Vec::new();
    for seed in seeds_from(args.seed_or(FIRST_SEED)?, wanted.seeds)? {
        for arm in Arm::OPTIONS.iter().copied() {
            let plan = arm.plan(settings, seed, wanted.evaluations);
            let plan = plan.map_err(of_size_flag)?;
            planned.push(PlannedArm { arm, plan });
        }
    }
    Ok(planned)
}
