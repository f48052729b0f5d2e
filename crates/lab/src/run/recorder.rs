//! Saves a run while it evolves, so that a kill, a full disk or a power cut loses no finished generation.

use std::path::{Path, PathBuf};

use super::experiment::Experiment;
use super::report::{Crash, GenerationReport};
use snakes_core::check::Invalid;
use snakes_core::evolve::{RunPlan, SettingChange};
use snakes_core::save::{ExistingRun, RunFolder, SaveError, SavesFolder, load_plan};
use snakes_core::schema::SettingValue;
use snakes_core::score::{Evaluation, Recording};

/// A run whose folder is open.
pub struct RecordedRun {
    /// Plan with which the run began.
    pub plan_at_start: RunPlan,
    /// The run, after its last finished generation.
    pub experiment: Experiment,
    /// Saves the run.
    pub recorder: RunRecorder,
    /// Reports of the finished generations, the first one first.
    pub reports: Vec<GenerationReport>,
}

/// Saves one run in a folder.
#[derive(Debug)]
pub struct RunRecorder {
    folder: RunFolder,
    /// File of the best champion, and the champion's rank.
    best: Option<(PathBuf, [f32; 2])>,
}

/// Why a setting was not changed.
#[derive(Debug, thiserror::Error)]
pub enum ChangeError {
    /// The setting may not change, or not to this value.
    #[error(transparent)]
    Refused(#[from] Invalid),
    /// The change could not be saved, and without it the run could not be repeated.
    #[error(transparent)]
    NotSaved(#[from] SaveError),
}

/// A run in a folder, and whether to continue it.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSource {
    /// Folder of the run.
    pub folder: PathBuf,
    /// Plan with which the run begins.
    pub plan: RunPlan,
    /// Whether to continue from the contents of the folder or to discard them.
    pub earlier: ExistingRun,
}

impl RunSource {
    /// Returns the source of a run in the folder among `saves` that is named after its plan.
    pub fn in_saves(saves: &SavesFolder, plan: RunPlan, earlier: ExistingRun) -> Self {
        Self { folder: saves.of_run(&plan), plan, earlier }
    }

    /// Returns this run with the first seed, counted up from its own, for which `saves` has no run.
    #[must_use]
    pub fn with_unused_seed(self, saves: &SavesFolder) -> Self {
        let mut plan = self.plan;
        while saves.of_run(&plan).exists() {
            plan.seed = plan.seed.wrapping_add(1);
        }
        Self::in_saves(saves, plan, self.earlier)
    }

    /// Returns the source that continues the run in a folder.
    ///
    /// # Errors
    /// The folder has no run, it was recorded by another engine, or its file is damaged.
    pub fn in_folder(folder: &Path) -> Result<Self, SaveError> {
        let plan = load_plan(folder)?;
        Ok(Self { folder: folder.to_owned(), plan, earlier: ExistingRun::Keep })
    }

    /// Opens the run. `user` names this program to other programs that try to open the same folder.
    ///
    /// # Errors
    /// Another program uses the folder; it holds another run; a file in it is damaged; it cannot be written.
    pub fn open(self, user: &str) -> Result<RecordedRun, SaveError> {
        let (folder, progress) = RunFolder::open(&self.folder, &self.plan, self.earlier, user)?;
        let run_file = self.folder.join("run.ron");
        let experiment = Experiment::resumed(self.plan.clone(), &progress)
            .map_err(|source| SaveError::Invalid { path: run_file, source })?;
        let settings = experiment.settings().into_owned();
        let pairs = progress.records.into_iter().zip(progress.champions);
        let report =
            |(record, champion)| GenerationReport::of_record(record, champion, &settings.trial);
        let reports: Vec<GenerationReport> = pairs.map(report).collect();
        let mut recorder = RunRecorder { folder, best: None };
        for report in &reports {
            if let Some(rank) = report.champion_rank() {
                let path = recorder.folder.champion_path(report.generation);
                recorder.keep_if_best(rank, path);
            }
        }
        Ok(RecordedRun { plan_at_start: self.plan, experiment, recorder, reports })
    }
}

impl RunRecorder {
    /// Returns the run's folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the file of the best champion so far.
    pub fn best(&self) -> Option<&Path> {
        self.best.as_ref().map(|(path, _)| path.as_path())
    }

    /// Saves an evaluation of the generation in progress.
    pub fn record_evaluation(&self, generation: u32, individual: u32, evaluation: &Evaluation) {
        self.folder.note(generation, individual, evaluation);
    }

    /// Changes a setting of the run from its next generation on: the experiment checks the change, the recorder saves it, and the
    /// experiment applies it. Returns the change, or `None` if the setting already has the value.
    ///
    /// # Errors
    /// The setting may not change during a run, the value is not allowed, or the change cannot be saved. Nothing is changed then.
    pub fn change_setting(
        &mut self,
        experiment: &mut Experiment,
        field: &str,
        value: SettingValue,
    ) -> Result<Option<SettingChange>, ChangeError> {
        let Some(proposed) = experiment.propose_change(field, value)? else { return Ok(None) };
        let change = proposed.change.clone();
        self.folder.change(&change)?;
        experiment.apply_change(proposed);
        Ok(Some(change))
    }

    /// Returns all changes of the run's settings, the earliest first.
    pub fn changes(&self) -> &[SettingChange] {
        self.folder.changes()
    }

    /// Saves the generation that was just finished. After an error, the call may be repeated. Returns a line for each individual
    /// whose simulation panicked.
    ///
    /// # Errors
    /// The folder or a file cannot be written.
    pub fn record_generation(
        &mut self,
        experiment: &Experiment,
        report: &GenerationReport,
    ) -> Result<Vec<String>, SaveError> {
        let crashes = report.crashes.iter().map(|crash| self.record_crash(crash)).collect();
        let champion = report.champion.as_ref();
        // The recording costs one more evaluation per generation, and lets any later engine show the champion.
        let recording = champion.map(|champion| Recording::of(&champion.genome, &champion.trial));
        if let Some(lineage) = experiment.lineage_record() {
            self.folder.note_lineage(lineage);
        }
        let path = self.folder.finish_generation(
            &report.record,
            champion.zip(recording.as_ref()),
            &experiment.knowledge(),
            experiment.run_hash(),
        )?;
        if let Some((path, rank)) = path.zip(report.champion_rank()) {
            self.keep_if_best(rank, path);
        }
        Ok(crashes)
    }

    /// Saves an individual whose simulation panicked. Returns a line about it.
    fn record_crash(&self, crash: &Crash) -> String {
        let origin = &crash.individual.origin;
        let what = format!(
            "the simulation of snake {} of generation {} failed ({})",
            origin.individual + 1,
            origin.generation,
            crash.message
        );
        match self.folder.keep_crashed(&crash.individual) {
            Ok(path) => {
                format!(
                    "{what}; it counts as disqualified, and its genome is saved to {}",
                    path.display()
                )
            }
            Err(error) => format!("{what}; its genome is not saved: {error}"),
        }
    }

    fn keep_if_best(&mut self, rank: [f32; 2], path: PathBuf) {
        if self.best.as_ref().is_none_or(|(_, best)| rank > *best) {
            self.best = Some((path, rank));
        }
    }
}

#[cfg(test)]
mod tests;
