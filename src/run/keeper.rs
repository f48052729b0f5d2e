//! Writes a run down as it goes, so that a kill, a full disk or a power cut loses no finished generation.

use std::path::{Path, PathBuf};

use super::{Crash, Experiment, GenerationReport};
use crate::check::Invalid;
use crate::evolve::{RunPlan, SettingChange};
use crate::save::{Earlier, RunFolder, SaveError, SavesFolder, load_plan};
use crate::score::{Evaluation, Recording};

/// A run in its folder: what is behind it, and what is left to do.
pub struct KeptRun {
    /// The run, after its last finished generation.
    pub experiment: Experiment,
    /// Its folder.
    pub keeper: Keeper,
    /// The generations that are behind it, the first first.
    pub reports: Vec<GenerationReport>,
}

/// Writes one run into its folder.
#[derive(Debug)]
pub struct Keeper {
    folder: RunFolder,
    /// The best champion's file, and what it reached.
    best: Option<(PathBuf, f32)>,
}

/// Why a setting was not changed.
#[derive(Debug, thiserror::Error)]
pub enum ChangeError {
    /// It may not change, or not to this.
    #[error(transparent)]
    Refused(#[from] Invalid),
    /// It could not be written down, without which the run could not be repeated.
    #[error(transparent)]
    NotSaved(#[from] SaveError),
}

/// Which run to open, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSource {
    /// Its folder.
    pub folder: PathBuf,
    /// What run it is.
    pub plan: RunPlan,
    /// What to do with what the folder already has of it.
    pub earlier: Earlier,
}

impl RunSource {
    /// A run in the folder among `saves` that has its name.
    pub fn in_saves(saves: &SavesFolder, plan: RunPlan, earlier: Earlier) -> Self {
        Self { folder: saves.of_run(&plan), plan, earlier }
    }

    /// The run that a folder holds, to go on with.
    ///
    /// # Errors
    /// There is none in it, it was recorded by another engine, or its file is damaged.
    pub fn in_folder(folder: &Path) -> Result<Self, SaveError> {
        let plan = load_plan(folder)?;
        Ok(Self { folder: folder.to_owned(), plan, earlier: Earlier::Keep })
    }

    /// Opens the run. `who` is what others are told who want its folder too.
    ///
    /// # Errors
    /// Another program writes into the folder; it holds another run; something in it is damaged; it cannot
    /// be written.
    pub fn open(self, who: &str) -> Result<KeptRun, SaveError> {
        let (folder, progress) = RunFolder::open(&self.folder, &self.plan, self.earlier, who)?;
        let run_file = self.folder.join("run.ron");
        let experiment = Experiment::resumed(self.plan, &progress)
            .map_err(|source| SaveError::Invalid { path: run_file, source })?;
        let settings = experiment.settings().into_owned();
        let pairs = progress.records.iter().zip(progress.champions);
        let reports: Vec<GenerationReport> = pairs
            .map(|(record, champion)| {
                GenerationReport::of_record(record, champion, &settings.trial)
            })
            .collect();
        let mut keeper = Keeper { folder, best: None };
        for report in &reports {
            if report.champion.is_some() {
                keeper.remember(report, keeper.folder.champion_path(report.generation));
            }
        }
        Ok(KeptRun { experiment, keeper, reports })
    }
}

impl Keeper {
    /// The run's folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// The file of the best champion so far.
    pub fn best(&self) -> Option<&Path> {
        self.best.as_ref().map(|(path, _)| path.as_path())
    }

    /// Notes an evaluation of the generation under way.
    pub fn note(&self, generation: u32, individual: u32, evaluation: &Evaluation) {
        self.folder.note(generation, individual, evaluation);
    }

    /// Changes a setting of the run from its next generation on, written down first. Returns the change; none if it
    /// changes nothing.
    ///
    /// # Errors
    /// The setting may not change during a run, or not to that value, or the change cannot be written down: then
    /// everything is as it was.
    pub fn amend(
        &mut self,
        experiment: &mut Experiment,
        field: &str,
        text: &str,
    ) -> Result<Option<SettingChange>, ChangeError> {
        let Some(change) = experiment.proposed(field, text)? else { return Ok(None) };
        self.folder.change(&change)?;
        experiment.amend(&change)?;
        Ok(Some(change))
    }

    /// What was changed of the run, the earliest first.
    pub fn changes(&self) -> &[SettingChange] {
        self.folder.changes()
    }

    /// Writes down the generation that was just finished. If that fails, it may be tried again. Returns a
    /// line for each genome on which the program failed.
    ///
    /// # Errors
    /// The folder or a file cannot be written.
    pub fn keep(
        &mut self,
        experiment: &Experiment,
        report: &GenerationReport,
    ) -> Result<Vec<String>, SaveError> {
        let crashes = report.crashes.iter().map(|crash| self.keep_crash(crash)).collect();
        let champion = report.champion.as_ref();
        // One more evaluation a generation buys a champion that any later engine can show.
        let recording = champion.map(|champion| Recording::of(&champion.genome, &champion.trial));
        if let Some(lineage) = experiment.lineage_record() {
            self.folder.note_lineage(lineage);
        }
        let path = self.folder.finish_generation(
            &report.record(),
            champion.zip(recording.as_ref()),
            &experiment.knowledge(),
            experiment.run_hash(),
        )?;
        if let Some(path) = path {
            self.remember(report, path);
        }
        Ok(crashes)
    }

    /// Writes down a genome on which the program failed, and says so in a line.
    fn keep_crash(&self, crash: &Crash) -> String {
        let origin = &crash.individual.origin;
        let what = format!(
            "the program failed on individual {} of generation {} ({})",
            origin.individual, origin.generation, crash.message
        );
        match self.folder.keep_crashed(&crash.individual) {
            Ok(path) => {
                format!("{what}; it counts as disqualified, its genome is {}", path.display())
            }
            Err(error) => format!("{what}; its genome is not saved: {error}"),
        }
    }

    fn remember(&mut self, report: &GenerationReport, path: PathBuf) {
        let Some(champion) = &report.champion else { return };
        let fitness = champion.evaluation.fitness;
        if self.best.as_ref().is_none_or(|(_, best)| fitness > *best) {
            self.best = Some((path, fitness));
        }
    }
}

#[cfg(test)]
mod tests;
