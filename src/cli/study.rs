//! The common part of the commands that make the runs of a study and print what they say.

use std::path::PathBuf;

use super::args::Args;
use super::compare::seeds_from;
use super::error::{CliError, of_size_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use snakes_core::check::{Invalid, within};
use snakes_core::evolve::{RunPlan, Settings};
use snakes_core::save::{
    MAX_STUDY_RUNS, SaveError, StudiedRun, StudyRuns, load_preset, load_study,
    settings_fingerprint, store_csv, store_study,
};
use snakes_core::world::PhysicsEngine;
use snakes_lab::run::headless::say;
use snakes_lab::run::progress_bar::bar_of;
use snakes_lab::run::study::{PlannedArm, StudyArm, train_arms};

/// The settings of a preset, with the engine of the runs that are published.
///
/// # Errors
/// There is no such preset.
pub fn published_settings(preset: &str) -> Result<Settings, CliError> {
    let mut settings = load_preset(preset)?.settings;
    settings.trial.physics.engine = PhysicsEngine::Rapier;
    Ok(settings)
}

/// Seed of the first run of most studies unless one is given: no setting was chosen by it or by those after it.
pub const FIRST_SEED: u64 = 101;

/// The arguments, the files and the settings of a study.
pub struct Study<'a> {
    pub args: &'a Args,
    /// The name of its command.
    pub command: &'static str,
    /// Seed of the first run unless one is given.
    pub first_seed: u64,
    /// Number of seeds.
    pub seeds: u64,
    /// Evaluations that each run may spend.
    pub evaluations: u32,
    /// The name of its files.
    pub name: &'static str,
    pub preset: &'static str,
    pub settings: &'a Settings,
}

/// The paths of a study's two files, and all of its runs.
pub type Finished<R> = ([PathBuf; 2], StudyRuns<R>);

impl Study<'_> {
    /// The runs of all arms, seed by seed, so that an interrupted study has about as many of each.
    fn plans<A: StudyArm>(&self) -> Result<Vec<PlannedArm<A>>, CliError> {
        let mut planned = Vec::new();
        for seed in seeds_from(self.args.seed_or(self.first_seed)?, self.seeds)? {
            for &arm in A::OPTIONS {
                let plan = arm.plan(self.settings, seed, self.evaluations);
                planned.push(PlannedArm { arm, plan: plan.map_err(of_size_flag)? });
            }
        }
        within("runs", planned.len(), 1..=MAX_STUDY_RUNS)?;
        Ok(planned)
    }

    /// Makes the runs that the study's file does not have yet; `words` describes one.
    pub fn continued<A: StudyArm>(
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
        let mut runs: StudyRuns<A::Run> = StudyRuns::new(fingerprint, self.evaluations);
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
        let evaluator = evaluator(self.args, self.command, ron)?;
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
    pub fn report(
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
