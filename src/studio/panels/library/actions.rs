//! Actions on the selected saves, which buttons, the context menu and keys share.

use std::path::{Path, PathBuf};

use bevy_egui::egui::Key as Press;

use crate::studio::commands::library::LibraryCommand;
use crate::studio::commands::{Command, PlanCommand, RunCommand};
use crate::studio::stage::MAX_LANES;
use crate::studio::state::library::{Library, LibraryItem};
use snakes_core::save::library::SavePlace;

/// An action on the selected saves.
#[derive(Debug)]
pub struct LibraryAction {
    /// Label of the action's button.
    pub name: &'static str,
    /// Tooltip of the action, with its shortcut.
    pub hint: &'static str,
    /// Shortcut of the action, if it has one.
    pub key: Option<Press>,
    /// Reason why the action is disabled, if it is.
    pub refusal: Option<&'static str>,
    /// Effect of the action.
    pub act: LibraryActionKind,
}

/// Effect of an action on the selected saves.
#[derive(Debug, Clone, PartialEq)]
pub enum LibraryActionKind {
    /// Send this command.
    Send(Command),
    /// Edit the name of this save in its row.
    Rename(SavePlace),
    /// Ask for the target folder, and export the selected saves.
    Export,
    /// Show or hide the champions of this run.
    ShowChampions(PathBuf),
}

const SELECT_ONE: Option<&str> = Some("Select a single save first");
const DAMAGED: Option<&str> = Some("This save cannot be read");
const NO_CHAMPION: Option<&str> = Some("The run has no champion yet");

/// Returns the actions for the selected saves, without those that cannot apply to them.
pub fn actions(library: &Library, chosen: &[&LibraryItem]) -> Vec<LibraryAction> {
    let Some(first) = chosen.first() else { return Vec::new() };
    let places: Vec<SavePlace> = chosen.iter().map(|item| item.place().clone()).collect();
    let replay_refusal = chosen.iter().find_map(|item| replay_refusal(item));
    let single = if chosen.len() == 1 { None } else { SELECT_ONE };
    let mut actions = vec![match chosen.len() {
        1 => LibraryAction {
            name: "Replay",
            hint: "Show it on the stage; for a run, its best snake (Enter or double-click)",
            key: Some(Press::Enter),
            refusal: replay_refusal,
            act: library_command(LibraryCommand::Replay(first.place().clone())),
        },
        several => LibraryAction {
            name: "Race",
            hint: "Replay them side by side; for a run, its best snake (Enter)",
            key: Some(Press::Enter),
            refusal: if several > MAX_LANES {
                Some("At most ten snakes fit on the stage")
            } else {
                replay_refusal
            },
            act: library_command(LibraryCommand::Race(places.clone())),
        },
    }];
    actions.push(LibraryAction {
        name: "New run from this",
        hint: "Start a run whose first generation descends from this snake",
        key: None,
        refusal: single.or(replay_refusal),
        act: LibraryActionKind::Send(Command::Plan(PlanCommand::StartFromSave(
            first.place().clone(),
        ))),
    });
    if places.iter().all(|place| place.run().is_none()) {
        let refusal = if places.len() > MAX_LANES {
            Some("At most ten champions can be examined at once")
        } else if places.iter().any(|place| place.path().is_none()) {
            Some("Built-in champions have their exams; duplicate it to examine it again")
        } else {
            replay_refusal
        };
        actions.push(LibraryAction {
            name: "Examine",
            hint: "Test each champion in some 300 other trials: other step rates, stairs, friction, and shoves. The \
                   results are stored in its file and shown in its details",
            key: None,
            refusal,
            act: library_command(LibraryCommand::Examine(places.clone())),
        });
    }
    if let (Some(folder), 1) = (first.place().run(), chosen.len()) {
        actions.extend(of_run(library, first, folder));
    }
    let has = |meant: fn(&SavePlace) -> bool| places.iter().any(meant);
    let has_run = has(|place| place.run().is_some());
    let has_shipped = has(|place| matches!(place, SavePlace::Shipped(_)));
    actions.extend([
        LibraryAction {
            name: "Rename",
            hint: if has_run {
                "Give it a name of your own; its folder keeps its name (F2)"
            } else {
                "Change the name (F2)"
            },
            key: Some(Press::F2),
            refusal: single
                .or(has_shipped
                    .then_some("A built-in champion cannot be renamed; duplicate it first")),
            act: LibraryActionKind::Rename(first.place().clone()),
        },
        LibraryAction {
            name: "Duplicate",
            hint: "Make a copy (Ctrl D)",
            key: Some(Press::D),
            refusal: has_run.then_some("Runs cannot be duplicated, but they can be exported"),
            act: library_command(LibraryCommand::Duplicate(places.clone())),
        },
        LibraryAction {
            name: "Export",
            hint: "Copy it to another folder",
            key: None,
            refusal: None,
            act: LibraryActionKind::Export,
        },
        LibraryAction {
            name: "Delete",
            hint: "Move it to the .deleted folder inside the saves folder; Ctrl Z restores it (Del)",
            key: Some(Press::Delete),
            refusal: has_shipped.then_some("Built-in champions cannot be deleted").or_else(|| {
                let goes_on = places.iter().any(|place| library.is_current(place));
                goes_on.then_some("This run is open in this window; start another one first")
            }),
            act: library_command(LibraryCommand::Delete(places)),
        },
    ]);
    actions
}

fn of_run(library: &Library, item: &LibraryItem, folder: &Path) -> [LibraryAction; 2] {
    let is_over = item.run().is_none_or(|run| run.ended.is_some());
    let refusal = if library.is_current(item.place()) {
        Some("This run is open in this window")
    } else if item.problem().is_some() {
        DAMAGED
    } else {
        is_over.then_some("This run cannot be continued; the reason is given below")
    };
    let has_none = item.run().is_some_and(|run| run.champions.is_empty());
    [
        LibraryAction {
            name: "Continue",
            hint: "Continue this run where it stopped; the current run stays saved",
            key: None,
            refusal,
            act: LibraryActionKind::Send(Command::Run(RunCommand::Continue(folder.to_owned()))),
        },
        LibraryAction {
            name: "Champions",
            hint: "List the best snake of each generation, to replay and race",
            key: None,
            refusal: if has_none { NO_CHAMPION } else { item.problem().and(DAMAGED) },
            act: LibraryActionKind::ShowChampions(folder.to_owned()),
        },
    ]
}

/// Returns the reason why a save cannot be shown on the stage, if there is one.
fn replay_refusal(item: &LibraryItem) -> Option<&'static str> {
    let has_none = item.run().is_some_and(|run| run.champions.is_empty());
    if has_none { NO_CHAMPION } else { item.problem().and(DAMAGED) }
}

fn library_command(command: LibraryCommand) -> LibraryActionKind {
    LibraryActionKind::Send(Command::Library(command))
}
