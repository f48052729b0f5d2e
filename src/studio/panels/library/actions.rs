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

impl LibraryAction {
    fn new(name: &'static str, hint: &'static str, act: LibraryActionKind) -> Self {
        Self { name, hint, key: None, refusal: None, act }
    }

    fn command(name: &'static str, hint: &'static str, command: LibraryCommand) -> Self {
        Self::new(name, hint, LibraryActionKind::Send(Command::Library(command)))
    }

    fn key(self, key: Press) -> Self {
        Self { key: Some(key), ..self }
    }

    fn unless(self, refusal: Option<&'static str>) -> Self {
        Self { refusal, ..self }
    }
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
    let place = first.place().clone();
    let mut actions = vec![
        match chosen.len() {
            1 => {
                let hint =
                    "Show it on the stage; for a run, its best snake (Enter or double-click)";
                LibraryAction::command("Replay", hint, LibraryCommand::Replay(place.clone()))
                    .unless(replay_refusal)
            }
            several => {
                let hint = "Replay them side by side; for a run, its best snake (Enter)";
                let many = (several > MAX_LANES).then_some("At most ten snakes fit on the stage");
                LibraryAction::command("Race", hint, LibraryCommand::Race(places.clone()))
                    .unless(many.or(replay_refusal))
            }
        }
        .key(Press::Enter),
    ];
    let hint = "Start a run whose first generation descends from this snake";
    let start = LibraryActionKind::Send(Command::Plan(PlanCommand::StartFromSave(place.clone())));
    let start = LibraryAction::new("New run from this", hint, start);
    actions.push(start.unless(single.or(replay_refusal)));
    if places.iter().all(|place| place.run().is_none()) {
        let refusal = if places.len() > MAX_LANES {
            Some("At most ten champions can be examined at once")
        } else if places.iter().any(|place| place.path().is_none()) {
            Some("Built-in champions have their exams; duplicate it to examine it again")
        } else {
            replay_refusal
        };
        let hint = "Test each champion in some 300 other trials: other step rates, stairs, friction, and shoves. The \
                    results are stored in its file and shown in its details";
        let examine = LibraryCommand::Examine(places.clone());
        actions.push(LibraryAction::command("Examine", hint, examine).unless(refusal));
    }
    if let (Some(folder), 1) = (first.place().run(), chosen.len()) {
        actions.extend(of_run(library, first, folder));
    }
    let has = |meant: fn(&SavePlace) -> bool| places.iter().any(meant);
    let has_run = has(|place| place.run().is_some());
    let has_shipped = has(|place| matches!(place, SavePlace::Shipped(_)));
    let is_open = places.iter().any(|place| library.is_current(place));
    let kept = [
        has_shipped.then_some("Built-in champions cannot be deleted"),
        is_open.then_some("This run is open in this window; start another one first"),
    ];
    let fixed = "A built-in champion cannot be renamed; duplicate it first";
    let rename_hint = match has_run {
        true => "Give it a name of your own; its folder keeps its name (F2)",
        false => "Change the name (F2)",
    };
    let delete_hint =
        "Move it to the .deleted folder inside the saves folder; Ctrl Z restores it (Del)";
    actions.extend([
        LibraryAction::new("Rename", rename_hint, LibraryActionKind::Rename(place))
            .key(Press::F2)
            .unless(single.or(has_shipped.then_some(fixed))),
        LibraryAction::command(
            "Duplicate",
            "Make a copy (Ctrl D)",
            LibraryCommand::Duplicate(places.clone()),
        )
        .key(Press::D)
        .unless(has_run.then_some("Runs cannot be duplicated, but they can be exported")),
        LibraryAction::new("Export", "Copy it to another folder", LibraryActionKind::Export),
        LibraryAction::command("Delete", delete_hint, LibraryCommand::Delete(places))
            .key(Press::Delete)
            .unless(kept.into_iter().flatten().next()),
    ]);
    actions
}

fn of_run(library: &Library, item: &LibraryItem, folder: &Path) -> [LibraryAction; 2] {
    let run = item.run();
    // A run of another engine has no plan, and therefore no number of generations.
    let is_readable = run.is_some_and(|run| run.generations.is_some());
    let is_finished = is_readable && run.is_some_and(|run| run.ended.is_some());
    let refusal = if library.is_current(item.place()) {
        Some("This run is open in this window")
    } else if item.problem().is_some() {
        DAMAGED
    } else {
        (!is_readable).then_some("This run cannot be continued; the reason is given below")
    };
    let go_on = Command::Run(RunCommand::Continue(folder.to_owned()));
    let (go_on_label, go_on_hint) = match is_finished {
        true => ("Open", "Open this finished run, which Watch can continue for more generations"),
        false => ("Continue", "Continue this run where it stopped; the current run stays saved"),
    };
    let list_hint = "List the best snake of each generation, to replay and race";
    let list = LibraryActionKind::ShowChampions(folder.to_owned());
    [
        LibraryAction::new(go_on_label, go_on_hint, LibraryActionKind::Send(go_on)).unless(refusal),
        LibraryAction::new("Champions", list_hint, list).unless(replay_refusal(item)),
    ]
}

/// Returns the reason why a save cannot be shown on the stage, if there is one.
fn replay_refusal(item: &LibraryItem) -> Option<&'static str> {
    let has_none = item.run().is_some_and(|run| run.champions.is_empty());
    if has_none { NO_CHAMPION } else { item.problem().and(DAMAGED) }
}
