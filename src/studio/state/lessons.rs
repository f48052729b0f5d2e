//! Guided experiments. A lesson borrows the stage and the next run's settings and restores both at its end; the current
//! run is paused meanwhile.

mod catalogue;

use bevy::prelude::*;

use super::current_run::{CurrentRun, RunStatus};
use super::undo::UndoHistory;
use crate::evolve::{Champion, RunPlan};
use crate::run::{GenerationReport, ParallelRuns, ParallelRunsEvent};
use crate::score::{Evaluation, evaluate};
use crate::studio::commands::LessonCommand;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode};
use crate::studio::ui::notifications::Notices;

use catalogue::{LessonScene, Side, champions, plan};

pub(crate) use catalogue::LESSONS;

/// The current lesson, if any.
#[derive(Resource, Debug, Default)]
pub(crate) struct Lessons {
    current: Option<Current>,
}

/// State of the current lesson.
#[derive(Debug)]
struct Current {
    /// Index of the lesson.
    index: usize,
    /// Index of the scene on the stage.
    scene: usize,
    /// Name and result of each lane of the scene.
    lanes: Vec<(String, Evaluation)>,
    /// Results of the scene's runs.
    runs: Vec<Found>,
    under_way: Option<ParallelRuns>,
    has_tried: bool,
    own: Own,
}

/// Results of a lesson's run.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Name of the run.
    pub name: String,
    /// Reports of the finished generations.
    pub reports: Vec<GenerationReport>,
    /// Hash, once the run is finished.
    pub run_hash: Option<u64>,
}

/// State to restore after the lesson.
#[derive(Debug)]
struct Own {
    next: RunPlan,
    champions: Vec<StagedChampion>,
    mode: StageMode,
    history: UndoHistory,
    pace: Pace,
}

/// How the current run was advancing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pace {
    Running,
    OneGeneration,
    Held,
}

/// View of the current lesson for its panel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LessonView<'l> {
    /// Index of the lesson.
    pub index: usize,
    /// Index of the scene on the stage.
    pub scene: usize,
    /// Name and result of each lane.
    pub lanes: &'l [(String, Evaluation)],
    /// Results of the runs.
    pub runs: &'l [Found],
    /// Whether runs are in progress.
    pub is_busy: bool,
    /// Whether the user has tried something, so that the conclusion may be shown.
    pub has_tried: bool,
}

impl Lessons {
    /// The current lesson.
    pub fn view(&self) -> Option<LessonView<'_>> {
        self.current.as_ref().map(|current| LessonView {
            index: current.index,
            scene: current.scene,
            lanes: &current.lanes,
            runs: &current.runs,
            is_busy: current.under_way.is_some(),
            has_tried: current.has_tried,
        })
    }

    /// Executes a command; returns what the stage shows then. `on_show` is on it now, and returns after the lesson.
    ///
    /// # Errors
    /// There is no such lesson, or its champions or runs cannot be prepared.
    pub fn apply(
        &mut self,
        command: &LessonCommand,
        run: &mut CurrentRun,
        on_show: Show,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        match command {
            LessonCommand::Begin(index) => self.begin(*index, run, on_show, history),
            LessonCommand::ShowScene(scene) => {
                self.allow_answer();
                self.show(*scene)
            }
            LessonCommand::ShowAnswer => {
                self.allow_answer();
                Ok(None)
            }
            LessonCommand::Leave => self.leave(run, history),
        }
    }

    /// Begins a lesson; what is on the stage now comes back at its end.
    pub fn begin(
        &mut self,
        index: usize,
        run: &mut CurrentRun,
        Show { champions, mode }: Show,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        if index >= LESSONS.len() {
            return Err(format!("There are {} lessons.", LESSONS.len()));
        }
        let own = match self.current.take() {
            // From one lesson to the next: keep the state from before the first.
            Some(before) => {
                // Undo steps of the previous lesson do not apply to this one.
                history.give_back(UndoHistory::default());
                before.own
            }
            None => {
                let pace = match run.status() {
                    RunStatus::Running if run.is_single_generation() => Pace::OneGeneration,
                    RunStatus::Running => Pace::Running,
                    RunStatus::Ready | RunStatus::Paused | RunStatus::Finished => Pace::Held,
                };
                run.pause()?;
                run.lend(true);
                let (next, history) = (run.next_plan().clone(), history.lend());
                Own { next, champions, mode, history, pace }
            }
        };
        run.set_next_plan(own.next.clone())?;
        self.current = Some(Current {
            index,
            scene: 0,
            lanes: Vec::new(),
            runs: Vec::new(),
            under_way: None,
            has_tried: false,
            own,
        });
        self.show(0)
    }

    /// Shows the answer from now on.
    fn allow_answer(&mut self) {
        if let Some(current) = &mut self.current {
            current.has_tried = true;
        }
    }

    /// Ends the lesson and restores stage, settings and run.
    pub fn leave(
        &mut self,
        run: &mut CurrentRun,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        let Some(Current { own, .. }) = self.current.take() else { return Ok(None) };
        run.set_next_plan(own.next)?;
        run.lend(false);
        history.give_back(own.history);
        match own.pace {
            Pace::Running if run.status() == RunStatus::Paused => run.start()?,
            Pace::OneGeneration if run.status() == RunStatus::Paused => {
                run.single_generation()?;
            }
            Pace::Running | Pace::OneGeneration | Pace::Held => {}
        }
        Ok(Some(Show { champions: own.champions, mode: own.mode }))
    }

    /// Shows a scene, or starts its runs.
    fn show(&mut self, number: usize) -> Result<Option<Show>, String> {
        let Some(current) = &mut self.current else { return Ok(None) };
        let Some(scene) = LESSONS[current.index].scenes.get(number) else { return Ok(None) };
        (current.scene, current.under_way) = (number, None);
        match scene {
            LessonScene::Lanes { lanes, champion, .. } => {
                let champions = champions(champion, lanes)?;
                current.runs.clear();
                current.lanes = champions
                    .iter()
                    .map(|staged| {
                        let evaluation = evaluate(&staged.champion().genome, staged.trial());
                        (staged.label().to_owned(), evaluation)
                    })
                    .collect();
                Ok(Some(if champions.len() > 1 {
                    Show::race(champions)
                } else {
                    Show { champions, mode: StageMode::Solo }
                }))
            }
            LessonScene::Runs { runs, .. } => {
                let plans = runs.iter().map(plan).collect::<Result<Vec<_>, _>>()?;
                current.lanes.clear();
                current.runs = runs.iter().map(found).collect();
                let started = ParallelRuns::start(plans);
                current.under_way = Some(
                    started.map_err(|error| format!("The runs could not be started: {error}"))?,
                );
                Ok(None)
            }
        }
    }

    /// Handles events of the lesson's runs. Once all are finished, returns the best champion of each.
    fn take_in(&mut self) -> Result<Option<Show>, String> {
        let Some(current) = &mut self.current else { return Ok(None) };
        while let Some(event) = current.under_way.as_ref().and_then(ParallelRuns::poll) {
            match event {
                ParallelRunsEvent::Generation { run, report } => {
                    current.runs[run].reports.push(*report)
                }
                ParallelRunsEvent::Finished { run, run_hash } => {
                    current.runs[run].run_hash = Some(run_hash)
                }
                ParallelRunsEvent::Failed(problem) => {
                    current.under_way = None;
                    return Err(format!("The lesson's runs failed: {problem}"));
                }
            }
        }
        let is_over = current.runs.iter().all(|found| found.run_hash.is_some());
        if current.under_way.is_none() || !is_over {
            return Ok(None);
        }
        current.under_way = None;
        let best = current.runs.iter().filter_map(|found| {
            let champion = found.best()?;
            Some(StagedChampion::from_lesson(champion).named(found.name.clone()))
        });
        let champions: Vec<StagedChampion> = best.collect();
        Ok((!champions.is_empty()).then(|| Show::race(champions)))
    }
}

impl Found {
    /// The best champion so far.
    pub fn best(&self) -> Option<&Champion> {
        let champions = self.reports.iter().filter_map(|report| report.champion.as_ref());
        champions.max_by(|a, b| a.evaluation.fitness.total_cmp(&b.evaluation.fitness))
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Lessons>().add_systems(FixedUpdate, take_in);
}

fn take_in(
    mut lessons: ResMut<Lessons>,
    mut show: MessageWriter<Show>,
    mut notices: ResMut<Notices>,
) {
    if lessons.current.is_none() {
        return;
    }
    match lessons.take_in() {
        Ok(shown) => {
            show.write_batch(shown);
        }
        Err(problem) => notices.problem(problem),
    }
}

fn found(side: &Side) -> Found {
    Found { name: side.name.to_owned(), reports: Vec::new(), run_hash: None }
}

#[cfg(test)]
mod tests;
