//! Lessons, the tour, the keys and the palette of commands, with real mouse and keys.

use super::display::Studio;

#[test]
fn a_complete_lesson_leaves_the_own_run_untouched() {
    /// Words from the conclusion of the first lesson.
    const ANSWER: &str = "holds the others back";
    let Some(studio) = Studio::open("lesson", "--preset quick") else { return };
    studio.pause_evolution();
    studio.open_panel("Change");
    let friction = studio.value_of("TextInput", "Friction");
    let title = studio.title();
    studio.open_panel("Learn");
    studio.click_label("Begin lesson 1");
    studio.wait_for_title("showing a race of 3");
    // The race waits at its start for a guess, and the conclusion waits until the result was seen.
    studio.wait_for_title(", stopped");
    assert!(studio.find(|place| place.label.contains(ANSWER)).is_none());
    studio.scroll_and_click("Button", "Guess: original");
    studio.wait_for_title_without(", stopped");
    studio.scroll_and_click("Button", "Show the result now");
    studio.place_with("You guessed \"original\"");
    studio.place_with(ANSWER);
    // Opening another panel in between loses nothing.
    studio.open_panel("Change");
    studio.open_panel("Learn");
    studio.place_with("You guessed \"original\"");
    studio.scroll_and_click("Button", "Back to my own run");
    studio.wait_for_title(&title);
    studio.open_panel("Change");
    assert_eq!(studio.value_of("TextInput", "Friction"), friction);
}

#[test]
fn shortcuts_are_listed_and_commands_are_found_by_name() {
    let Some(studio) = Studio::open("keys", "--preset quick") else { return };
    studio.wait_for_title("4 of 4 generations, finished");
    studio.key("question");
    studio.place("Keyboard and mouse");
    studio.key("Escape");
    studio.wait_for_no("Keyboard and mouse");
    studio.key("ctrl+k");
    studio.place("Find a command");
    studio.type_text("dark");
    studio.key("Return");
    // The modal view has closed, and the button offers the other theme.
    studio.wait_for_no("Find a command");
    studio.place_of("Button", "Light");
    studio.key("ctrl+k");
    studio.place("Find a command");
    studio.type_text("race generations");
    studio.key("Return");
    studio.wait_for_title("showing a race of ");
}
