//! The experiment behind the window: started, held, reset; its reports kept for the panels.

mod compared_runs;
mod events;
mod individuals;
mod live_changes;
mod next_run;

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use bevy::prelude::*;

use super::chart_export;
use super::run_context::RunContext;
use crate::evolve::{Champion, RunPlan, Settings};
use crate::run::{BackgroundRun, Exploration, GenerationReport, RunSource};
use crate::save::{ExistingRun, RunSummary};
use crate::studio::commands::RunCommand;
use crate::studio::ui::notifications::Notices;

use individuals::Ancestors;

pub(crate) use compared_runs::{ComparedRuns, MOST_COMPARED};
pub(crate) use live_changes::news_of;

/// Of so many generations the best ten are remembered.
const REMEMBERED_GENERATIONS: usize = 200;

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RunStatus {
    /// Prepared, nothing evaluated yet.
    Ready,
    /// Evaluating.
    Running,
    /// Held.
    Paused,
    /// All generations are done.
    Finished,
}

/// The current run and what it found.
#[derive(Resource, Debug)]
pub(crate) struct CurrentRun {
    engine: RunContext,
    /// Which run of this session it is; the first is 0.
    number: u32,
    /// The current run as it began; the engine's plan is that of the next.
    source: RunSource,
    /// Its plan after all its changes.
    source_now: RunPlan,
    /// Its settings once those changes are made, too, that wait for its next generation.
    awaited: Settings,
    background: Option<BackgroundRun>,
    /// The run before, if it may still be ending.
    before: Option<BackgroundRun>,
    reports: Vec<GenerationReport>,
    /// What the run has found besides, once a generation is finished.
    exploration: Option<Box<Exploration>>,
    /// Everybody in it who has descendants, by place, once somebody is looked for.
    ancestors: OnceLock<Ancestors>,
    /// How often it was told what the run has found.
    times_explored: u64,
    /// Other runs, to be laid over this one.
    others: ComparedRuns,
    /// The best ten of each of the latest generations of this session, the earliest first.
    leaders: VecDeque<Vec<Champion>>,
    run_hash: Option<u64>,
    /// Whether a lesson has the stage and the settings: see [`Self::lend`].
    is_lent: bool,
    /// Whether the next run's settings are set for the run under way, too, as far as they may change there: they are
    /// not if they came from another preset or another run.
    next_is_own: bool,
    /// The folder of a run that was reset: what is in it is thrown away when such a run begins.
    discarded: Option<PathBuf>,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<CurrentRun>().add_plugins(events::plugin);
}

impl FromWorld for CurrentRun {
    fn from_world(world: &mut World) -> Self {
        Self::new(world.resource::<RunContext>().clone())
    }
}

impl CurrentRun {
    /// The run the studio opens with, prepared.
    pub fn new(engine: RunContext) -> Self {
        Self::prepared(engine.first.clone(), engine)
    }

    /// A prepared run.
    fn prepared(source: RunSource, engine: RunContext) -> Self {
        Self {
            source_now: source.plan.clone(),
            awaited: source.plan.settings.clone(),
            source,
            engine,
            number: 0,
            background: None,
            before: None,
            reports: Vec::new(),
            exploration: None,
            ancestors: OnceLock::new(),
            times_explored: 0,
            others: ComparedRuns::default(),
            leaders: VecDeque::new(),
            run_hash: None,
            is_lent: false,
            next_is_own: true,
            discarded: None,
        }
    }

    /// Where the run stands.
    pub fn status(&self) -> RunStatus {
        match &self.background {
            _ if self.run_hash.is_some() => RunStatus::Finished,
            None => RunStatus::Ready,
            Some(background) if background.is_paused() => RunStatus::Paused,
            Some(_) => RunStatus::Running,
        }
    }

    /// How many evaluations the current run may cost, after all its changes.
    pub fn budget(&self) -> u64 {
        self.source_now.budget()
    }

    /// Which run of this session it is; the first is 0.
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
        &self.source_now.settings
    }

    /// Runs that were stopped before their end and can go on, once somebody has asked for runs.
    pub fn stopped(&self) -> Option<impl Iterator<Item = &RunSummary>> {
        let is_other = |run: &&RunSummary| run.is_stopped() && run.folder != self.source.folder;
        Some(self.others.runs()?.iter().filter(is_other))
    }

    /// Reports of the finished generations, the first generation first.
    pub fn reports(&self) -> &[GenerationReport] {
        &self.reports
    }

    /// What the run has found besides champions, once a generation is finished.
    pub fn exploration(&self) -> Option<&Exploration> {
        self.exploration.as_deref()
    }

    /// Another value whenever something that charts show has changed.
    pub fn version(&self) -> (u32, u64, usize, u64) {
        (self.number, self.times_explored, self.reports.len(), self.others.version())
    }

    /// Other runs, to be laid over this one.
    pub fn others(&self) -> &ComparedRuns {
        &self.others
    }

    /// The best ten of a generation, or of the latest one, the best first; nobody of one that an earlier session has
    /// finished, or of long ago.
    pub fn leaders(&self, generation: Option<u32>) -> &[Champion] {
        let is_it = |leaders: &&Vec<Champion>| match (generation, leaders.first()) {
            (None, _) => true,
            (Some(generation), Some(first)) => first.origin.generation == generation,
            (Some(_), None) => false,
        };
        self.leaders.iter().rev().find(is_it).map_or(&[], Vec::as_slice)
    }

    /// Takes in what was found besides champions.
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

    /// Finished evaluations of the current generation, and how many it has.
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

    /// Executes a command.
    ///
    /// # Errors
    /// The run, its folder or the system does not allow it, with the reason.
    pub fn apply(&mut self, command: &RunCommand, notices: &mut Notices) -> Result<(), String> {
        match command {
            RunCommand::Start => self.start(),
            RunCommand::Pause => self.pause(),
            RunCommand::SingleGeneration => self.single_generation(),
            RunCommand::Reset => self.reset(),
            RunCommand::Continue(folder) => self.go_on_with(folder),
            RunCommand::SetThreads(threads) => self.set_threads(*threads),
            RunCommand::ListRuns => self.list_runs(),
            RunCommand::Compare(folder) => self.others.toggle(folder),
            RunCommand::ExportChart(chart) => {
                let path = chart_export::export(&self.engine.saves, chart)?;
                notices.info(format!("Chart saved to {}", path.display()));
                Ok(())
            }
        }
    }

    /// Evolves until held or finished. After the end of a run it begins the next one.
    pub fn start(&mut self) -> Result<(), String> {
        self.begin_next_if_over();
        self.background()?.resume();
        Ok(())
    }

    /// Holds evolution.
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

    /// Begins another run now, with the next seed if nothing else differs; the current one can be gone on with later.
    pub fn begin_next(&mut self) -> Result<(), String> {
        if self.next_run_differs() || self.is_under_way() {
            self.prepare_another();
        }
        self.start()
    }

    /// Prepares the next run. The same run is thrown away, and begins anew; another, which was stopped at
    /// some time, will go on.
    pub fn reset(&mut self) -> Result<(), String> {
        // One that was changed on its way is another than one that begins with what it was changed to.
        if self.source.plan != self.engine.next {
            self.prepare_next();
        } else {
            self.discarded = Some(self.source.folder.clone());
            self.replace(RunSource { earlier: ExistingRun::Discard, ..self.source.clone() });
        }
        Ok(())
    }

    /// Prepares the next run.
    fn prepare_next(&mut self) {
        let plan = self.engine.next.clone();
        let mut source = RunSource::in_saves(&self.engine.saves, plan, ExistingRun::Keep);
        // Whoever has reset it means so even after having looked at other settings.
        if self.discarded.as_ref() == Some(&source.folder) {
            source.earlier = ExistingRun::Discard;
        }
        self.replace(source);
    }

    /// Puts another run in the place of the current one, which ends in the background.
    fn replace(&mut self, source: RunSource) {
        let before = self.background.take().or(self.before.take());
        *self = Self {
            number: self.number + 1,
            before,
            others: std::mem::take(&mut self.others),
            is_lent: self.is_lent,
            discarded: self.discarded.take(),
            ..Self::prepared(source, self.engine.clone())
        };
        if self.others.runs().is_some() {
            // Somebody may be looking at the list: the run that was replaced belongs into it. What cannot
            // be listed now is listed when it is asked for again.
            let _ = self.list_runs();
        }
    }

    /// Prepares the current run to go on with what is kept of it.
    fn open_again(&mut self) {
        self.engine.set_run_folder(None);
        self.replace(RunSource { earlier: ExistingRun::Keep, ..self.source.clone() });
        self.next_is_own = self.next_looks_own();
    }

    /// Looks for all runs in the folder of saves.
    pub fn list_runs(&mut self) -> Result<(), String> {
        self.others.list(self.engine.saves.clone())
    }

    /// Goes on with a run that was stopped; the current one can be gone on with later.
    pub fn go_on_with(&mut self, folder: &Path) -> Result<(), String> {
        let source = RunSource::in_folder(folder).map_err(|error| error.to_string())?;
        self.engine.next = source.plan.clone();
        self.replace(source);
        self.start()
    }

    /// Lends stage and settings to a lesson, or takes them back: meanwhile the run under way is changed by nothing.
    pub fn lend(&mut self, is_lent: bool) {
        self.is_lent = is_lent;
    }

    /// Whether the run under way will hold after its current generation.
    pub fn is_single_generation(&self) -> bool {
        self.background.as_ref().is_some_and(BackgroundRun::is_single_generation)
    }

    fn take_over_if_ready(&mut self) -> Result<(), String> {
        if self.status() == RunStatus::Ready {
            self.prepare_next();
        }
        Ok(())
    }

    /// After the end of a run the next one: what was asked for meanwhile, or the next seed.
    fn begin_next_if_over(&mut self) {
        if self.status() == RunStatus::Finished {
            self.prepare_another();
        }
    }

    /// Prepares a run that is not the current one once more: with the next seed, if nothing else differs.
    fn prepare_another(&mut self) {
        if !self.next_run_differs() {
            self.engine.next.seed = self.engine.next.seed.wrapping_add(1);
        }
        self.prepare_next();
    }

    /// The run's thread, started if it was not.
    fn background(&mut self) -> Result<&BackgroundRun, String> {
        let background = match self.background.take() {
            Some(background) => background,
            None => {
                let source = self.source.clone();
                let evaluator = Arc::clone(&self.engine.evaluator);
                self.engine.set_run_folder(Some(source.folder.clone()));
                BackgroundRun::start(source, evaluator, self.before.take())
                    .map_err(|error| format!("evolution could not be started: {error}"))?
            }
        };
        Ok(self.background.insert(background))
    }
}

#[cfg(test)]
mod fixtures;
#[cfg(test)]
pub(crate) use fixtures::{compared_run, explored_run, prepared_run};
