//! Tests of the library panel without a window.

mod details;
mod fields;

use std::path::{Path, PathBuf};
use std::time::Duration;

use bevy_egui::egui::{Key as Press, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use super::*;
use crate::studio::commands::{PlanCommand, PlayerCommand, RunCommand};
use crate::studio::panels::testing::{
    Sent as Test, clicked, panel_at_60_hz, sent_by, shows, type_into,
};
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::notifications::Notices;
use snakes_core::save::EntryNotes;
use snakes_core::save::library::{
    EntryDetails, EntryProblem, LibraryEntry, RunDetails, read_entry,
};
use snakes_lab::run::LibraryEvent;

fn entry(place: SavePlace, day: u64) -> LibraryEntry {
    let notes = Ok(EntryNotes::default());
    LibraryEntry { place, bytes: 1, modified: Duration::from_secs(day * 86_400), notes }
}

fn file(name: &str) -> SavePlace {
    SavePlace::Champion(PathBuf::from(format!("saves/{name}.ron")))
}

/// Readable name of the run in [`run_folder`].
const RUN: &str = "Climb 8, 7 Jan, 12 m";

fn run_folder() -> PathBuf {
    PathBuf::from("saves/climb-seed8-0123abcd")
}

/// Returns the details of a run that was stopped after two of ten generations.
fn stopped_run() -> EntryDetails {
    let Ok(EntryDetails::Champion(of)) = shipped("fast") else {
        panic!("a built-in champion");
    };
    EntryDetails::Run(Box::new(RunDetails {
        preset: "climb".to_owned(),
        seed: 8,
        strategy: None,
        controller: of.controller,
        rewarded: of.rewarded,
        finished: 2,
        generations: Some("2 of 10 generations".to_owned()),
        best: Some((2, 12.5)),
        best_of_each: vec![Some(3.0), Some(12.5)],
        champions: vec![1, 2],
        ended: None,
        thumbnail: of.thumbnail.clone(),
    }))
}

/// A save with the day of its last change since 1970, and what is read from it.
type TestSave = (SavePlace, u64, Result<EntryDetails, EntryProblem>);

fn library_of(saves: Vec<TestSave>) -> Library {
    let entries = saves.iter().map(|(place, day, _)| entry(place.clone(), *day)).collect();
    let read = saves.into_iter().map(|(place, _, read)| LibraryEvent::Read(place, read));
    let listed = std::iter::once(LibraryEvent::Listed(entries));
    Library::of(listed.chain(read).chain([LibraryEvent::Done(1)]).collect())
}

fn shipped(name: &'static str) -> Result<EntryDetails, EntryProblem> {
    read_entry(&SavePlace::Shipped(name)).map_err(EntryProblem::from)
}

/// Creates a library with two champions, a damaged file, a run and a built-in champion. The first champion is the newest entry.
fn library() -> Library {
    library_of(vec![
        (SavePlace::Shipped("fast"), 0, shipped("fast")),
        (file("alpha"), 9, shipped("fast")),
        (file("beta"), 8, shipped("fast")),
        (file("broken"), 7, Err(EntryProblem::damaged("cut off at line 3"))),
        (SavePlace::Run(run_folder()), 6, Ok(stopped_run())),
    ])
}

fn harness(library: Library, size: [f32; 2]) -> Test<'static> {
    let mut panel = LibraryPanel::default();
    let draw = move |ui: &mut egui::Ui| panel.ui(ui, &library, &UndoHistory::default());
    let mut harness = panel_at_60_hz(size, draw);
    harness.state_mut().clear();
    harness
}

/// Calls `act`, and returns the commands to the library that were sent afterwards.
fn sent(library: Library, act: impl FnOnce(&mut Test<'_>)) -> Vec<LibraryCommand> {
    let commands = sent_by(harness(library, [420.0, 800.0]), act);
    let requests = commands.into_iter().filter_map(|command| match command {
        Command::Library(request) => Some(request),
        // The reasons of refused actions are not compared.
        Command::Notify(_) => None,
        other => panic!("{other:?}"),
    });
    requests.collect()
}

/// Selects the row whose label starts with this name.
fn select(harness: &mut Test<'_>, name: &str) {
    row_of(harness, name).click();
    harness.run();
}

fn row_of<'t>(harness: &'t Test<'_>, name: &str) -> egui_kittest::Node<'t> {
    let start = format!("{name}, ");
    harness.get_by(move |node| node.label().is_some_and(|label| label.starts_with(&start)))
}

fn press(harness: &mut Test<'_>, modifiers: Modifiers, key: Press) {
    harness.key_press_modifiers(modifiers, key);
    harness.run();
}

#[test]
fn each_button_sends_its_command_for_the_selected_save() {
    for (row, button, request) in [
        ("alpha", "Replay", LibraryCommand::Replay(file("alpha"))),
        ("beta", "Duplicate", LibraryCommand::Duplicate(vec![file("beta")])),
        ("broken", "Delete", LibraryCommand::Delete(vec![file("broken")])),
        (RUN, "Replay", LibraryCommand::Replay(SavePlace::Run(run_folder()))),
        ("fast", "Duplicate", LibraryCommand::Duplicate(vec![SavePlace::Shipped("fast")])),
    ] {
        let found = sent(library(), |harness| {
            select(harness, row);
            clicked(harness, button);
        });
        assert_eq!(found, [request], "{button} of {row}");
    }
    let mut harness = harness(library(), [420.0, 900.0]);
    select(&mut harness, "alpha");
    clicked(&mut harness, "New run from this");
    let expected = Command::Plan(PlanCommand::StartFromSave(file("alpha")));
    assert_eq!(*harness.state(), [expected]);
}

#[test]
fn impossible_actions_are_disabled() {
    for (row, button) in
        [("broken", "Replay"), ("fast", "Delete"), ("fast", "Rename"), (RUN, "Duplicate")]
    {
        let found = sent(library(), |harness| {
            select(harness, row);
            assert!(harness.get_by_label(button).accesskit_node().is_disabled(), "{button}");
            clicked(harness, button);
        });
        assert_eq!(found, [], "{button} of {row}");
    }
}

#[test]
fn a_finished_run_is_opened_unless_it_is_of_another_engine() {
    for (generations, is_refused) in
        [(Some("10 of 10 generations".to_owned()), false), (None, true)]
    {
        let EntryDetails::Run(run) = stopped_run() else { panic!("a run") };
        let ended = Some("of engine 2".to_owned());
        let ended = EntryDetails::Run(Box::new(RunDetails { generations, ended, ..*run }));
        let saves = library_of(vec![(SavePlace::Run(run_folder()), 6, Ok(ended))]);
        let mut harness = harness(saves, [420.0, 900.0]);
        select(&mut harness, RUN);
        let button = if is_refused { "Continue" } else { "Open" };
        assert_eq!(harness.get_by_label(button).accesskit_node().is_disabled(), is_refused);
        if !is_refused {
            clicked(&mut harness, button);
            assert_eq!(*harness.state(), [Command::Run(RunCommand::Continue(run_folder()))]);
        }
    }
}

#[test]
fn a_stopped_run_is_resumed_and_lists_its_champions() {
    let mut harness = harness(library(), [420.0, 900.0]);
    select(&mut harness, RUN);
    clicked(&mut harness, "Continue");
    assert_eq!(*harness.state(), [Command::Run(RunCommand::Continue(run_folder()))]);
    harness.state_mut().clear();
    clicked(&mut harness, "Champions");
    harness.get_by_label_contains("Generation 1").click();
    harness.run();
    clicked(&mut harness, "Race generations");
    let run = run_folder();
    let expected = [
        LibraryCommand::ReplayGeneration { run: run.clone(), generation: 1 },
        LibraryCommand::RaceGenerations { run, generations: vec![1, 2] },
    ];
    assert_eq!(*harness.state(), expected.map(Command::Library));
}

#[test]
fn shift_and_control_select_several_saves_for_a_race() {
    let found = sent(library(), |harness| {
        select(harness, "alpha");
        row_of(harness, "beta").click_modifiers(Modifiers::SHIFT);
        harness.run();
        row_of(harness, "fast").click_modifiers(Modifiers::COMMAND);
        harness.run();
        clicked(harness, "Race");
        assert!(harness.get_by_label("Rename").accesskit_node().is_disabled());
        clicked(harness, "Delete");
    });
    let places = vec![SavePlace::Shipped("fast"), file("alpha"), file("beta")];
    assert_eq!(found, [LibraryCommand::Race(places)], "built-in champions cannot be deleted");
}

#[test]
fn a_double_click_replays_a_save() {
    let found = sent(library(), |harness| {
        row_of(harness, "beta").click();
        row_of(harness, "beta").click();
        harness.run();
    });
    assert_eq!(found, [LibraryCommand::Replay(file("beta"))]);
}

#[test]
fn every_mouse_action_has_a_key() {
    let none = Modifiers::NONE;
    let found = sent(library(), |harness| {
        harness.get_by_label_contains("Saves: ").focus();
        harness.run();
        // The newest save is the first row.
        press(harness, none, Press::ArrowDown);
        press(harness, none, Press::ArrowDown);
        press(harness, none, Press::Enter);
        press(harness, Modifiers::SHIFT, Press::ArrowUp);
        press(harness, none, Press::Enter);
        press(harness, none, Press::Home);
        press(harness, Modifiers::COMMAND, Press::D);
        press(harness, none, Press::Delete);
        press(harness, none, Press::End);
        press(harness, none, Press::F2);
    });
    let expected = [
        LibraryCommand::Replay(file("beta")),
        LibraryCommand::Race(vec![file("alpha"), file("beta")]),
        LibraryCommand::Duplicate(vec![file("alpha")]),
        LibraryCommand::Delete(vec![file("alpha")]),
    ];
    assert_eq!(found, expected, "the built-in champion is last and keeps its name");
}

#[test]
fn the_search_shows_only_saves_that_match_all_words() {
    let mut harness = harness(library(), [420.0, 800.0]);
    type_into(&mut harness, "Search the library", "damaged");
    assert!(shows(&harness, "1 of 5 saves"));
    assert!(shows(&harness, "broken, damaged: cut off at line 3"));
    assert!(!shows(&harness, "alpha, "));
    harness.get_by_label("Search the library").type_text("xyz");
    harness.run();
    assert!(harness.query_by_label("No save matches all of these words.").is_some());
}

#[test]
fn a_click_on_a_column_sorts_and_a_second_click_reverses_the_order() {
    let mut harness = harness(library(), [900.0, 800.0]);
    let top = |harness: &Test<'_>, name: &str| row_of(harness, name).rect().top();
    assert!(top(&harness, "alpha") < top(&harness, "beta"), "the newest first");
    clicked(&mut harness, "Sort by name");
    assert!(top(&harness, "beta") < top(&harness, "fast"));
    clicked(&mut harness, "Sort by name");
    assert!(top(&harness, "beta") > top(&harness, "fast"));
}

#[test]
fn everything_fits_into_a_narrow_or_low_panel() {
    for size in [[300.0, 700.0], [300.0, 200.0], [559.0, 400.0], [900.0, 300.0]] {
        let mut harness = harness(library(), size);
        for name in ["alpha", RUN] {
            if size[1] > 300.0 {
                select(&mut harness, name);
            }
        }
        let nodes = harness.get_all_by(|node| node.label().is_some());
        for node in nodes {
            let (rect, label) = (node.rect(), node.accesskit_node().label());
            assert!(rect.right() <= size[0] + 0.5, "{label:?} of {size:?}: {rect}");
        }
    }
}

#[test]
fn the_selected_row_stays_visible_when_its_details_shrink_the_list() {
    let mut harness = harness(library(), [420.0, 560.0]);
    let list = |harness: &Test<'_>| harness.get_by_label_contains("Saves: ").rect();
    let list_height = |harness: &Test<'_>| list(harness).height();
    let before = list_height(&harness);
    select(&mut harness, "fast");
    let (list, row) = (list(&harness), row_of(&harness, "fast").rect());
    assert!(list.height() < before - theme::LIBRARY_ROW_HEIGHT, "{} of {before}", list.height());
    assert!(list.contains_rect(row), "{row} in {list}");
    // Without a selection, the list has its full height again.
    row_of(&harness, "fast").click_modifiers(Modifiers::COMMAND);
    harness.run();
    assert_eq!(list_height(&harness), before);
}

#[test]
fn a17_a_selection_leaves_more_than_half_of_the_panel_to_the_list() {
    let saves = (10..30).map(|number| (file(&format!("save {number}")), 9, shipped("fast")));
    let library = library_of(saves.collect());
    // The panel of a window of 1280 by 720 points.
    let mut harness = harness(library, [384.0, 650.0]);
    let rows = |harness: &Test<'_>| {
        harness.get_by_label_contains("Saves: ").rect().height() / theme::LIBRARY_ROW_HEIGHT
    };
    assert!(rows(&harness) > 10.0, "{}", rows(&harness));
    select(&mut harness, "save 12");
    assert!(rows(&harness) > 7.5, "{}", rows(&harness));
    let delete = harness.get_by_label("Delete").rect();
    assert!(delete.bottom() < 650.0, "{delete}");
}

#[test]
fn a17_delete_concerns_no_save_that_the_search_hides() {
    let found = sent(library(), |harness| {
        select(harness, "alpha");
        row_of(harness, "beta").click_modifiers(Modifiers::COMMAND);
        harness.run();
        type_into(harness, "Search the library", "beta");
        clicked(harness, "Delete");
    });
    assert_eq!(found, [LibraryCommand::Delete(vec![file("beta")])]);
    let hidden = sent(library(), |harness| {
        select(harness, "alpha");
        type_into(harness, "Search the library", "beta");
        assert!(!shows(harness, "Delete"), "nothing that is shown is selected");
    });
    assert_eq!(hidden, []);
}

#[test]
fn a13_space_in_the_list_pauses_the_stage() {
    let mut harness = harness(library(), [420.0, 800.0]);
    select(&mut harness, "alpha");
    press(&mut harness, Modifiers::NONE, Press::Space);
    assert_eq!(*harness.state(), [Command::Player(PlayerCommand::Toggle)]);
}

#[test]
fn only_the_visible_rows_of_ten_thousand_saves_are_laid_out() {
    let entries = (0..10_000).map(|number| entry(file(&format!("save {number:05}")), number + 1));
    let library = Library::of(vec![LibraryEvent::Listed(entries.collect())]);
    let mut harness = harness(library, [420.0, 600.0]);
    let rows = |harness: &Test<'_>| {
        let is_row = |label: String| label.starts_with("save 0");
        harness.query_all_by(|node| node.label().is_some_and(is_row)).count()
    };
    let laid_out = rows(&harness);
    assert!((5..20).contains(&laid_out), "{laid_out}");
    // The last row is reached with one key.
    harness.get_by_label_contains("Saves: ").focus();
    harness.run();
    press(&mut harness, Modifiers::NONE, Press::End);
    assert!(harness.query_by_label("save 00000, not read yet").is_some());
    assert!((5..20).contains(&rows(&harness)));
    // Visible entries are read first.
    let hurried = harness.state().iter().rev().find_map(|command| match command {
        Command::Library(LibraryCommand::LoadFirst(places)) => Some(places),
        _ => None,
    });
    assert!(hurried.expect("requested").contains(&file("save 00000")));
}

#[test]
fn long_operations_can_be_cancelled_and_short_ones_show_no_progress() {
    for (count, shown) in [(50, true), (2, false)] {
        let mut library = library();
        let gone = (0..count).map(|number| file(&format!("gone {number}"))).collect();
        // The files do not exist, so nothing changes on disk.
        let _ = library.apply(
            &LibraryCommand::Delete(gone),
            &mut UndoHistory::default(),
            &mut Notices::default(),
        );
        let found = sent(library, |harness| {
            assert_eq!(harness.query_by_label("Cancel").is_some(), shown);
            if shown {
                clicked(harness, "Cancel");
            }
        });
        assert_eq!(found.first(), shown.then_some(&LibraryCommand::Cancel));
    }
}
