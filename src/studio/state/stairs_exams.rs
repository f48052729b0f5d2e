//! Exams of champions on unseen stairs, simulated in the background, one at a time. The latest results are kept.
//!
//! An exam belongs to a genome and its own trial, independently of where and how the champion is shown.

use bevy::prelude::*;

use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, ExamCommand, WindowCommand};
use crate::studio::schedule::FrameSet;
use crate::studio::stage::Show;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::ui::notifications::Notices;
use snakes_core::evolve::Champion;
use snakes_core::score::{ExamEnd, ExamSuite, StairsCell, StairsGrid};
use snakes_lab::run::exam::{examine_on_stairs, stairs_trials};
use snakes_lab::run::{BackgroundTask, Cancelled, LocalPool, available_cores};

/// Finished exams, and the exam in progress.
#[derive(Resource, Debug, Default)]
pub(crate) struct StairsExams {
    /// Finished exams, the latest last.
    finished: Vec<(Champion, Vec<StairsGrid>)>,
    under_way: Option<ExamUnderWay>,
}

/// An exam that is being simulated. Dropping the value cancels the exam.
#[derive(Debug)]
struct ExamUnderWay {
    champion: Champion,
    name: String,
    work: BackgroundTask<Result<Vec<StairsGrid>, Cancelled>>,
}

/// Maximum number of champions whose exams are kept.
const MOST_KEPT: usize = 8;
/// Subject of messages about an exam, which replace each other.
const SUBJECT: &str = "exam on stairs";

impl Drop for ExamUnderWay {
    fn drop(&mut self) {
        self.work.cancel();
    }
}

impl StairsExams {
    /// Executes a command to the exam of the selected champion of the stage. Returns what to show on the stage, if anything.
    ///
    /// # Errors
    /// The command cannot be executed, for the returned reason.
    pub fn apply(
        &mut self,
        command: &ExamCommand,
        selected: Option<&StagedChampion>,
    ) -> Result<Option<Show>, String> {
        let selected = selected.ok_or("There is no snake on the stage.");
        match command {
            ExamCommand::Examine => self.examine(selected?)?,
            ExamCommand::Cancel => self.under_way.iter().for_each(|exam| exam.work.cancel()),
            ExamCommand::Watch { suite, cell } => {
                let selected = selected?;
                let mut grids = self.of(selected.champion()).unwrap_or_default().iter();
                let grid = grids.find(|grid| grid.suite == *suite);
                let cell = grid.and_then(|grid| grid.cells.get(*cell));
                // The selected champion may have changed since the click. Then nothing happens.
                let there = |cell: &StairsCell| {
                    selected.on_stairs_of_exam(&cell.typical, stairs_in_words(*suite, cell))
                };
                return Ok(cell.map(there).map(Show::solo));
            }
            ExamCommand::BackToOwnStairs => return Ok(Some(Show::solo(selected?.as_found()))),
        }
        Ok(None)
    }

    fn examine(&mut self, staged: &StagedChampion) -> Result<(), String> {
        if self.under_way.is_some() {
            return Err("An exam is in progress: wait for it, or cancel it.".to_owned());
        }
        no_exam_because(staged).map_or(Ok(()), Err)?;
        let champion = staged.champion().clone();
        if self.of(&champion).is_some() {
            return Ok(());
        }
        let failed = |error: &dyn std::fmt::Display| format!("The exam could not start: {error}.");
        // At least half of the processor remains for the run.
        let pool = LocalPool::new(available_cores().div_ceil(2)).map_err(|error| failed(&error))?;
        let examined = champion.clone();
        let trials = stairs_trials(&champion) as usize;
        let work = BackgroundTask::start_counted(trials, move |control| {
            examine_on_stairs(&examined, &pool, control)
        });
        let work = work.map_err(|error| failed(&error))?;
        let name = staged.name().to_owned();
        self.under_way = Some(ExamUnderWay { champion, name, work });
        Ok(())
    }

    /// Returns the finished exam of a champion, if any: on other stairs and, if the champion has senses, also without senses.
    pub fn of(&self, champion: &Champion) -> Option<&[StairsGrid]> {
        let mut finished = self.finished.iter();
        let is_it = |of: &Champion| of.genome == champion.genome && of.trial == champion.trial;
        finished.find(|(of, _)| is_it(of)).map(|(_, grids)| grids.as_slice())
    }

    /// Returns the champion's name in the exam that is being simulated, if any, and the numbers of its finished and of all
    /// its trials.
    pub fn progress(&self) -> Option<(&str, [usize; 2])> {
        let ExamUnderWay { name, work, .. } = self.under_way.as_ref()?;
        Some((name, [work.done().min(work.total()), work.total()]))
    }

    /// Processes the result of a finished exam.
    fn take_in(&mut self, notices: &mut Notices) {
        let Some(result) = self.under_way.as_ref().and_then(|exam| exam.work.poll()) else {
            return;
        };
        let Some(ended) = self.under_way.take() else { return };
        match result {
            Ok(Ok(grids)) => {
                let text = format!("Exam of {}: {}", ended.name, result_in_words(&grids));
                let open = Command::Window(WindowCommand::OpenPanel(PanelKind::Senses));
                notices.offer(SUBJECT, text, [("Show the exam", open)]);
                self.keep(ended.champion.clone(), grids);
            }
            Ok(Err(Cancelled)) => {
                notices.update(SUBJECT, "The exam was cancelled.".to_owned());
            }
            Err(problem) => notices.problem(format!("The exam ended with an error: {problem}")),
        }
    }

    /// Keeps a finished exam, and removes the oldest ones if there are too many.
    pub(in crate::studio) fn keep(&mut self, champion: Champion, grids: Vec<StairsGrid>) {
        self.finished.push((champion, grids));
        let too_many = self.finished.len().saturating_sub(MOST_KEPT);
        self.finished.drain(..too_many);
    }
}

/// Returns the reason why a champion cannot be examined, if there is one, in a sentence.
pub(crate) fn no_exam_because(staged: &StagedChampion) -> Option<String> {
    if let Some(engine) = staged.other_engine() {
        return Some(format!(
            "There is no exam of a snake of engine {engine}: it moves differently here."
        ));
    }
    let has_stairs = staged.champion().trial.stairs.steps > 0;
    (!has_stairs).then(|| "There is no exam in a world without stairs.".to_owned())
}

/// Describes the results of an exam in a sentence.
pub(crate) fn result_in_words(grids: &[StairsGrid]) -> String {
    let count = |suite| {
        let grid = grids.iter().find(|grid| grid.suite == suite)?;
        Some((grid.landed(), grid.trials()))
    };
    let (landed, trials) = count(ExamSuite::Stairs).unwrap_or_default();
    match count(ExamSuite::Lesion) {
        None => format!("it climbs {landed} of {trials} staircases."),
        Some((without, _)) => {
            format!("it climbs {landed} of {trials} staircases; without its senses, {without}.")
        }
    }
}

/// Describes in a few words how a trial of the exam ended.
pub(crate) fn end_in_words(end: &ExamEnd) -> String {
    match end.landed_s {
        _ if end.is_disqualified => end.ending.words(),
        Some(landed_s) if end.has_landed => format!("reaches the top after {landed_s:.1} s"),
        Some(landed_s) => format!("reaches the top after {landed_s:.1} s, but does not stay"),
        None => end.ending.words(),
    }
}

/// Describes the stairs of a cell: "rise 0.6 m, tread 1.5 m".
fn stairs_in_words(suite: ExamSuite, cell: &StairsCell) -> String {
    let StairsCell { rise_m, tread_m, .. } = cell;
    let frozen = if suite == ExamSuite::Lesion { ", without its senses" } else { "" };
    format!("rise {rise_m} m, tread {tread_m} m{frozen}")
}

fn take_in(mut exams: ResMut<StairsExams>, mut notices: ResMut<Notices>) {
    exams.take_in(&mut notices);
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<StairsExams>().add_systems(Update, take_in.in_set(FrameSet::TakeIn));
}

#[cfg(test)]
pub(crate) mod tests;
