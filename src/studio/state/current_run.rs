//! The run in the background: started, paused, reset; its reports are kept for the panels.

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

use super::milestones::Milestones;
use super::run_context::RunContext;
use snakes_core::evolve::{Champion, IndividualId, RunPlan, Settings};
use snakes_core::save::{ExistingRun, RunSummary};
use snakes_core::schema::SettingValue;
use snakes_lab::run::{
    Ancestor, BackgroundRun, Evaluator, Exploration, GenerationReport, RunSource,
};

pub(crate) use compared_runs::{ComparedRuns, MOST_COMPARED};
pub(crate) use live_changes::news_of;

/// Number of generations whose best ten are kept.
const REMEMBERED_GENERATIONS: usize = 200;

/// Individuals with descendants, by place.
type Ancestors = BTreeMap<IndividualId, Arc<Ancestor>>;

/// Status of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RunStatus {
    /// Prepared, nothing evaluated yet.
    Ready,
    /// Evaluating.
    Running,
    /// Paused.
    Paused,
    /// All generations are finished.
    Finished,
}

/// The current run and its results.
#[derive(Resource, Debug)]
pub(crate) struct CurrentRun {
    context: RunContext,
    /// Number of the run within this session; the first is 0.
    number: u32,
    /// The current run, with its plan as it began.
    source: RunSource,
    /// The plan of the current run after all its changes.
    plan_now: RunPlan,
    /// The plan of the next run.
    plan_next: RunPlan,
    /// Requested changes of the current run that wait for its next generation: full dotted names and values.
    pending: Vec<(String, SettingValue)>,
    background: Option<BackgroundRun>,
    /// Evaluates the run on other computers, too, while it may, and the number of generations that were finished before.
    shared: Option<(Arc<dyn Evaluator>, usize)>,
    /// Why the run before was stopped whose results cannot be trusted, until that is shown.
    fault: Option<String>,
    /// The previous run, which may still be stopping.
    before: Option<BackgroundRun>,
    reports: Vec<GenerationReport>,
    /// The generations that were better than all before them.
    milestones: Milestones,
    /// Results besides champions, after the first finished generation.
    exploration: Option<Box<Exploration>>,
    /// Individuals with descendants, by place; computed on first use.
    ancestors: OnceLock<Ancestors>,
    /// Number of updates of `exploration`.
    times_explored: u64,
    /// Other runs shown in the charts.
    others: ComparedRuns,
    /// The best ten of each of the latest generations of this session, the earliest first.
    leaders: VecDeque<Vec<Champion>>,
    run_hash: Option<u64>,
    /// Whether a lesson has the stage and the settings: see [`Self::lend`].
    is_lent: bool,
    /// Folder of a run that was reset; its contents are deleted when the run starts again.
    discarded: Option<PathBuf>,
}

impl FromWorld for CurrentRun {
    fn from_world(world: &mut World) -> Self {
        Self::new(world.resource::<RunContext>().clone())
    }
}

impl CurrentRun {
    /// Prepares the run that the studio opens with.
    pub fn new(context: RunContext) -> Self {
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
            milestones: Milestones::default(),
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

    /// Status of the run.
    pub fn status(&self) -> RunStatus {
        match &self.background {
            _ if self.run_hash.is_some() => RunStatus::Finished,
            None => RunStatus::Ready,
            Some(background) if background.is_paused() => RunStatus::Paused,
            Some(_) => RunStatus::Running,
        }
    }

    /// The greatest number of generations of the current run in words, with all its changes: "40" or "at most 40".
    pub fn most_generations_in_words(&self) -> String {
        self.plan_now.most_generations_in_words()
    }

    /// The finished generations of the current run in words: "3 of 40 generations".
    pub fn generations_in_words(&self) -> String {
        self.plan_now.generations_in_words(self.reports.len() as u32, self.run_hash.is_some())
    }

    /// Maximum number of evaluations of the current run, with all its changes.
    pub fn budget(&self) -> u64 {
        self.plan_now.budget()
    }

    /// Number of the run within this session; the first is 0.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Name of the preset that the current run started from.
    pub fn preset(&self) -> &str {
        &self.source.plan.preset
    }

    /// Where the current run is saved.
    pub fn folder(&self) -> &Path {
        &self.source.folder
    }

    /// Seed of the current run.
    pub fn seed(&self) -> u64 {
        self.source.plan.seed
    }

    /// Settings of the current run, as they are after all its changes.
    pub fn settings(&self) -> &Settings {
        &self.plan_now.settings
    }

    /// Stopped runs that can be resumed; `None` until the runs are listed.
    pub fn stopped(&self) -> Option<impl Iterator<Item = &RunSummary>> {
        let is_other = |run: &&RunSummary| run.is_stopped() && run.folder != self.source.folder;
        Some(self.others.runs()?.iter().filter(is_other))
    }

    /// Reports of the finished generations, the first generation first.
    pub fn reports(&self) -> &[GenerationReport] {
        &self.reports
    }

    /// Results besides champions, after the first finished generation.
    pub fn exploration(&self) -> Option<&Exploration> {
        self.exploration.as_deref()
    }

    /// Changes whenever something shown by charts changes.
    pub fn version(&self) -> (u32, u64, usize, u64) {
        (self.number, self.times_explored, self.reports.len(), self.others.version())
    }

    /// Other runs shown in the charts.
    pub fn others(&self) -> &ComparedRuns {
        &self.others
    }

    /// The best ten of a generation, or of the latest one, best first; empty for generations of earlier sessions or
    /// long ago.
    pub fn leaders(&self, generation: Option<u32>) -> &[Champion] {
        let is_it = |leaders: &&Vec<Champion>| match (generation, leaders.first()) {
            (None, _) => true,
            (Some(generation), Some(first)) => first.origin.generation == generation,
            (Some(_), None) => false,
        };
        self.leaders.iter().rev().find(is_it).map_or(&[], Vec::as_slice)
    }

    /// Stores results besides champions.
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

    /// Finished and total evaluations of the current generation.
    pub fn progress(&self) -> (u32, u32) {
        match &self.background {
            Some(background) => background.progress(),
            None => (0, self.settings().evolution.population),
        }
    }

    /// Hash of the run, once it is finished.
    pub fn run_hash(&self) -> Option<u64> {
        self.run_hash
    }

    /// The best of a generation; the first generation is 1.
    pub fn champion_of(&self, generation: u32) -> Option<&Champion> {
        let index = (generation as usize).checked_sub(1)?;
        self.reports.get(index)?.champion.as_ref()
    }

    /// Evolves until held or finished. After the end of a run it begins the next one.
    pub fn start(&mut self) -> Result<(), String> {
        self.begin_next_if_over();
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

    /// Starts another run, with the next seed if nothing else differs. The current one can be resumed later.
    pub fn begin_next(&mut self) -> Result<(), String> {
        if self.next_run_differs() || self.is_under_way() {
            self.prepare_another();
        }
        self.start()
    }

    /// Prepares the next run. If its plan is that of the current run, the current run is discarded and starts again; a
    /// different run that was stopped earlier is resumed.
    pub fn reset(&mut self) -> Result<(), String> {
        // A run whose settings changed midway differs from one started with the final settings.
        if self.source.plan != self.plan_next {
            self.prepare_next();
        } else {
            self.discarded = Some(self.source.folder.clone());
            self.replace(RunSource { earlier: ExistingRun::Discard, ..self.source.clone() });
        }
        Ok(())
    }

    /// Makes the next run the current one, without starting it.
    fn prepare_next(&mut self) {
        let plan = self.plan_next.clone();
        let mut source = RunSource::in_saves(&self.context.saves, plan, ExistingRun::Keep);
        // A reset still holds after switching settings back and forth.
        if self.discarded.as_ref() == Some(&source.folder) {
            source.earlier = ExistingRun::Discard;
        }
        self.replace(source);
    }

    /// Replaces the current run, which stops in the background.
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
        if self.others.runs().is_some() {
            // The list may be visible, and the replaced run belongs in it. After a failure, it is listed again on
            // request.
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

    /// Goes on with a run that was stopped; the current one can be gone on with later.
    pub fn go_on_with(&mut self, folder: &Path) -> Result<(), String> {
        let source = RunSource::in_folder(folder).map_err(|error| error.to_string())?;
        self.plan_next = source.plan.clone();
        self.replace(source);
        self.start()
    }

    /// Lends stage and settings to a lesson, or takes them back. Meanwhile the current run ignores edits of settings.
    pub fn lend(&mut self, is_lent: bool) {
        self.is_lent = is_lent;
    }

    /// Whether a lesson has the stage and the settings.
    pub fn is_lent(&self) -> bool {
        self.is_lent
    }

    /// Whether the current run will pause after its current generation.
    pub fn is_single_generation(&self) -> bool {
        self.background.as_ref().is_some_and(BackgroundRun::is_single_generation)
    }

    fn take_over_if_ready(&mut self) -> Result<(), String> {
        if self.status() == RunStatus::Ready {
            self.prepare_next();
        }
        Ok(())
    }

    /// After a finished run, prepares the next one: the plan set meanwhile, or the next seed.
    fn begin_next_if_over(&mut self) {
        if self.status() == RunStatus::Finished {
            self.prepare_another();
        }
    }

    /// Prepares a run that differs from the current one: with the next seed if nothing else differs.
    fn prepare_another(&mut self) {
        if !self.next_run_differs() {
            self.plan_next.seed = self.plan_next.seed.wrapping_add(1);
        }
        self.prepare_next();
    }

    /// The run's background thread; started on first use.
    fn background(&mut self) -> Result<&BackgroundRun, String> {
        let background = match self.background.take() {
            Some(background) => background,
            None => {
                let source = self.source.clone();
                let evaluator = self.evaluator();
                self.context.set_run_folder(Some(source.folder.clone()));
                BackgroundRun::start(source, evaluator, self.before.take())
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
    bodies_run, climber, compared_run, explored_run, landed_run, prepared_run, small_run,
    species_run,
};
