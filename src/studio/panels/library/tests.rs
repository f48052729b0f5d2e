//! The library's panel without a window: what is in it, and what clicks and keys ask for.

use std::path::{Path, PathBuf};
use std::time::Duration;

use bevy_egui::egui::{Key as Press, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use super::*;
use crate::run::Reading;
use crate::save::library::{Details, Entry, RunDetails, read_entry};
use crate::studio::notice::Notices;

fn entry(place: Place, day: u64) -> Entry {
    Entry { place, bytes: 1, modified: Duration::from_secs(day * 86_400) }
}

fn file(name: &str) -> Place {
    Place::Champion(PathBuf::from(format!("saves/{name}.ron")))
}

fn run_folder() -> PathBuf {
    PathBuf::from("saves/climb-seed8-0123abcd")
}

/// A run that was stopped after two of ten generations.
fn stopped_run() -> Details {
    let Ok(Details::Champion(of)) = read_entry(&Place::Shipped("fast")) else {
        panic!("it comes with the program");
    };
    Details::Run(Box::new(RunDetails {
        preset: "climb".to_owned(),
        seed: 8,
        strategy: None,
        controller: of.controller,
        rewarded: of.rewarded,
        finished: 2,
        generations: Some(10),
        best: Some((2, 12.5)),
        best_of_each: vec![Some(3.0), Some(12.5)],
        champions: vec![1, 2],
        ended: None,
        thumbnail: of.thumbnail.clone(),
    }))
}

/// Two champions, a damaged file, a run, and one that comes with the program; the first is the newest.
fn library() -> Library {
    let shipped = Place::Shipped("fast");
    let champion = read_entry(&shipped).map_err(|error| error.to_string());
    let run = Place::Run(run_folder());
    let entries = vec![
        entry(shipped.clone(), 0),
        entry(file("alpha"), 9),
        entry(file("beta"), 8),
        entry(file("broken"), 7),
        entry(run.clone(), 6),
    ];
    Library::of(vec![
        Reading::Listed(entries),
        Reading::Read(shipped, champion.clone()),
        Reading::Read(file("alpha"), champion.clone()),
        Reading::Read(file("beta"), champion),
        Reading::Read(file("broken"), Err("cut off at line 3".to_owned())),
        Reading::Read(run, Ok(stopped_run())),
        Reading::Done(1),
    ])
}

type Test<'a> = Harness<'a, Vec<Command>>;

fn harness<'a>(library: &'a Library, size: [f32; 2]) -> Test<'a> {
    let mut panel = LibraryPanel::default();
    // Two clicks of a test are a double click only if its frames are short.
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / 60.0);
    let mut harness = builder.build_ui_state(
        move |ui, asked: &mut Vec<Command>| panel.ui(ui, library, asked),
        Vec::new(),
    );
    harness.run();
    harness.state_mut().clear();
    harness
}

/// What the panel asks for after somebody has done `act`.
fn asked(library: &Library, act: impl FnOnce(&mut Test<'_>)) -> Vec<Ask> {
    let mut harness = harness(library, [420.0, 800.0]);
    act(&mut harness);
    harness.run();
    let asked = harness.state().iter().filter_map(|command| match command {
        Command::Library(ask) => Some(ask.clone()),
        // Why something cannot be is said.
        Command::Say(_) => None,
        other => panic!("{other:?}"),
    });
    asked.collect()
}

fn click(harness: &mut Test<'_>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

/// Chooses the row whose label begins like this.
fn choose(harness: &mut Test<'_>, name: &str) {
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
fn each_button_asks_for_what_it_says_of_the_save_that_is_chosen() {
    let library = library();
    for (row, button, ask) in [
        ("alpha", "Replay", Ask::Replay(file("alpha"))),
        ("alpha", "New run from it", Ask::FoundRun(file("alpha"))),
        ("beta", "Duplicate", Ask::Duplicate(vec![file("beta")])),
        ("broken", "Delete", Ask::Delete(vec![file("broken")])),
        ("climb-seed8-0123abcd", "Replay", Ask::Replay(Place::Run(run_folder()))),
        ("fast", "Duplicate", Ask::Duplicate(vec![Place::Shipped("fast")])),
    ] {
        let found = asked(&library, |harness| {
            choose(harness, row);
            click(harness, button);
        });
        assert_eq!(found, [ask], "{button} of {row}");
    }
}

#[test]
fn what_makes_no_sense_cannot_be_clicked() {
    let library = library();
    for (row, button) in [
        ("broken", "Replay"),
        ("fast", "Delete"),
        ("fast", "Rename"),
        ("climb-seed8-0123abcd", "Rename"),
        ("climb-seed8-0123abcd", "Duplicate"),
    ] {
        let found = asked(&library, |harness| {
            choose(harness, row);
            assert!(harness.get_by_label(button).accesskit_node().is_disabled(), "{button}");
            click(harness, button);
        });
        assert_eq!(found, [], "{button} of {row}");
    }
}

#[test]
fn a_stopped_run_goes_on_and_shows_its_champions() {
    let library = library();
    let mut harness = harness(&library, [420.0, 900.0]);
    choose(&mut harness, "climb-seed8-0123abcd");
    click(&mut harness, "Continue");
    assert_eq!(*harness.state(), [Command::Continue(run_folder())]);
    harness.state_mut().clear();
    click(&mut harness, "Champions");
    harness.get_by_label_contains("Generation 1").click();
    harness.run();
    click(&mut harness, "Race generations");
    let run = run_folder();
    let expected = [
        Ask::ReplayGeneration { run: run.clone(), generation: 1 },
        Ask::RaceGenerations { run, generations: vec![1, 2] },
    ];
    assert_eq!(*harness.state(), expected.map(Command::Library));
}

#[test]
fn several_are_chosen_with_shift_and_control_and_race() {
    let library = library();
    let found = asked(&library, |harness| {
        choose(harness, "alpha");
        row_of(harness, "beta").click_modifiers(Modifiers::SHIFT);
        harness.run();
        row_of(harness, "fast").click_modifiers(Modifiers::COMMAND);
        harness.run();
        click(harness, "Race");
        assert!(harness.get_by_label("Rename").accesskit_node().is_disabled());
        click(harness, "Delete");
    });
    let places = vec![Place::Shipped("fast"), file("alpha"), file("beta")];
    assert_eq!(found, [Ask::Race(places)], "what comes with the program cannot be deleted");
}

#[test]
fn a_double_click_replays() {
    let library = library();
    let found = asked(&library, |harness| {
        row_of(harness, "beta").click();
        row_of(harness, "beta").click();
        harness.run();
    });
    assert_eq!(found, [Ask::Replay(file("beta"))]);
}

#[test]
fn keys_alone_do_all_that_the_mouse_does() {
    let library = library();
    let none = Modifiers::NONE;
    let found = asked(&library, |harness| {
        harness.get_by_label_contains("Saves: ").focus();
        harness.run();
        // The newest is first.
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
        Ask::Replay(file("beta")),
        Ask::Race(vec![file("alpha"), file("beta")]),
        Ask::Duplicate(vec![file("alpha")]),
        Ask::Delete(vec![file("alpha")]),
    ];
    assert_eq!(found, expected, "what comes with the program is last, and keeps its name");
}

#[test]
fn a_name_is_edited_in_its_row_refused_with_the_reason_and_sent() {
    let library = library();
    let mut harness = harness(&library, [420.0, 800.0]);
    choose(&mut harness, "alpha");
    press(&mut harness, Modifiers::NONE, Press::F2);
    harness.get_by_label("New name").type_text("/x");
    harness.run();
    press(&mut harness, Modifiers::NONE, Press::Enter);
    assert!(harness.query_by_label_contains("allowed: a name without slashes").is_some());
    assert!(harness.state().is_empty());
    for _ in 0.."/x".len() {
        press(&mut harness, Modifiers::NONE, Press::Backspace);
    }
    harness.get_by_label("New name").type_text(" two");
    harness.run();
    press(&mut harness, Modifiers::NONE, Press::Enter);
    let name = "alpha two".to_owned();
    assert_eq!(*harness.state(), [Command::Library(Ask::Rename { place: file("alpha"), name })]);
    harness.state_mut().clear();
    press(&mut harness, Modifiers::NONE, Press::F2);
    harness.get_by_label("New name").type_text("no");
    harness.run();
    press(&mut harness, Modifiers::NONE, Press::Escape);
    assert!(harness.state().is_empty(), "Escape leaves it as it was");
    assert!(harness.query_by_label("New name").is_none());
}

#[test]
fn the_search_leaves_only_what_has_all_its_words() {
    let library = library();
    let mut harness = harness(&library, [420.0, 800.0]);
    harness.get_by_label("Search the library").focus();
    harness.run();
    harness.get_by_label("Search the library").type_text("damaged");
    harness.run();
    assert!(harness.query_by_label_contains("1 of 5 saves").is_some());
    assert!(harness.query_by_label_contains("broken, damaged: cut off at line 3").is_some());
    assert!(harness.query_by_label_contains("alpha, ").is_none());
    harness.get_by_label("Search the library").type_text("xyz");
    harness.run();
    assert!(harness.query_by_label("No save has all of these words.").is_some());
}

#[test]
fn where_it_is_wide_a_click_on_a_column_sorts_by_it_and_the_next_the_other_way() {
    let library = library();
    let mut harness = harness(&library, [900.0, 800.0]);
    let top = |harness: &Test<'_>, name: &str| row_of(harness, name).rect().top();
    assert!(top(&harness, "alpha") < top(&harness, "beta"), "the newest first");
    click(&mut harness, "Sort by name");
    assert!(top(&harness, "beta") < top(&harness, "fast"));
    click(&mut harness, "Sort by name");
    assert!(top(&harness, "beta") > top(&harness, "fast"));
}

#[test]
fn an_export_asks_where_to_and_suggests_the_usual_folder() {
    let library = library();
    let found = asked(&library, |harness| {
        choose(harness, "alpha");
        click(harness, "Export");
        click(harness, "OK");
    });
    let to = Some(Path::new("saves").join("exports"));
    assert_eq!(found, [Ask::Export { places: vec![file("alpha")], to }]);
}

#[test]
fn nothing_sticks_out_of_a_narrow_or_a_low_panel() {
    let library = library();
    for size in [[300.0, 700.0], [300.0, 200.0], [559.0, 400.0], [900.0, 300.0]] {
        let mut harness = harness(&library, size);
        for name in ["alpha", "climb-seed8-0123abcd"] {
            if size[1] > 300.0 {
                choose(&mut harness, name);
            }
        }
        let nodes = harness.get_all_by(|node| node.label().is_some());
        for node in nodes {
            let rect = node.rect();
            assert!(
                rect.right() <= size[0] + 0.5,
                "{:?} of {size:?}: {rect}",
                node.accesskit_node().label()
            );
        }
    }
}

#[test]
fn who_is_chosen_stays_in_sight_when_what_is_said_of_it_makes_the_list_low() {
    let library = library();
    let mut harness = harness(&library, [420.0, 560.0]);
    let list = |harness: &Test<'_>| harness.get_by_label_contains("Saves: ").rect();
    let list_height = |harness: &Test<'_>| list(harness).height();
    let before = list_height(&harness);
    choose(&mut harness, "fast");
    let (list, row) = (list(&harness), row_of(&harness, "fast").rect());
    assert!(list.height() < before - look::SAVE_HEIGHT, "{} of {before}", list.height());
    assert!(list.contains_rect(row), "{row} in {list}");
    // Let go, it leaves its room to the list again.
    let held = Modifiers::COMMAND;
    let at = row.center();
    harness.event_modifiers(egui::Event::PointerMoved(at), held);
    for pressed in [true, false] {
        let button = egui::PointerButton::Primary;
        let event = egui::Event::PointerButton { pos: at, button, pressed, modifiers: held };
        harness.event_modifiers(event, held);
    }
    harness.run();
    assert_eq!(list_height(&harness), before);
}

#[test]
fn of_ten_thousand_saves_only_the_rows_in_sight_are_laid_out() {
    let entries = (0..10_000).map(|number| entry(file(&format!("save {number:05}")), number + 1));
    let library = Library::of(vec![Reading::Listed(entries.collect())]);
    let mut harness = harness(&library, [420.0, 600.0]);
    let rows = |harness: &Test<'_>| {
        let is_row = |label: String| label.starts_with("save 0");
        harness.query_all_by(|node| node.label().is_some_and(is_row)).count()
    };
    let laid_out = rows(&harness);
    assert!((5..20).contains(&laid_out), "{laid_out}");
    // The end is as near as the beginning.
    harness.get_by_label_contains("Saves: ").focus();
    harness.run();
    press(&mut harness, Modifiers::NONE, Press::End);
    assert!(harness.query_by_label("save 00000, not read yet").is_some());
    assert!((5..20).contains(&rows(&harness)));
    // Those in sight are read before the others.
    let hurried = harness.state().iter().rev().find_map(|command| match command {
        Command::Library(Ask::Hurry(places)) => Some(places),
        _ => None,
    });
    assert!(hurried.expect("asked for").contains(&file("save 00000")));
}

#[test]
fn what_is_done_with_many_can_be_cancelled_and_with_a_few_shows_nothing() {
    for (count, shown) in [(50, true), (2, false)] {
        let mut library = library();
        let gone = (0..count).map(|number| file(&format!("gone {number}"))).collect();
        // They are not there: whatever is done, nothing is changed.
        let _ = library.apply(&Ask::Delete(gone), &mut Notices::default());
        let found = asked(&library, |harness| {
            assert_eq!(harness.query_by_label("Cancel").is_some(), shown);
            if shown {
                click(harness, "Cancel");
            }
        });
        assert_eq!(found.first(), shown.then_some(&Ask::Cancel));
    }
}
