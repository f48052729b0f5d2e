//! Tests of operations on the files of saves.

use super::*;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::state::library::tests::Tried;
use snakes_core::save::library::SavePlace;

/// Creates a library with this many saves, and returns their places.
fn of_many(count: usize) -> (Tried, Vec<SavePlace>) {
    let mut tried = Tried::new(&["a"]);
    let folder = tried.folder.path();
    for number in 1..count {
        let copy = folder.join(format!("b {number:05}.ron"));
        std::fs::copy(folder.join("a.ron"), copy).expect("copied");
    }
    assert_eq!(tried.own().len(), count);
    let places = tried.library.items.iter().map(|item| item.place().clone());
    let places = places.filter(|place| place.path().is_some()).collect();
    (tried, places)
}

#[test]
fn many_saves_are_deleted_in_the_background_and_restored_together() {
    let (mut tried, places) = of_many(300);
    tried.apply(&LibraryCommand::Delete(places.clone())).expect("begun");
    let running = tried.library.under_way().next().expect("running");
    assert!(running.0.starts_with("Deleting "), "{}", running.0);
    let refusal = tried.apply(&LibraryCommand::Delete(places)).expect_err("running");
    assert!(refusal.contains("of 300 saves is in progress"), "{refusal}");
    tried.wait();
    assert!(tried.own().is_empty());
    assert_eq!(tried.next(), (Some("deleted 300 saves"), None));
    tried.step(UndoDirection::Back);
    assert!(tried.library.under_way().next().is_some());
    tried.wait();
    assert_eq!(tried.own().len(), 300);
    assert_eq!(tried.next(), (None, Some("deleted 300 saves")));
    tried.step(UndoDirection::Forth);
    tried.wait();
    assert!(tried.own().is_empty());
}

/// Begins a batch and cancels it at once. Repeats this until the batch was not finished before the cancellation.
/// Returns the number of saves that `count` finds then.
fn cancelled(
    tried: &mut Tried,
    begin: impl Fn(&mut Tried),
    all: usize,
    back: UndoDirection,
    count: impl Fn(&mut Tried) -> usize,
) -> usize {
    for _ in 0..50 {
        begin(tried);
        tried.apply(&LibraryCommand::Cancel).expect("cancelled");
        tried.wait();
        let done = count(tried);
        if done < all {
            return done;
        }
        tried.step(back);
        tried.wait();
    }
    panic!("each batch was finished before it was cancelled");
}

#[test]
fn a_cancelled_batch_stops_and_its_finished_part_can_be_undone() {
    let (mut tried, places) = of_many(200);
    let duplicate = |tried: &mut Tried| {
        tried.apply(&LibraryCommand::Duplicate(places.clone())).expect("begun");
    };
    let copies = |tried: &mut Tried| tried.own().len() - 200;
    if cancelled(&mut tried, duplicate, 200, UndoDirection::Back, copies) > 0 {
        tried.step(UndoDirection::Back);
        tried.wait();
    }
    assert_eq!(tried.own().len(), 200);
    assert_eq!(tried.next().0, None);
}

#[test]
fn the_rest_of_a_cancelled_undo_can_be_undone() {
    let (mut tried, places) = of_many(200);
    tried.apply(&LibraryCommand::Delete(places)).expect("begun");
    tried.wait();
    let undo = |tried: &mut Tried| tried.step(UndoDirection::Back);
    cancelled(&mut tried, undo, 200, UndoDirection::Forth, |tried| tried.own().len());
    assert_eq!(tried.next().0, Some("deleted 200 saves"));
    tried.step(UndoDirection::Back);
    tried.wait();
    assert_eq!(tried.own().len(), 200);
}

#[test]
fn a_failing_operation_does_not_stop_the_others() {
    for count in [5, 20] {
        let (mut tried, places) = of_many(count);
        std::fs::remove_file(tried.folder.path().join("b 00003.ron")).expect("there");
        tried.apply(&LibraryCommand::Delete(places)).expect("begun");
        tried.wait();
        let label = format!("deleted {} saves", count - 1);
        assert_eq!(tried.next().0, Some(label.as_str()));
        assert_eq!(tried.notices.len(), 2, "the failure and the success");
        assert!(tried.own().is_empty());
        assert!(tried.library.item(&SavePlace::Shipped("fast")).is_some());
    }
}

#[test]
fn a_message_names_a_run_by_its_own_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let [from, kept] = ["climb-seed1-0123abcd", "kept"].map(|name| folder.path().join(name));
    std::fs::create_dir(&kept).expect("made");
    let steps = [FileStep::Deleted { from: from.clone(), kept: kept.clone() }];
    assert_eq!(listed_steps(DELETED, &steps), "deleted climb-seed1-0123abcd");
    snakes_core::save::library::rename(&SavePlace::Run(kept.clone()), "Ice: 1/2").expect("named");
    assert_eq!(listed_steps(DELETED, &steps), "deleted Ice: 1/2");
    let restored = [FileStep::Restored { wanted: from, to: kept }];
    let said = undone_in_words(UndoDirection::Back, "deleted Ice: 1/2", &restored);
    assert_eq!(said, "Ice: 1/2 restored");
}
