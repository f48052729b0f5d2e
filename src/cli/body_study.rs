//! `snakes body-study`: whether protection and an archive pay while bodies evolve, and what creatures learn.

use std::path::PathBuf;

use super::args::{Args, BodyStudyArgs};
use super::compare::seeds_from;
use super::error::{CliError, of_size_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use crate::check::{Invalid, within};
use crate::evolve::{RunPlan, Settings};
use crate::run::body_study::{Arm, FinishedArm, PlannedArm, claims, study_records, train_arms};
use crate::run::creature_study::{
    CreatureArm, FinishedCreatures, PlannedCreatures, creature_claims, creature_records,
    train_creatures,
};
use crate::run::headless::{HeadlessError, say};
use crate::run::progress_bar::bar_of;
use crate::run::{Evaluator, RunControl};
use crate::save::{
    BodyStudyRun, CreatureStudyRun, MAX_STUDY_RUNS, SaveError, StudiedRun, StudyRuns, load_preset,
    load_study, settings_fingerprint, store_csv, store_study,
};
use crate::schema::Choices;

/// Seed of the first run unless one is given: no setting was chosen by it or by those after it.
const FIRST_SEED: u64 = 101;

/// Makes the runs that the study's file does not have yet, and prints the results.
pub fn body_study(args: &Args, wanted: &BodyStudyArgs) -> Result<(), CliError> {
    let (preset, name) =
        if wanted.creatures { ("creatures", "creature-study") } else { ("bodies", "body-study") };
    let mut settings = load_preset(preset)?.settings;
    if let Some(duration_s) = args.duration_s()? {
        settings.trial.duration_s = duration_s;
    }
    let study = Study { args, wanted, name, settings: &settings, preset };
    if wanted.creatures { of_creatures(&study) } else { of_chains(&study) }
}

/// What a study is made of, beside its runs.
struct Study<'a> {
    args: &'a Args,
    wanted: &'a BodyStudyArgs,
    /// The name of its files.
    name: &'static str,
    preset: &'static str,
    settings: &'a Settings,
}

fn of_chains(study: &Study<'_>) -> Result<(), CliError> {
    let planned = study.plans(Arm::OPTIONS, |arm, settings, seed, evaluations| {
        Ok(PlannedArm { arm, plan: arm.plan(settings, seed, evaluations)? })
    })?;
    let (files, runs) = study.continued(
        &planned,
        |planned| (planned.arm.name(), &planned.plan),
        |run: &BodyStudyRun| {
            let share = run.share.map_or("–".to_owned(), |share| format!("{share:.3}"));
            format!("share {share}, {} blocks", run.blocks)
        },
        |left, evaluator, control, spent, done| {
            let done = |FinishedArm { arm, run }| done(arm.name(), run);
            train_arms(left, evaluator, control, spent, done)
        },
    )?;
    study.report(files, &study_records(&runs), || claims(&runs, study.settings))
}

fn of_creatures(study: &Study<'_>) -> Result<(), CliError> {
    let planned = study.plans(CreatureArm::OPTIONS, |arm, settings, seed, evaluations| {
        Ok(PlannedCreatures { arm, plan: arm.plan(settings, seed, evaluations)? })
    })?;
    let (files, runs) = study.continued(
        &planned,
        |planned| (planned.arm.name(), &planned.plan),
        |run: &CreatureStudyRun| {
            let fitness = run.fitness.map_or("–".to_owned(), |fitness| format!("{fitness:.3}"));
            format!("fitness {fitness}, {} steps, {}", run.steps, run.tree)
        },
        |left, evaluator, control, spent, done| {
            let done = |FinishedCreatures { arm, run }| done(arm.name(), run);
            train_creatures(left, evaluator, control, spent, done)
        },
    )?;
    study.report(files, &creature_records(&runs), || creature_claims(&runs))
}

/// What takes a finished run, with the name of its arm.
type Done<'a, R> = &'a mut (dyn FnMut(&'static str, R) -> Result<(), HeadlessError> + Send);

impl Study<'_> {
    /// The runs of all arms, seed by seed, so that an interrupted study has about as many of each.
    fn plans<A: Copy, P>(
        &self,
        arms: &[A],
        plan: impl Fn(A, &Settings, u64, u32) -> Result<P, Invalid>,
    ) -> Result<Vec<P>, CliError> {
        let mut planned = Vec::new();
        for seed in seeds_from(self.args.seed_or(FIRST_SEED)?, self.wanted.seeds)? {
            for arm in arms {
                let plan = plan(*arm, self.settings, seed, self.wanted.evaluations);
                planned.push(plan.map_err(of_size_flag)?);
            }
        }
        within("runs", planned.len(), 1..=MAX_STUDY_RUNS)?;
        Ok(planned)
    }

    /// Makes the planned runs that the study's file does not have yet. The names of its files and all runs.
    fn continued<P: Clone, R: StudiedRun + Send>(
        &self,
        planned: &[P],
        place: impl Fn(&P) -> (&'static str, &RunPlan),
        words: impl Fn(&R) -> String + Sync,
        train: impl FnOnce(
            &[P],
            &dyn Evaluator,
            &RunControl,
            &(dyn Fn(u64) + Sync),
            Done<'_, R>,
        ) -> Result<(), HeadlessError>,
    ) -> Result<([PathBuf; 2], StudyRuns<R>), CliError> {
        let folder = self.args.results_folder();
        folder.prepare()?;
        let files = ["ron", "csv"].map(|kind| folder.path().join(format!("{}.{kind}", self.name)));
        let ron = &files[0];
        let common = RunPlan::new(self.preset, 0, self.settings.clone());
        let fingerprint = settings_fingerprint(&common);
        let mut runs: StudyRuns<R> = StudyRuns::new(fingerprint, self.wanted.evaluations);
        if ron.exists() && !self.args.restart {
            let earlier = load_study(ron)?;
            let now = (&runs.settings, runs.evaluations);
            if (&earlier.settings, earlier.evaluations) != now {
                let allowed = format!(
                    "{} with {} evaluations, the fingerprint of the preset's settings; --restart begins again, and --out \
                     names another folder",
                    runs.settings, runs.evaluations
                );
                let found = format!("{} with {}", earlier.settings, earlier.evaluations);
                let source = Invalid::new("settings", found, allowed);
                return Err(SaveError::Invalid { path: ron.clone(), source }.into());
            }
            runs = earlier;
        }
        let is_done = |planned: &P| {
            let (arm, plan) = place(planned);
            runs.of_arm(arm).iter().any(|run| run.seed() == plan.seed)
        };
        let left: Vec<P> = planned.iter().filter(|of| !is_done(of)).cloned().collect();
        say(&format!("{} of {} runs left", left.len(), planned.len()));
        let control = cancel_on_interrupt();
        let evaluator = evaluator(self.args, "body-study", ron)?;
        let bar = bar_of(left.iter().map(|of| place(of).1.budget()).sum(), "evaluations");
        let mut done = |arm: &'static str, run: R| {
            let (seed, words) = (run.seed(), words(&run));
            bar.suspend(|| say(&format!("{arm:<12} seed {seed}: {words}")));
            runs.add(arm, run);
            // After each run, so that a kill loses none that is finished.
            Ok(store_study(ron, &runs)?)
        };
        let result = train(&left, &*evaluator, &control, &|spent| bar.inc(spent), &mut done);
        bar.finish_and_clear();
        trusted(&*evaluator, result.map_err(|error| error.keeping(ron)))?;
        store_study(ron, &runs)?;
        Ok((files, runs))
    }

    /// Writes the table of all runs, and prints what they say.
    fn report(
        &self,
        [ron, csv]: [PathBuf; 2],
        records: &[Vec<String>],
        claims: impl Fn() -> String,
    ) -> Result<(), CliError> {
        store_csv(&csv, records)?;
        if self.args.json {
            let line =
                serde_json::json!({"done": true, "runs": records.len() - 1, "files": [ron, csv]});
            return print(&format!("{line}\n"));
        }
        let [ron, csv] = [ron, csv].map(|file| file.display().to_string());
        print(&format!("{}\nsaved to  {ron}\n          {csv}\n", claims()))
    }
}
