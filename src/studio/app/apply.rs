//! Passes each command to the module that executes its group.

mod excursions;
pub mod stage;

use std::collections::VecDeque;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::quit::QuitRequest;
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::commands::modal::Modal;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{
    BodyCommand, Command, ExamCommand, LessonCommand, PlanCommand, PlayerCommand, RunCommand,
    ShareCommand, StageCommand, WindowCommand,
};
use crate::studio::panels::help::tour::highlighted_panel;
use crate::studio::panels::quit_question::unfinished;
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

/// Executes the commands in the order in which they were sent. After a command that changes what is on the stage, the others wait for the
/// next frame, because lanes come and go only between two systems.
pub(super) fn apply(
    mut commands: MessageReader<Command>,
    mut waiting: Local<VecDeque<Command>>,
    mut studio: StudioParams,
) {
    waiting.extend(commands.read().cloned());
    while let Some(command) = &waiting.pop_front() {
        let before = studio.run.plan_next.clone();
        let left = studio.stage.scene(&studio.view.rig);
        let frames = studio.frames();
        let done = studio.execute(command);
        let frames = (frames, studio.frames());
        let is_other = studio.stage.finish(command, left, frames, &mut studio.view.rig);
        studio.history.note(command, before, &studio.run.plan_next);
        studio.notices.refusal(done.err());
        if is_other {
            break;
        }
    }
}

/// System parameters of everything that commands change.
#[derive(SystemParam)]
pub(super) struct StudioParams<'w, 's> {
    run: ResMut<'w, CurrentRun>,
    notices: ResMut<'w, Notices>,
    history: ResMut<'w, UndoHistory>,
    opening: Res<'w, OpeningChampions>,
    quit: ResMut<'w, QuitRequest>,
    workspace: ResMut<'w, Workspace>,
    lessons: ResMut<'w, Lessons>,
    exams: ResMut<'w, StairsExams>,
    machines: ResMut<'w, MachinesLink>,
    shares: ResMut<'w, Shares>,
    library: ResMut<'w, Library>,
    files: ResMut<'w, Files>,
    bodies: ResMut<'w, BodyEditor>,
    stage: StageParams<'w, 's>,
    view: ViewParams<'w>,
}

impl StudioParams<'_, '_> {
    /// Returns whether a presentation and a lesson are open.
    fn frames(&self) -> [bool; 2] {
        [self.workspace.is_presenting, self.lessons.view().is_some()]
    }

    /// Executes a command. The error is a sentence for the user.
    fn execute(&mut self, command: &Command) -> Result<(), String> {
        if self.lessons.view().is_some() && changes_own_run(command) {
            return Err(LESSON.to_owned());
        }
        let Self { run, notices, history, opening, workspace, library, stage, .. } = self;
        match command {
            Command::Run(command) => {
                // Whether another run replaces the current one.
                let is_other = match command {
                    RunCommand::Start => run.status() == RunStatus::Finished,
                    RunCommand::New | RunCommand::Reset | RunCommand::Continue(_) => true,
                    _ => false,
                };
                let change = if is_other { stage.settle() } else { None };
                if let Some(change) = change.filter(|_| !matches!(command, RunCommand::Continue(_)))
                {
                    notices.info(format!("The new run has the change that was tried: {change}."));
                }
                run.apply(command, notices)?;
                if is_other {
                    // Nothing leads from the new run back to the scenes of the one before.
                    stage.way_back.forget();
                }
            }
            Command::Plan(command) => {
                stage.apply_to_plan(command, run, (library, opening), history, notices)?;
            }
            Command::Stage(command) => {
                if matches!(command, StageCommand::TakeTurn(_)) {
                    workspace.is_black = false;
                }
                stage.apply(command, run, opening, notices)?;
            }
            Command::Player(command) => stage.apply_to_player(command),
            Command::View(command) => self.view.apply(command),
            Command::Window(command) => {
                if let WindowCommand::ToggleModal(Modal::Tour(step)) = command {
                    highlighted_panel(*step).into_iter().for_each(|kind| workspace.open(kind));
                    workspace.is_bare = false;
                }
                if let Some(news) = workspace.apply(command) {
                    notices.update("panel size", news.to_owned());
                }
            }
            Command::Library(LibraryCommand::SaveSnake) | Command::Body(BodyCommand::Save) => {
                let staged = match command {
                    Command::Body(_) => self.bodies.to_save()?,
                    _ => stage.selected().ok_or("There is no snake on the stage.")?,
                };
                library.save(&staged)?;
                self.bodies.note_saved(&staged);
            }
            Command::Library(command) => {
                stage.present_others(library.apply(command, history, notices)?, notices);
            }
            Command::Share(ShareCommand::Ask(format, size)) => {
                // The number of champions is checked before the user chooses a file.
                let champions = stage.champions_to_share();
                refuse_number(*format, champions.len())?;
                let number = self.shares.ask(champions, self.view.look(), *size);
                let name = stage.name_for_file();
                let ask = FileCommand::Ask(FileQuestion::Share(*format, name, number));
                self.files.apply(&ask, library, history, notices)?;
            }
            Command::Share(ShareCommand::Cancel) => self.shares.cancel()?,
            Command::File(FileCommand::Answer(FileQuestion::Share(format, _, number), paths)) => {
                if let Some(path) = paths.first() {
                    self.shares.begin_asked(*format, path, *number)?;
                }
            }
            Command::File(command) => {
                if *command == FileCommand::AskExport {
                    workspace.open(PanelKind::Library);
                }
                let show = self.files.apply(command, library, history, notices)?;
                stage.present_others(show, notices);
            }
            Command::Lesson(command) => {
                if matches!(command, LessonCommand::Begin(_)) {
                    workspace.open(PanelKind::Lessons);
                }
                let show = self.lessons.apply(command, run, history)?;
                let is_new = show.is_some();
                stage.present_for_now(show);
                if is_new && self.lessons.awaits_guess() {
                    // The race is paused at its start until the user has made a guess.
                    stage.apply_to_player(&PlayerCommand::Toggle);
                }
            }
            Command::Exam(command) => {
                if *command == ExamCommand::Examine {
                    workspace.open(PanelKind::Senses);
                }
                let show = self.exams.apply(command, stage.selected().as_ref())?;
                stage.present_others(show, notices);
            }
            Command::Body(command) => {
                if *command == BodyCommand::Edit {
                    workspace.open(PanelKind::Body);
                }
                let show = self.bodies.apply(command, stage.selected().as_ref(), run)?;
                stage.present_others(show, notices);
                if *command == BodyCommand::Evolve {
                    workspace.open(PanelKind::Run);
                    notices.info("A run started from the edited body. Its blocks evolve, too: there may be more or fewer soon.".to_owned());
                }
            }
            Command::Machines(command) => self.machines.apply(command, run)?,
            // A running batch operation is not in the history yet, so undo would revert an earlier step.
            Command::Undo | Command::Redo if let Some(busy) = library.busy() => return Err(busy),
            Command::Undo | Command::Redo => {
                let way = match command {
                    Command::Undo => UndoDirection::Back,
                    _ => UndoDirection::Forth,
                };
                match history.take(way) {
                    Some(UndoStep::Plan(step)) => {
                        notices.update(UNDO_SUBJECT, step.message(way));
                        history.complete(way, Some(UndoStep::Plan(step.clone())), None);
                        stage.step(run, &step, way, history)?;
                    }
                    Some(UndoStep::Files { label, steps }) => {
                        library.step(way, label, steps, history, notices)?;
                    }
                    None => notices.update(UNDO_SUBJECT, way.nothing().to_owned()),
                }
            }
            Command::Notify(text) => notices.info(text.clone()),
            Command::Quit => {
                let work = unfinished(&self.shares, &self.exams, &self.bodies, library);
                if work.is_empty() || workspace.modal() == Some(Modal::Quit) {
                    self.quit.0 = true;
                } else {
                    workspace.toggle_modal(Modal::Quit);
                }
            }
        }
        Ok(())
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
                | RunCommand::Extend
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
pub(super) mod tests;
