//! Tests of the library's text fields: names, notes and paths.

use super::*;

/// Returns and removes the commands that were sent so far.
fn taken(harness: &mut Test<'_>) -> Vec<Command> {
    std::mem::take(harness.state_mut())
}

fn type_text(harness: &mut Test<'_>, text: &str) {
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run();
}

fn rename(place: SavePlace, name: &str) -> Command {
    Command::Library(LibraryCommand::Rename { place, name: name.to_owned() })
}

fn note(place: SavePlace, text: &str) -> Command {
    Command::Library(LibraryCommand::SetNotes { place, text: text.to_owned() })
}

#[test]
fn a_name_is_edited_in_its_row_and_invalid_names_are_refused() {
    let mut harness = harness(library(), [420.0, 800.0]);
    select(&mut harness, "alpha");
    press(&mut harness, Modifiers::NONE, Press::F2);
    assert!(harness.get_by_label("New name").is_focused());
    // The old name is selected, so typing replaces it.
    type_text(&mut harness, "a/x");
    press(&mut harness, Modifiers::NONE, Press::Enter);
    harness.get_by_label("The name must be a name without the characters / \\ < > : \" | ? *.");
    assert_eq!(taken(&mut harness), []);
    for _ in 0.."/x".len() {
        press(&mut harness, Modifiers::NONE, Press::Backspace);
    }
    type_text(&mut harness, " two");
    press(&mut harness, Modifiers::NONE, Press::Enter);
    assert_eq!(taken(&mut harness), [rename(file("alpha"), "a two")]);
    press(&mut harness, Modifiers::NONE, Press::F2);
    type_text(&mut harness, "no");
    press(&mut harness, Modifiers::NONE, Press::Escape);
    assert_eq!(taken(&mut harness), [], "Escape leaves it as it was");
    assert!(harness.query_by_label("New name").is_none());
}

#[test]
fn the_name_field_leaves_the_second_line_and_the_next_row_where_they_are() {
    let mut harness = harness(library(), [420.0, 800.0]);
    let [row, next] = ["alpha", "beta"].map(|name| row_of(&harness, name).rect());
    select(&mut harness, "alpha");
    press(&mut harness, Modifiers::NONE, Press::F2);
    let field = harness.get_by_label("New name").rect();
    assert!(row.contains_rect(field), "{field} in {row}");
    assert!(field.bottom() <= row.center().y + 0.5, "{field} over the second line of {row}");
    assert_eq!(row_of(&harness, "beta").rect().top(), next.top());
}

#[test]
fn a_run_gets_a_name_with_any_letters_and_an_empty_one_takes_it_back() {
    let run = SavePlace::Run(run_folder());
    for name in ["Ice: 1/2", ""] {
        let mut harness = harness(library(), [420.0, 900.0]);
        select(&mut harness, RUN);
        clicked(&mut harness, "Rename");
        press(&mut harness, Modifiers::NONE, Press::Backspace);
        if !name.is_empty() {
            type_text(&mut harness, name);
        }
        press(&mut harness, Modifiers::NONE, Press::Enter);
        assert_eq!(taken(&mut harness), [rename(run.clone(), name)]);
    }
}

#[test]
fn notes_are_kept_when_their_field_is_left_and_escape_restores_them() {
    let mut harness = harness(library(), [420.0, 900.0]);
    for (row, place) in [("alpha", file("alpha")), (RUN, SavePlace::Run(run_folder()))] {
        select(&mut harness, row);
        type_into(&mut harness, "Notes", "slips");
        assert_eq!(taken(&mut harness), []);
        harness.get_by_label("Search the library").focus();
        harness.run();
        assert_eq!(taken(&mut harness), [note(place, "slips")]);
    }
    select(&mut harness, "beta");
    assert_eq!(taken(&mut harness), [], "sent once");
    type_into(&mut harness, "Notes", "wrong");
    press(&mut harness, Modifiers::NONE, Press::Escape);
    assert_eq!(taken(&mut harness), []);
    select(&mut harness, "fast");
    assert!(harness.query_by_label("Notes").is_none(), "built-in");
}

#[test]
fn notes_are_kept_when_another_save_is_selected_while_they_are_typed() {
    let mut harness = harness(library(), [420.0, 900.0]);
    select(&mut harness, "alpha");
    type_into(&mut harness, "Notes", "slips");
    select(&mut harness, "beta");
    assert_eq!(taken(&mut harness), [note(file("alpha"), "slips")]);
    assert_eq!(harness.get_by_label("Notes").value(), Some(String::new()));
}

#[test]
fn import_and_export_ask_with_the_systems_dialog() {
    let mut harness = harness(library(), [420.0, 800.0]);
    clicked(&mut harness, "Import");
    select(&mut harness, "alpha");
    clicked(&mut harness, "Export");
    let questions = [FileQuestion::Import, FileQuestion::Export(vec![file("alpha")])];
    assert_eq!(taken(&mut harness), questions.map(|of| Command::File(FileCommand::Ask(of))));
}

#[test]
fn without_a_system_dialog_a_field_for_the_path_opens_with_the_focus_and_the_reason() {
    let export = FileQuestion::Export(vec![file("alpha")]);
    let exports = Path::new("saves").join("exports");
    let mine = PathBuf::from("/saves/mine.ron");
    for (question, typed, path) in [
        (FileQuestion::Import, "/saves/mine.ron", &mine),
        (FileQuestion::Open, "/saves/mine.ron", &mine),
        (export, "", &exports),
    ] {
        let mut library = library();
        library.ask_in_panel(question.clone(), "This desktop offers no dialog.".to_owned());
        let mut harness = harness(library, [420.0, 800.0]);
        assert!(harness.query_by_label("This desktop offers no dialog.").is_some());
        if !typed.is_empty() {
            type_text(&mut harness, typed);
        }
        press(&mut harness, Modifiers::NONE, Press::Enter);
        let answer = FileCommand::Answer(question, vec![path.clone()]);
        assert_eq!(taken(&mut harness), [Command::File(answer)]);
        assert!(harness.query_by_label("OK").is_none(), "closed");
    }
}

#[test]
fn an_export_from_the_menu_takes_the_selection_or_asks_for_one() {
    let requested = || {
        let mut library = library();
        library.export_requests += 1;
        library
    };
    let mut harness = harness(requested(), [420.0, 800.0]);
    // Removes the commands that were sent at the start.
    assert_eq!(taken(&mut harness), []);
    let library = requested();
    let sent = |chosen: Option<SavePlace>| {
        let mut panel = LibraryPanel::default();
        chosen.iter().for_each(|place| panel.selection.only(place));
        let harness = Harness::new_ui(|ui| panel.take_requests(ui, &library));
        Command::take_sent(&harness.ctx)
    };
    let question = FileQuestion::Export(vec![file("alpha")]);
    assert_eq!(sent(Some(file("alpha"))), [Command::File(FileCommand::Ask(question))]);
    let [Command::Notify(text)] = &sent(None)[..] else { panic!("a reason") };
    assert!(text.contains("Select what to export"), "{text}");
}
