//! The run in the background: starts, pauses and resets it, and keeps its reports for the panels.

mod compared_runs;
pub mod events;
mod individuals;
mod live_changes;
mod next_run;
mod run_commands;
mod shared_run;
mod whole_generation;

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use bevy::prelude::*;

use super::milestones::Milestone;
use super::options::Options;
use super::run_context::RunContext;
use snakes_core::evolve::{Champion, IndividualId, RunPlan, Settings};
use snakes_core::save::ExistingRun;
use snakes_core::schema::{SettingValue, named_values};
use snakes_lab::run::{
    Ancestor, BackgroundRun, Evaluator, Exploration, GenerationReport, RunSource,
};

pub(crate) use compared_runs::{ComparedRuns, ListedRun, MOST_COMPARED, UnreadableRun};
pub(crate) use live_changes::news_of;

/// Number of latest generations whose ten best snakes are kept.
const REMEMBERED_GENERATIONS: usize = 200;

/// Individuals with descendants, by their place: generation and index.
type Ancestors = BTreeMap<IndividualId, Arc<Ancestor>>;

named_values! {
    /// Status of a run.
    pub enum RunStatus {
        /// Nothing is evaluated yet.
        Ready = "ready";
        /// A generation is being evaluated.
        Running = "running";
        /// Evolution is paused.
        Paused = "paused";
        /// All generations are finished.
        Finished = "finished";
    }
}

/// The current run and its results.
#[derive(Resource, Debug)]
pub(crate) struct CurrentRun {
    /// Evaluator, saves folder and presets, which all runs since the start of the program use.
    pub context: RunContext,
    /// Number of the run since the start of the program; the first is 0.
    pub number: u32,
    /// Current run, with the plan with which it began.
    pub(super) source: RunSource,
    /// Plan of the current run after all its changes.
    pub plan_now: RunPlan,
    /// Plan of the next run.
    pub plan_next: RunPlan,
    /// Requested changes of the current run that take effect with its next generation: full dotted names and values.
    pending: Vec<(String, SettingValue)>,
    background: Option<BackgroundRun>,
    /// Evaluator that also uses other computers, while there is one, and the number of generations that were finished before it was set.
    pub(super) shared: Option<(Arc<dyn Evaluator>, usize)>,
    /// Reason why the previous run was stopped because its results cannot be trusted, until the reason is shown.
    pub fault: Option<String>,
    /// The previous run, which may still be stopping.
    before: Option<BackgroundRun>,
    /// Reports of the finished generations, the first generation first.
    pub reports: Vec<GenerationReport>,
    /// Generations that were better than all earlier ones, the earliest first.
    pub milestones: Vec<Milestone>,
    /// Results besides champions; `None` until the first generation is finished.
    exploration: Option<Box<Exploration>>,
    /// Individuals with descendants, by their place; computed at the first use.
    ancestors: OnceLock<Ancestors>,
    /// Number of updates of `exploration`, part of `Self::version`.
    times_explored: u64,
    /// Other runs that the charts show.
    pub others: ComparedRuns,
    /// The ten best snakes of each of the latest generations since the start of the program, the earliest generation first.
    leaders: VecDeque<Vec<Champion>>,
    /// Hash of the run; `None` until the run is finished.
    pub run_hash: Option<u64>,
    /// Whether a lesson uses the stage and the settings. Edits of settings then do not affect the current run.
    pub is_lent: bool,
    /// Folder of a run that was reset; its contents are deleted when the run starts again.
    discarded: Option<PathBuf>,
}

impl CurrentRun {
    /// Prepares the run with which the studio opens.
    pub fn new(options: &Options) -> Self {
        let context = RunContext::new(options);
        Self::prepared(context.first.clone(), context.first.plan.clone(), context)
    }

    fn prepared(source: RunSource, plan_next: RunPlan, context: RunContext) -> Self {
        Self {
            plan_now: source.plan.clone(),
            plan_next,
            pending: Vec::new(),
            source,
            context,
            number: 0,
            background: None,
            shared: None,
            fault: None,
            before: None,
            reports: Vec::new(),
            milestones: Vec::new(),
            exploration: None,
            ancestors: OnceLock::new(),
            times_explored: 0,
            others: ComparedRuns::default(),
            leaders: VecDeque::new(),
            run_hash: None,
            is_lent: false,
            discarded: None,
        }
    }

    /// Returns the status of the run.
    pub fn status(&self) -> RunStatus {
        match &self.background {
            _ if self.run_hash.is_some() => RunStatus::Finished,
            None => RunStatus::Ready,
            Some(background) if background.is_paused() => RunStatus::Paused,
            Some(_) => RunStatus::Running,
        }
    }

    /// Describes the finished generations of the current run: "3 of 40 generations".
    pub fn generations_in_words(&self) -> String {
        self.plan_now.generations_in_words(self.reports.len() as u32, self.run_hash.is_some())
    }

    /// Returns the hash of a finished run, as it is printed in the terminal: "Run hash 00c0ffee00c0ffee".
    pub fn hash_in_words(&self) -> Option<String> {
        self.run_hash.map(|hash| format!("Run hash {hash:016x}"))
    }

    /// Returns the settings of the current run after all its changes.
    pub fn settings(&self) -> &Settings {
        &self.plan_now.settings
    }

    /// Returns the other runs of the saves folder, each with its readable name; `None` until the runs are listed.
    pub fn listed(&self) -> Option<impl Iterator<Item = &ListedRun>> {
        Some(self.others.runs.as_ref()?.iter().filter(|of| of.run.folder != self.source.folder))
    }

    /// Returns the results besides champions; `None` until the first generation is finished.
    pub fn exploration(&self) -> Option<&Exploration> {
        self.exploration.as_deref()
    }

    /// Returns a value that differs after every change of something that charts show.
    pub fn version(&self) -> (u32, u64, usize, u64) {
        (self.number, self.times_explored, self.reports.len(), self.others.version)
    }

    /// Returns the ten best snakes of a generation, or of the latest one, the best first. Empty if the generation is
    /// too old or was finished before the program started.
    pub fn leaders(&self, generation: Option<u32>) -> &[Champion] {
        let of = |leaders: &Vec<Champion>| Some(leaders.first()?.origin.generation);
        let is_it = |leaders: &&Vec<Champion>| generation.is_none() || of(leaders) == generation;
        self.leaders.iter().rev().find(is_it).map_or(&[], Vec::as_slice)
    }

    /// Stores the results besides champions.
    fn explore(&mut self, mut exploration: Box<Exploration>) {
        let leaders = std::mem::take(&mut exploration.leaders);
        if !leaders.is_empty() {
            self.leaders.push_back(leaders);
        }
        if self.leaders.len() > REMEMBERED_GENERATIONS {
            self.leaders.pop_front();
        }
        self.exploration = Some(exploration);
        self.ancestors = OnceLock::new();
        self.times_explored += 1;
    }

    /// Returns the finished and the total evaluations of the current generation.
    pub fn progress(&self) -> (u32, u32) {
        match &self.background {
            Some(background) => background.progress(),
            None => (0, self.settings().evolution.population),
        }
    }

    /// Returns the champion of a generation; the first generation is 1.
    pub fn champion_of(&self, generation: u32) -> Option<&Champion> {
        let index = (generation as usize).checked_sub(1)?;
        self.reports.get(index)?.champion.as_ref()
    }

    /// Evolves until paused or finished. If the current run is finished, begins the next one.
    pub fn start(&mut self) -> Result<(), String> {
        if self.status() == RunStatus::Finished {
            self.prepare_another();
        }
        self.background()?.resume();
        Ok(())
    }

    /// Pauses evolution.
    pub fn pause(&mut self) -> Result<(), String> {
        if self.status() == RunStatus::Running {
            self.background()?.pause();
        }
        Ok(())
    }

    /// Evolves to the end of the current generation.
    pub fn single_generation(&mut self) -> Result<(), String> {
        if self.status() == RunStatus::Finished {
            return Err("The run is finished; \"New run\" starts another.".to_owned());
        }
        self.background()?.run_single_generation();
        Ok(())
    }

    /// Starts another run, with the next seed if nothing else differs. The current run can be resumed later.
    pub fn begin_next(&mut self) -> Result<(), String> {
        if self.next_run_differs() || self.is_under_way() {
            self.prepare_another();
        }
        self.start()
    }

    /// Prepares the next run. If its plan is that of the current run, the current run is discarded and starts again. A
    /// different run that was stopped earlier is resumed.
    pub fn reset(&mut self) {
        // The plan with which the current run began is compared, because changes during a run make it differ from a run
        // that began with the changed settings.
        if self.source.plan != self.plan_next {
            self.prepare_next();
        } else {
            self.discarded = Some(self.source.folder.clone());
            self.replace(RunSource { earlier: ExistingRun::Discard, ..self.source.clone() });
        }
    }

    /// Makes the next run the current one, without starting it.
    fn prepare_next(&mut self) {
        let plan = self.plan_next.clone();
        let mut source = RunSource::in_saves(&self.context.saves, plan, ExistingRun::Keep);
        // A reset remains in effect if the settings were changed and changed back.
        if self.discarded.as_ref() == Some(&source.folder) {
            source.earlier = ExistingRun::Discard;
        }
        self.replace(source);
    }

    /// Replaces the current run by another one. The current run is stopped in the background.
    fn replace(&mut self, source: RunSource) {
        let before = self.background.take().or(self.before.take());
        *self = Self {
            number: self.number + 1,
            before,
            others: std::mem::take(&mut self.others),
            is_lent: self.is_lent,
            discarded: self.discarded.take(),
            ..Self::prepared(source, self.plan_next.clone(), self.context.clone())
        };
        if self.others.runs.is_some() {
            // The list of runs may be visible, and the replaced run belongs to it. If listing fails, the user can
            // request it again.
            let _ = self.list_runs();
        }
    }

    /// Prepares the current run to resume from its saved state.
    fn open_again(&mut self) {
        self.context.set_run_folder(None);
        self.replace(RunSource { earlier: ExistingRun::Keep, ..self.source.clone() });
    }

    /// Lists all runs in the saves folder, in the background.
    pub fn list_runs(&mut self) -> Result<(), String> {
        self.others.list(self.context.saves.clone())
    }

    /// Resumes a run that was stopped. The current run can be resumed later.
    pub fn go_on_with(&mut self, folder: &Path) -> Result<(), String> {
        self.replace_by(folder)?;
        self.start()
    }

    /// Opens an earlier run, paused or finished, instead of the run with which the studio opened.
    pub fn open_earlier(&mut self, folder: &Path) -> Result<(), String> {
        let number = self.number;
        self.replace_by(folder)?;
        self.number = number;
        self.background().map(drop)
    }

    /// Replaces the current run by the one in a folder, without starting it.
    fn replace_by(&mut self, folder: &Path) -> Result<(), String> {
        let source = RunSource::in_folder(folder)?;
        self.plan_next = source.plan.clone();
        self.replace(source);
        Ok(())
    }

    /// Returns whether the current run will pause after its current generation.
    pub fn is_single_generation(&self) -> bool {
        self.background.as_ref().is_some_and(BackgroundRun::is_single_generation)
    }

    fn take_over_if_ready(&mut self) {
        if self.status() == RunStatus::Ready {
            self.prepare_next();
        }
    }

    /// Prepares a run that differs from the current one. If nothing else differs, takes the next seed for which there is
    /// no run.
    fn prepare_another(&mut self) {
        if !self.next_run_differs() {
            self.plan_next.seed = self.plan_next.seed.wrapping_add(1);
            let (saves, plan) = (&self.context.saves, self.plan_next.clone());
            let unused =
                RunSource::in_saves(saves, plan, ExistingRun::Keep).with_unused_seed(saves);
            self.plan_next.seed = unused.plan.seed;
        }
        self.prepare_next();
    }

    /// Returns the run's background thread, and starts it if necessary.
    fn background(&mut self) -> Result<&BackgroundRun, String> {
        let background = match self.background.take() {
            Some(background) => background,
            None => {
                let source = self.source.clone();
                let evaluator = self.evaluator();
                self.context.set_run_folder(Some(source.folder.clone()));
                // Changes that were requested of a thread that has ended are requested again.
                BackgroundRun::start(source, evaluator, self.pending.clone(), self.before.take())
                    .map_err(|error| format!("Evolution could not be started: {error}"))?
            }
        };
        Ok(self.background.insert(background))
    }
}

#[cfg(test)]
mod fixtures;
#[cfg(test)]
pub(crate) use fixtures::{
    bodies_run, climber, compared_run, evolve, explored_run, landed_run, next_generation,
    prepared_run, run_in, small_run, species_run,
};
