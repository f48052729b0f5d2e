//! Passes each command to the module that executes its group.

mod excursions;
pub mod stage;

use std::path::PathBuf;

use bevy::prelude::*;

use super::quit::QuitRequest;
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::modal::Modal;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::share::ShareCommand;
use crate::studio::commands::{
    BodyCommand, Command, ExamCommand, LessonCommand, PlanCommand, PlayerCommand, RunCommand,
    StageCommand, WindowCommand,
};
use crate::studio::panels::help::tour::highlighted_panel;
use crate::studio::scene::view_commands::ViewParams;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::state::body_editor::BodyEditor;
use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::state::files::Files;
use crate::studio::state::lessons::Lessons;
use crate::studio::state::library::Library;
use crate::studio::state::machines::MachinesLink;
use crate::studio::state::shares::{Shares, refuse_number};
use crate::studio::state::stairs_exams::StairsExams;
use crate::studio::state::undo::{UNDO_SUBJECT, UndoDirection, UndoHistory, UndoStep};
use crate::studio::ui::notifications::Notices;
use crate::studio::workspace::Workspace;

use stage::StageParams;

pub(crate) fn plugin(app: &mut App) {
    app.add_message::<Command>().add_systems(Update, apply.in_set(FrameSet::Apply));
}

/// Executes the commands in the order in which they were sent.
pub(super) fn apply(
    mut commands: MessageReader<Command>,
    mut run: ResMut<CurrentRun>,
    mut notices: ResMut<Notices>,
    mut history: ResMut<UndoHistory>,
    (opening, mut quit): (Res<OpeningChampions>, ResMut<QuitRequest>),
    mut workspace: ResMut<Workspace>,
    (mut lessons, mut exams, mut machines, mut shares): (
        ResMut<Lessons>,
        ResMut<StairsExams>,
        ResMut<MachinesLink>,
        ResMut<Shares>,
    ),
    (mut library, mut files, mut bodies): (ResMut<Library>, ResMut<Files>, ResMut<BodyEditor>),
    mut stage: StageParams,
    mut view: ViewParams,
) {
    let notices = &mut *notices;
    for command in commands.read() {
        let before = run.next_plan().clone();
        let left = stage.scene(command, &view.rig);
        let frames = |workspace: &Workspace, lessons: &Lessons| {
            [workspace.is_presenting(), lessons.view().is_some()]
        };
        let frames_before = frames(&workspace, &lessons);
        let done = match command {
            command if lessons.view().is_some() && changes_own_run(command) => {
                Err(LESSON.to_owned())
            }
            Command::Run(command) => {
                let is_other = replaces_run(command, &run);
                if is_other {
                    let takes_change = !matches!(command, RunCommand::Continue(_));
                    if let Some(change) = stage.settle().filter(|_| takes_change) {
                        notices
                            .info(format!("The new run has the change that was tried: {change}."));
                    }
                }
                run.apply(command, notices).inspect(|()| {
                    if is_other {
                        // Nothing leads from the new run back to the scenes of the one before.
                        stage.way_back.forget();
                    }
                })
            }
            Command::Plan(command) => {
                stage.apply_to_plan(command, &mut run, (&library, &opening), &history, notices)
            }
            Command::Stage(command) => {
                if matches!(command, StageCommand::TakeTurn(_)) {
                    workspace.end_black();
                }
                stage.apply(command, &run, &opening, notices)
            }
            Command::Player(command) => {
                stage.apply_to_player(command);
                Ok(())
            }
            Command::View(command) => {
                view.apply(command);
                Ok(())
            }
            Command::Window(command) => {
                if let WindowCommand::ToggleModal(Modal::Tour(step)) = command {
                    highlighted_panel(*step).into_iter().for_each(|kind| workspace.open(kind));
                    workspace.is_bare = false;
                }
                if let Some(news) = workspace.apply(command) {
                    notices.update("panel size", news.to_owned());
                }
                Ok(())
            }
            Command::Library(command) => library
                .apply(command, &mut history, notices)
                .map(|show| stage.present_others(show, notices)),
            Command::Share(ShareCommand::Ask(format)) => {
                // The number of champions is checked before the user chooses a file.
                refuse_number(*format, stage.champions_to_share().len()).and_then(|()| {
                    let question = FileQuestion::Share(*format, stage.name_for_file());
                    let ask = FileCommand::Ask(question);
                    files.apply(&ask, &mut library, &mut history, notices).map(drop)
                })
            }
            Command::Share(ShareCommand::Cancel) => shares.cancel(),
            Command::File(FileCommand::Answer(FileQuestion::Share(format, _), paths)) => {
                let path = paths.first().map(PathBuf::as_path);
                let begin =
                    |path| shares.begin(*format, path, &stage.champions_to_share(), &view.look());
                path.map_or(Ok(()), begin)
            }
            Command::File(command) => {
                if *command == FileCommand::AskExport {
                    workspace.open(PanelKind::Library);
                }
                files
                    .apply(command, &mut library, &mut history, notices)
                    .map(|show| stage.present_others(show, notices))
            }
            Command::Lesson(command) => {
                if matches!(command, LessonCommand::Begin(_)) {
                    workspace.open(PanelKind::Lessons);
                }
                let show = lessons.apply(command, &mut run, &mut history);
                show.map(|show| {
                    let is_new = show.is_some();
                    stage.present_for_now(show);
                    if is_new && lessons.awaits_guess() {
                        // The race is paused at its start until the user has made a guess.
                        stage.apply_to_player(&PlayerCommand::Toggle);
                    }
                })
            }
            Command::Exam(command) => {
                if *command == ExamCommand::Examine {
                    workspace.open(PanelKind::Senses);
                }
                let show = exams.apply(command, stage.selected().as_ref());
                show.map(|show| stage.present_others(show, notices))
            }
            Command::Body(command) => {
                if *command == BodyCommand::Edit {
                    workspace.open(PanelKind::Body);
                }
                let show = bodies.apply(command, stage.selected().as_ref(), &mut run);
                show.map(|show| stage.present_others(show, notices))
            }
            Command::Machines(command) => machines.apply(command, &mut run),
            // A running batch operation is not in the history yet, so undo would revert an earlier step.
            Command::Undo | Command::Redo if let Some(busy) = library.busy() => Err(busy),
            Command::Undo | Command::Redo => {
                let way = match command {
                    Command::Undo => UndoDirection::Back,
                    _ => UndoDirection::Forth,
                };
                match history.take(way) {
                    Some(UndoStep::Plan(step)) => {
                        notices.update(UNDO_SUBJECT, step.message(way));
                        history.complete(way, Some(UndoStep::Plan(step.clone())), None);
                        stage.step(&mut run, &step, way, &history)
                    }
                    Some(UndoStep::Files { label, steps }) => {
                        library.step(way, label, steps, &mut history, notices)
                    }
                    None => {
                        notices.update(UNDO_SUBJECT, way.nothing().to_owned());
                        Ok(())
                    }
                }
            }
            Command::Notify(text) => {
                notices.info(text.clone());
                Ok(())
            }
            Command::Quit => {
                quit.0 = true;
                Ok(())
            }
        };
        let frames = (frames_before, frames(&workspace, &lessons));
        stage.finish(command, left, frames, &mut view.rig);
        history.note(command, before, run.next_plan());
        notices.refusal(done.err());
    }
}

/// Returns whether a command replaces the current run by another one.
fn replaces_run(command: &RunCommand, run: &CurrentRun) -> bool {
    match command {
        RunCommand::Start => run.status() == RunStatus::Finished,
        RunCommand::New | RunCommand::Reset | RunCommand::Continue(_) => true,
        _ => false,
    }
}

/// Message for commands that would change the user's own run during a lesson.
const LESSON: &str =
    "A lesson is open and your own run is paused: \"Back to my own run\" ends the lesson.";

/// Returns whether a command would start or change the user's own run.
fn changes_own_run(command: &Command) -> bool {
    matches!(
        command,
        Command::Run(
            RunCommand::Start
                | RunCommand::SingleGeneration
                | RunCommand::New
                | RunCommand::Reset
                | RunCommand::Continue(_)
        ) | Command::Body(BodyCommand::Evolve)
            | Command::Plan(
                PlanCommand::StartFrom(_)
                    | PlanCommand::StartFromSave(_)
                    | PlanCommand::ForgetFounder
                    | PlanCommand::SetSeed(_)
            )
    )
}

#[cfg(test)]
mod tests;
