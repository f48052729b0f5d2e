//! Files outside the library: the answers of file dialogs, recent files, and the file manager and the clipboard.
//! Nothing blocks the window.

mod clipboard;
mod dialog;
mod portal;
mod recent;

use std::path::{Path, PathBuf};

use bevy::ecs::system::NonSendMarker;
use bevy::prelude::*;

use super::lessons::write_worksheet;
use super::library::Library;
use super::new_file::offer_path;
use super::undo::UndoHistory;
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, WindowCommand};
use crate::studio::schedule::FrameSet;
use crate::studio::stage::Show;
use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::run_of_plan;
use snakes_lab::run::BackgroundTask;

use clipboard::{Copied, CopyTask};
use dialog::DialogAnswer;
pub(crate) use recent::RecentFiles;

/// State of file dialogs, recent files, file manager and clipboard.
#[derive(Resource, Default)]
pub(crate) struct Files {
    /// Files that were opened or imported recently.
    pub recent: RecentFiles,
    /// Question for the next file dialog.
    wanted: Option<FileQuestion>,
    /// Question that no dialog can ask, and the reason; the library panel asks it instead.
    unasked: Option<(FileQuestion, String)>,
    /// Question of the open file dialog, and its answer in the background.
    asked: Option<(FileQuestion, BackgroundTask<DialogAnswer>)>,
    /// Folders and pages that other programs are opening, and the results in the background.
    opening: Vec<BackgroundTask<Result<(), String>>>,
    copying: CopyTask,
}

/// Reason for asking for a path in the window when a dialog is already open.
const OPEN_ALREADY: &str = "Another dialog for files is open, perhaps behind this window. You can also type the path here.";

/// Subject of messages about copies to the clipboard.
const COPIED: &str = "copied";

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Files>()
        .add_systems(Update, take_in.in_set(FrameSet::TakeIn))
        .add_systems(Update, ask.after(FrameSet::Apply));
}

/// Opens the requested file dialog. On macOS this is only possible on the main thread.
fn ask(_main_thread: NonSendMarker, mut files: ResMut<Files>, mut notices: ResMut<Notices>) {
    let Some(question) = files.wanted.take() else { return };
    match dialog::ask(&question) {
        Ok(task) => files.asked = Some((question, task)),
        Err(error) => notices.problem(format!("The dialog could not be opened: {error}")),
    }
}

fn take_in(
    mut files: ResMut<Files>,
    mut library: ResMut<Library>,
    mut notices: ResMut<Notices>,
    mut send: MessageWriter<Command>,
) {
    // The library is accessed mutably only if there is an answer, because other systems react to its changes.
    if let Some((question, answer)) = files.answered() {
        send.write_batch(answer_to(question, answer, &mut library));
    }
    if let Some((question, reason)) = files.unasked.take() {
        send.write_batch(answer_to(question, Err(reason), &mut library));
    }
    files.report(&mut notices);
}

/// Returns the commands that follow from a dialog's answer; none if the dialog was cancelled.
fn answer_to(question: FileQuestion, answer: DialogAnswer, library: &mut Library) -> Vec<Command> {
    match answer {
        Ok(paths) if paths.is_empty() => Vec::new(),
        Ok(paths) => vec![Command::File(FileCommand::Answer(question, paths))],
        Err(reason) => {
            library.ask_in_panel(question, reason);
            vec![Command::Window(WindowCommand::OpenPanel(PanelKind::Library))]
        }
    }
}

impl Files {
    /// Executes a command. Returns the champions to show on the stage, if any.
    ///
    /// The command cannot be executed, for the returned reason.
    pub fn apply(
        &mut self,
        command: &FileCommand,
        library: &mut Library,
        history: &mut UndoHistory,
        notices: &mut Notices,
    ) -> Result<Option<Show>, String> {
        match command {
            // The open dialog may be hidden behind a window or may never return.
            FileCommand::Ask(question) if self.asked.is_some() => {
                self.unasked = Some((question.clone(), OPEN_ALREADY.to_owned()));
            }
            FileCommand::Ask(question) => self.wanted = Some(question.clone()),
            FileCommand::AskExport => library.export_requests += 1,
            FileCommand::Answer(question, paths) => {
                let request = request(question, paths);
                let done = request.map(|request| library.apply(&request, history, notices));
                self.recent.note(question, paths);
                return done.unwrap_or(Ok(None));
            }
            FileCommand::OpenFolder(folder) => self.open(folder)?,
            FileCommand::PrintWorksheet(lesson) => {
                let path = write_worksheet(&library.saves, *lesson)?;
                let text = format!("{} opens in the browser, which prints it.", path.display());
                offer_path(notices, "worksheet", text, &path);
                self.open(&path)?;
            }
            FileCommand::ShowSaves => {
                library.saves.prepare()?;
                self.open(library.saves.path())?;
            }
            FileCommand::CopyPicture(path) => self.copying.start(Copied::Picture(path.clone()))?,
            FileCommand::CopyPath(path) => self.copying.start(Copied::Path(path.clone()))?,
        }
        Ok(None)
    }

    /// Opens a folder or a page with the program of the operating system for it.
    fn open(&mut self, path: &Path) -> Result<(), String> {
        let path = path.to_owned();
        let task = BackgroundTask::start(move || dialog::open(&path));
        self.opening.push(task.map_err(|error| format!("No program can be started: {error}"))?);
        Ok(())
    }

    /// Returns the question and the answer of a dialog that was closed.
    fn answered(&mut self) -> Option<(FileQuestion, DialogAnswer)> {
        let answer = self.asked.as_ref()?.1.poll()?;
        let (question, _) = self.asked.take()?;
        Some((question, answer.flatten()))
    }

    /// Shows messages about the results of the file manager and the clipboard.
    fn report(&mut self, notices: &mut Notices) {
        self.opening.retain(|task| match task.poll() {
            None => true,
            Some(opened) => {
                notices.problems(opened.flatten().err());
                false
            }
        });
        match self.copying.poll() {
            None => {}
            Some((copied, Ok(()))) => {
                let what = if matches!(copied, Copied::Path(_)) { "path" } else { "picture" };
                notices.update(COPIED, format!("The {what} is in the clipboard."));
            }
            Some((Copied::Picture(path), Err(reason))) => notices.offer(
                COPIED,
                format!("The picture could not be copied: {reason}."),
                [("Copy path", Command::File(FileCommand::CopyPath(path)))],
            ),
            Some((Copied::Path(path), Err(reason))) => {
                notices.problem(format!("{}: could not be copied: {reason}", path.display()));
            }
        }
    }
}

/// Returns the command to the library for the paths that answer a question, if there is one.
fn request(question: &FileQuestion, paths: &[PathBuf]) -> Option<LibraryCommand> {
    let first = paths.first()?;
    Some(match question {
        FileQuestion::Open => LibraryCommand::Replay(run_of_plan(first)),
        FileQuestion::Import => LibraryCommand::Import(paths.to_vec()),
        // A file to share is not written by the library.
        FileQuestion::Share(..) => return None,
        FileQuestion::Export(places) => {
            LibraryCommand::Export { places: places.clone(), to: Some(first.clone()) }
        }
    })
}

#[cfg(test)]
mod tests;
