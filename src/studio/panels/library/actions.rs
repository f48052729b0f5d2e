//! What can be done with the saves that are chosen: the same for buttons, the menu and the keys.

use std::path::{Path, PathBuf};

use crate::save::library::Place;
use crate::studio::command::Command;
use crate::studio::library::{Ask, Item, Library};
use crate::studio::stage::MOST_LANES;

/// Something that can be done.
#[derive(Debug)]
pub struct Action {
    /// On its button.
    pub name: &'static str,
    /// What it does, and by which key.
    pub hint: &'static str,
    /// Why it cannot be done now, if it cannot.
    pub refusal: Option<&'static str>,
    /// What it is.
    pub act: Act,
}

/// What an action is.
#[derive(Debug, Clone, PartialEq)]
pub enum Act {
    /// Ask for this.
    Send(Command),
    /// Let the name be edited in its row.
    Rename(Place),
    /// Ask where to.
    Export,
    /// Show or hide the champions of this run.
    ShowChampions(PathBuf),
}

impl Act {
    /// Whether it is asked for by the key to delete.
    pub fn deletes(&self) -> bool {
        matches!(self, Self::Send(Command::Library(Ask::Delete(_))))
    }
}

const ONLY_ONE: Option<&str> = Some("Choose one save for it");
const DAMAGED: Option<&str> = Some("It cannot be read");
const NO_CHAMPION: Option<&str> = Some("The run has no champion yet");

/// What can be done with these, those that make no sense left out.
pub fn actions(library: &Library, chosen: &[&Item]) -> Vec<Action> {
    let Some(first) = chosen.first() else { return Vec::new() };
    let places: Vec<Place> = chosen.iter().map(|item| item.place().clone()).collect();
    let unshowable = chosen.iter().find_map(|item| unshowable(item));
    let single = if chosen.len() == 1 { None } else { ONLY_ONE };
    let mut actions = vec![match chosen.len() {
        1 => Action {
            name: "Replay",
            hint: "Put it on the stage; of a run its best (Enter, double click)",
            refusal: unshowable,
            act: ask(Ask::Replay(first.place().clone())),
        },
        several => Action {
            name: "Race",
            hint: "Let them climb side by side; of a run its best (Enter)",
            refusal: if several > MOST_LANES {
                Some("The stage has room for ten")
            } else {
                unshowable
            },
            act: ask(Ask::Race(places.clone())),
        },
    }];
    actions.push(Action {
        name: "New run from it",
        hint: "Begin a run in which it is a parent of the first generation",
        refusal: single.or(unshowable),
        act: ask(Ask::FoundRun(first.place().clone())),
    });
    if let (Some(folder), 1) = (first.place().run(), chosen.len()) {
        actions.extend(of_run(library, first, folder));
    }
    let has = |meant: fn(&Place) -> bool| places.iter().any(meant);
    let has_run = has(|place| place.run().is_some());
    let has_shipped = has(|place| matches!(place, Place::Shipped(_)));
    actions.extend([
        Action {
            name: "Rename",
            hint: "Give it another name (F2)",
            refusal: single
                .or(has_run.then_some("The name of a run's folder says what run it is"))
                .or(has_shipped.then_some("It comes with the program; duplicate it first")),
            act: Act::Rename(first.place().clone()),
        },
        Action {
            name: "Duplicate",
            hint: "Make a copy beside it (Ctrl D)",
            refusal: has_run.then_some("A run is there once; its champions can be exported"),
            act: ask(Ask::Duplicate(places.clone())),
        },
        Action {
            name: "Export",
            hint: "Copy it to another folder; a run as a whole",
            refusal: None,
            act: Act::Export,
        },
        Action {
            name: "Delete",
            hint: "Put it away into .deleted in the folder of saves; Ctrl Z brings it back (Del)",
            refusal: has_shipped.then_some("It comes with the program").or_else(|| {
                let goes_on = places.iter().any(|place| library.is_current(place));
                goes_on.then_some("The run goes on now; begin another one first")
            }),
            act: ask(Ask::Delete(places)),
        },
    ]);
    actions
}

fn of_run(library: &Library, item: &Item, folder: &Path) -> [Action; 2] {
    let is_over = item.run().is_none_or(|run| run.ended.is_some());
    let refusal = if library.is_current(item.place()) {
        Some("It goes on now")
    } else if item.problem().is_some() {
        DAMAGED
    } else {
        is_over.then_some("It cannot go on: see below")
    };
    let has_none = item.run().is_some_and(|run| run.champions.is_empty());
    [
        Action {
            name: "Continue",
            hint: "Go on with this run where it was stopped; the current one is kept",
            refusal,
            act: Act::Send(Command::Continue(folder.to_owned())),
        },
        Action {
            name: "Champions",
            hint: "List the best of each of its generations, to replay and race",
            refusal: if has_none { NO_CHAMPION } else { item.problem().and(DAMAGED) },
            act: Act::ShowChampions(folder.to_owned()),
        },
    ]
}

/// Why it cannot be put on the stage, if it cannot.
fn unshowable(item: &Item) -> Option<&'static str> {
    let has_none = item.run().is_some_and(|run| run.champions.is_empty());
    if has_none { NO_CHAMPION } else { item.problem().and(DAMAGED) }
}

fn ask(ask: Ask) -> Act {
    Act::Send(Command::Library(ask))
}
