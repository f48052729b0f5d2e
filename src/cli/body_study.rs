//! `snakes body-study`: whether protection and an archive pay while bodies evolve, and what creatures learn.

use std::path::PathBuf;

use super::args::{Args, BodyStudyArgs};
use super::compare::seeds_from;
use super::error::{CliError, of_size_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use crate::check::{Invalid, within};
use crate::evolve::{RunPlan, Settings};
use crate::run::body_study::{Arm, claims, study_records};
use crate::run::creature_study::{CreatureArm, creature_claims, creature_records};
use crate::run::headless::say;
use crate::run::progress_bar::bar_of;
use crate::run::study::{PlannedArm, StudyArm, train_arms};
use crate::save::{
    MAX_STUDY_RUNS, SaveError, StudiedRun, StudyRuns, load_preset, load_study,
    settings_fingerprint, store_csv, store_study,
};

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

fn of_chains(study: &Study<'_>) -> Result<(), CliError> {
    let (files, runs) = study.continued::<Arm>(|run| {
        let share = run.share.map_or("–".to_owned(), |share| format!("{share:.3}"));
        format!("share {share}, {} blocks", run.blocks)
    })?;
    study.report(files, &study_records(&runs), || claims(&runs, study.settings))
}

fn of_creatures(study: &Study<'_>) -> Result<(), CliError> {
    let (files, runs) = study.continued::<CreatureArm>(|run| {
        let fitness = run.fitness.map_or("–".to_owned(), |fitness| format!("{fitness:.3}"));
        format!("fitness {fitness}, {} steps, {}", run.steps, run.tree)
    })?;
    study.report(files, &creature_records(&runs), || creature_claims(&runs))
}

/// The arguments, the files and the settings of a study.
struct Study<'a> {
    args: &'a Args,
    wanted: &'a BodyStudyArgs,
    /// The name of its files.
    name: &'static str,
    preset: &'static str,
    settings: &'a Settings,
}

/// The paths of a study's two files, and all of its runs.
type Finished<R> = ([PathBuf; 2], StudyRuns<R>);

impl Study<'_> {
    /// The runs of all arms, seed by seed, so that an interrupted study has about as many of each.
    fn plans<A: StudyArm>(&self) -> Result<Vec<PlannedArm<A>>, CliError> {
        let mut planned = Vec::new();
        for seed in seeds_from(self.args.seed_or(FIRST_SEED)?, self.wanted.seeds)? {
            for &arm in A::OPTIONS {
                let plan = arm.plan(self.settings, seed, self.wanted.evaluations);
                planned.push(PlannedArm { arm, plan: plan.map_err(of_size_flag)? });
            }
        }
        within("runs", planned.len(), 1..=MAX_STUDY_RUNS)?;
        Ok(planned)
    }

    /// Makes the runs that the study's file does not have yet; `words` describes one.
    fn continued<A: StudyArm>(
        &self,
        words: impl Fn(&A::Run) -> String + Sync,
    ) -> Result<Finished<A::Run>, CliError> {
        let planned = self.plans::<A>()?;
        let folder = self.args.results_folder();
        folder.prepare()?;
        let files = ["ron", "csv"].map(|kind| folder.path().join(format!("{}.{kind}", self.name)));
        let ron = &files[0];
        let common = RunPlan::new(self.preset, 0, self.settings.clone());
        let fingerprint = settings_fingerprint(&common);
        let mut runs: StudyRuns<A::Run> = StudyRuns::new(fingerprint, self.wanted.evaluations);
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
        let is_done = |planned: &PlannedArm<A>| {
            let known = runs.of_arm(planned.arm.name());
            known.iter().any(|run| run.seed() == planned.plan.seed)
        };
        let left: Vec<_> = planned.iter().filter(|of| !is_done(of)).cloned().collect();
        say(&format!("{} of {} runs left", left.len(), planned.len()));
        let control = cancel_on_interrupt();
        let evaluator = evaluator(self.args, "body-study", ron)?;
        let bar = bar_of(left.iter().map(|of| of.plan.budget()).sum(), "evaluations");
        let result = train_arms(
            &left,
            &*evaluator,
            &control,
            |spent| bar.inc(spent),
            |arm, run| {
                let (name, seed, words) = (arm.name(), run.seed(), words(&run));
                bar.suspend(|| say(&format!("{name:<12} seed {seed}: {words}")));
                runs.add(name, run);
                // After each run, so that a kill loses none that is finished.
                Ok(store_study(ron, &runs)?)
            },
        );
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
