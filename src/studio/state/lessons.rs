//! Guided experiments. A lesson borrows the stage and the next run's settings, and restores them at its end. The
//! current run is paused meanwhile.

mod catalogue;
mod found;
mod lesson;
mod plays;
mod prediction;
mod printed;
#[cfg(test)]
mod worksheets;

use std::collections::BTreeSet;

use bevy::prelude::*;

use super::current_run::{CurrentRun, RunStatus};
use super::undo::UndoHistory;
use crate::studio::commands::LessonCommand;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, end_s};
use crate::studio::ui::notifications::Notices;
use snakes_core::evolve::RunPlan;
use snakes_lab::run::{ParallelRuns, ParallelRunsEvent};

use catalogue::{champions, plan};
use lesson::Shows;

pub(crate) use catalogue::LESSONS;
pub(crate) use found::Found;
pub(crate) use lesson::LessonScene;
pub(crate) use plays::Plays;
pub(crate) use prediction::{Asks, Progress};
pub(crate) use printed::write_worksheet;

/// The lessons, of which at most one is open.
#[derive(Resource, Debug, Default)]
pub(crate) struct Lessons {
    current: Option<Current>,
    /// Present titles of the lessons whose conclusion was reached.
    pub finished: BTreeSet<String>,
}

/// State of the open lesson.
#[derive(Debug)]
struct Current {
    /// Index of the lesson.
    index: usize,
    /// Index of the selected scene.
    scene: usize,
    /// Guess and results of each scene, which are kept while other scenes or panels are shown.
    progress: Vec<Progress>,
    /// Runs of the selected scene that are in progress.
    under_way: Option<ParallelRuns>,
    own: Own,
}

/// The user's own state, which is restored after the lesson.
#[derive(Debug)]
struct Own {
    next: RunPlan,
    history: UndoHistory,
    /// Method that lets the current run go on as before the lesson; `None` if it did not run.
    go_on: Option<Resumption>,
}

/// Method that lets a paused run go on.
type Resumption = fn(&mut CurrentRun) -> Result<(), String>;

/// State of the open lesson, for its panel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LessonView<'l> {
    /// Index of the lesson.
    pub index: usize,
    /// Index of the selected scene.
    pub scene: usize,
    /// Guess and results of the selected scene.
    pub progress: &'l Progress,
    /// Whether runs of the lesson are in progress.
    pub is_busy: bool,
    /// Whether the conclusion may be shown, because the results of all the lesson's experiments have been shown.
    pub shows_conclusion: bool,
}

impl Lessons {
    /// Returns the state of the open lesson, if any.
    pub fn view(&self) -> Option<LessonView<'_>> {
        let current = self.current.as_ref()?;
        // A scene with the snake alone has no question and is no experiment.
        let scenes = LESSONS[current.index].scenes.iter().zip(&current.progress);
        let mut experiments = scenes.filter(|(scene, _)| scene.question.is_some());
        let are_revealed = experiments.all(|(_, of)| of.is_revealed);
        Some(LessonView {
            index: current.index,
            scene: current.scene,
            progress: current.progress(),
            is_busy: current.under_way.is_some(),
            shows_conclusion: are_revealed && current.under_way.is_none(),
        })
    }

    /// Returns whether the result of the selected scene must be hidden: it answers the scene's question, and the
    /// experiment has not been watched to its end.
    pub fn hides_result(&self) -> bool {
        self.current.as_ref().is_some_and(|current| {
            current.scene().question.is_some() && !current.progress().is_revealed
        })
    }

    /// Returns whether the selected scene has a question and its experiment has not begun.
    pub fn awaits_guess(&self) -> bool {
        let has_begun = self.view().is_none_or(|view| view.progress.has_begun);
        self.hides_result() && !has_begun
    }

    /// Executes a command. Returns what to show on the stage, if anything.
    ///
    /// # Errors
    /// There is no such lesson, or its champions or runs cannot be prepared.
    pub fn apply(
        &mut self,
        command: &LessonCommand,
        run: &mut CurrentRun,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        match command {
            LessonCommand::Begin(index) => self.begin(*index, run, history),
            LessonCommand::ShowScene(scene) => self.show(*scene),
            LessonCommand::Guess(answer) => self.try_it(Some(*answer)),
            LessonCommand::Watch => self.try_it(None),
            LessonCommand::ShowResult => {
                if self.view().is_some_and(|view| view.progress.guess.is_some()) {
                    self.reveal();
                }
                Ok(None)
            }
            LessonCommand::Leave => self.leave(run, history).map(|()| None),
        }
    }

    /// Begins a lesson.
    pub fn begin(
        &mut self,
        index: usize,
        run: &mut CurrentRun,
        history: &mut UndoHistory,
    ) -> Result<Option<Show>, String> {
        if index >= LESSONS.len() {
            return Err(format!("There are {} lessons.", LESSONS.len()));
        }
        let own = match self.current.take() {
            // If a lesson follows another one, the state from before the first lesson is kept.
            Some(before) => {
                // The undo steps of the previous lesson do not apply to this lesson.
                history.give_back(UndoHistory::default());
                before.own
            }
            None => {
                let is_single = run.is_single_generation();
                let go_on: Resumption =
                    if is_single { CurrentRun::single_generation } else { CurrentRun::start };
                let go_on = (run.status() == RunStatus::Running).then_some(go_on);
                run.pause()?;
                run.is_lent = true;
                let (next, history) = (run.plan_next.clone(), std::mem::take(history));
                Own { next, history, go_on }
            }
        };
        run.set_next_plan(own.next.clone())?;
        self.current = Some(Current {
            index,
            scene: 0,
            progress: LESSONS[index].scenes.iter().map(|_| Progress::default()).collect(),
            under_way: None,
            own,
        });
        self.show(0)
    }

    /// Begins the experiment of the selected scene, with or without a guess. A first guess cannot be changed.
    fn try_it(&mut self, guess: Option<usize>) -> Result<Option<Show>, String> {
        let Some(current) = &mut self.current else { return Ok(None) };
        let (number, answers) = (current.scene, current.scene().answers().len());
        let progress = &mut current.progress[number];
        if progress.has_begun {
            return Ok(None);
        }
        progress.guess = guess.filter(|answer| *answer < answers);
        progress.has_begun = true;
        self.show(number)
    }

    /// Shows the result of the selected scene, if it is known.
    fn reveal(&mut self) {
        if let Some(current) = &mut self.current
            && current.under_way.is_none()
            && let question = &current.scene().question
            && let progress = &mut current.progress[current.scene]
            && question.as_ref().is_none_or(|question| progress.knows_result(question))
        {
            progress.is_revealed = true;
        }
    }

    /// Ends the lesson, and restores the settings and the run.
    pub fn leave(&mut self, run: &mut CurrentRun, history: &mut UndoHistory) -> Result<(), String> {
        let Some(Current { own, .. }) = self.current.take() else { return Ok(()) };
        run.set_next_plan(own.next)?;
        run.is_lent = false;
        history.give_back(own.history);
        own.go_on.filter(|_| run.status() == RunStatus::Paused).map_or(Ok(()), |go_on| go_on(run))
    }

    /// Selects a scene and shows its snakes. Its runs start after the reader has guessed.
    fn show(&mut self, number: usize) -> Result<Option<Show>, String> {
        let Some(current) = &mut self.current else { return Ok(None) };
        let Some(scene) = LESSONS[current.index].scenes.get(number) else { return Ok(None) };
        (current.scene, current.under_way) = (number, None);
        let progress = &mut current.progress[number];
        match &scene.shows {
            Shows::Champion(champion) => {
                let champions = champions(champion, scene.sides)?;
                progress.trial = champions.first().map(|staged| staged.trial().clone());
                if progress.lanes.is_empty() {
                    progress.lanes = champions
                        .iter()
                        .map(|staged| (staged.label().to_owned(), staged.shown_result()))
                        .collect();
                }
                Ok(Some(Show::race(champions)))
            }
            // Runs that are finished are not repeated.
            Shows::Runs(_) if progress.is_revealed => Ok(progress.race()),
            Shows::Runs(_) if !progress.has_begun => Ok(None),
            Shows::Runs(common) => {
                let plans = scene.sides.iter().map(|side| plan(common, side));
                let plans = plans.collect::<Result<Vec<_>, _>>()?;
                progress.runs = scene.sides.iter().map(|side| Found::of(side.name)).collect();
                let started = ParallelRuns::start(plans);
                current.under_way = Some(
                    started.map_err(|error| format!("The runs could not be started: {error}"))?,
                );
                Ok(None)
            }
        }
    }

    /// Handles events of the lesson's runs. When all are finished, returns the best champion of each run, to race them.
    fn take_in(&mut self) -> Result<Option<Show>, String> {
        let Some(current) = &mut self.current else { return Ok(None) };
        let progress = &mut current.progress[current.scene];
        while let Some(event) = current.under_way.as_ref().and_then(ParallelRuns::poll) {
            match event {
                ParallelRunsEvent::Generation { run, report } => {
                    progress.runs[run].reports.push(*report)
                }
                ParallelRunsEvent::Finished { run, run_hash } => {
                    progress.runs[run].run_hash = Some(run_hash)
                }
                ParallelRunsEvent::Failed(problem) => {
                    current.under_way = None;
                    // The reader can begin the experiment again.
                    progress.has_begun = false;
                    return Err(format!("The lesson's runs failed: {problem}"));
                }
            }
        }
        let is_over = progress.runs.iter().all(|found| found.run_hash.is_some());
        if current.under_way.is_none() || !is_over {
            return Ok(None);
        }
        current.under_way = None;
        progress.is_revealed = true;
        Ok(progress.race())
    }

    /// Records the state of the playback, if the question of the selected scene is about playbacks.
    fn follow_playback(&mut self, playback: &Playback, lanes: &[&Lane]) {
        let Some(current) = &mut self.current else { return };
        let question = &current.scene().question;
        if question.as_ref().is_some_and(|question| question.asks == Asks::PlaybackSpeed) {
            current.progress[current.scene].plays.follow_stage(playback, lanes);
        }
    }

    /// Shows the result after the reader has watched the selected scene to its end. `ended` has the name of each lane
    /// that ended undisturbed; these must be the names of the scene's lanes.
    fn see(&mut self, ended: &[Option<&str>]) {
        let is_seen = self.current.as_ref().is_some_and(|current| {
            let shown = &current.progress().lanes;
            let names = shown.iter().map(|(name, _)| Some(name.as_str()));
            !shown.is_empty() && names.eq(ended.iter().copied())
        });
        if is_seen {
            self.reveal();
        }
    }
}

impl Current {
    /// Returns the selected scene of the lesson.
    fn scene(&self) -> &'static LessonScene {
        &LESSONS[self.index].scenes[self.scene]
    }

    fn progress(&self) -> &Progress {
        &self.progress[self.scene]
    }
}

impl Progress {
    /// Returns the best snakes of the finished runs, side by side.
    fn race(&self) -> Option<Show> {
        let best = self.runs.iter().filter_map(|found| {
            let champion = found.best()?;
            Some(StagedChampion::from_lesson(champion).named(found.name.clone()))
        });
        let champions: Vec<StagedChampion> = best.collect();
        (!champions.is_empty()).then(|| Show::race(champions))
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Lessons>().add_systems(FixedUpdate, take_in);
}

fn take_in(
    mut lessons: ResMut<Lessons>,
    lanes: Query<&Lane>,
    mut playback: ResMut<Playback>,
    mut show: MessageWriter<Show>,
    mut notices: ResMut<Notices>,
) {
    if lessons.current.is_none() {
        return;
    }
    let lanes: Vec<&Lane> = lanes.iter().sort_by_key::<&Lane, _>(|lane| lane.number).collect();
    lessons.follow_playback(&playback, &lanes);
    let is_seen = |lane: &Lane| lane.replay.is_over() && !lane.replay.is_disturbed();
    let names = lanes.iter().map(|lane| is_seen(lane).then(|| lane.staged.label()));
    let ended: Vec<Option<&str>> = names.collect();
    lessons.see(&ended);
    let reached = lessons.view().filter(|view| view.shows_conclusion);
    let finished = reached.map(|view| LESSONS[view.index].title.to_owned());
    lessons.finished.extend(finished);
    let end_s = end_s(lanes.iter().copied());
    let is_over = !lanes.is_empty() && lanes.iter().all(|lane| lane.replay.is_over());
    if is_over && playback.is_playing && playback.time_s() >= end_s {
        // The finish stays in sight until the reader plays again.
        playback.hold_at(end_s);
    }
    match lessons.take_in() {
        Ok(Some(shown)) => {
            playback.restart();
            show.write(shown);
        }
        Ok(None) => {}
        Err(problem) => notices.problem(problem),
    }
}

#[cfg(test)]
mod tests;
