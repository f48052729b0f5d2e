//! Tests of the details of a save: its state, name, exam, and what is folded.

use super::*;
use crate::studio::panels::library::details::details;
use crate::studio::panels::testing::click;

#[test]
fn the_details_of_the_run_that_is_open_in_this_window_say_so() {
    let library = library();
    let item = library.item(&SavePlace::Run(run_folder())).expect("listed");
    for (is_open, words) in [(true, "Open in this window"), (false, "Can be continued")] {
        let mut harness = Harness::new_ui(|ui| details(ui, item, is_open));
        harness.run();
        assert!(shows(&harness, words), "{words}");
        let other = if is_open { "Can be continued" } else { "Open in this window" };
        assert!(!shows(&harness, other), "not {other}");
    }
}

#[test]
fn different_runs_never_read_alike_and_their_folders_are_behind_details() {
    let runs = ["climb-seed8-0123abcd", "climb-seed8-99ffabcd", "mine"];
    let run = |folder| (SavePlace::Run(Path::new("saves").join(folder)), 6, Ok(stopped_run()));
    let library = library_of(runs.map(run).into());
    let names: Vec<&str> = library.items.iter().map(LibraryItem::name).collect();
    assert_eq!(names, [format!("{RUN} (0123abcd)"), format!("{RUN} (99ffabcd)"), "mine".into()]);
    let mut harness = Harness::new_ui(|ui| details(ui, &library.items[0], false));
    assert!(!shows(&harness, "climb-seed8"));
    click(&mut harness, "Details");
    assert!(shows(&harness, "Folder climb-seed8-0123abcd"));
}

#[test]
fn an_exam_is_a_table_and_the_command_that_found_a_champion_is_behind_details() {
    let library = library_of(vec![(SavePlace::Shipped("robust"), 0, shipped("robust"))]);
    let item = &library.items[0];
    let exam = &item.champion().expect("read").exam;
    let mut harness = Harness::new_ui(|ui| details(ui, item, false));
    let top = |label: &str| harness.get_by_label(label).rect().center().y;
    for result in exam.iter().filter(|result| result.each.is_empty()) {
        let title = snakes_core::schema::Choices::choice(result.suite).title;
        let landed = format!("{} of {} climbed", result.landed, result.trials);
        let beside = harness.get_all_by_label(&landed).map(|of| of.rect().center().y);
        assert!(beside.into_iter().any(|y| (y - top(title)).abs() < 3.0), "{title}: {landed}");
    }
    assert!(shows(&harness, "reaches the landing in 98 of 100 varied trials."));
    assert!(!shows(&harness, "snakes --no-render"));
    click(&mut harness, "Details");
    assert!(shows(&harness, "Found by: snakes --no-render"));
}
