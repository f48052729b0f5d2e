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
fn the_last_lesson_repeats_a_run_bit_for_bit() {
    let Some(studio) = Studio::open("lesson-9", "--preset quick") else { return };
    studio.pause_evolution();
    studio.open_panel("Learn");
    studio.scroll_and_click("Button", "Begin lesson 9");
    studio.wait_for_title("showing a lesson");
    studio.scroll_and_click("Button", "The same run twice");
    studio.scroll_and_click("Button", "Guess: the same hash");
    let hashes = || -> Vec<String> {
        let is_hash =
            |text: &str| text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let places = studio.places().into_iter();
        places
            .filter(|place| place.role == "Label" && is_hash(&place.label))
            .map(|place| place.label)
            .collect()
    };
    studio.wait(|| hashes().len() == 2, || format!("two hashes: {:?}", hashes()));
    let hashes = hashes();
    assert_eq!(hashes[0], hashes[1]);
    studio.wait_for_title("showing a race of 2");
}

#[test]
fn the_tour_is_taken_once() {
    let folder = super::folder();
    let arguments =
        format!("--preset quick --preferences {}", folder.path().join("studio.ron").display());
    let Some(studio) = Studio::open("tour", &arguments) else { return };
    for step in 1..=5 {
        studio.place(&format!("{step} of 5"));
        studio.click_label(if step < 5 { "Next" } else { "Done" });
    }
    studio.wait_for_no("5 of 5");
    assert_eq!(studio.quit(), Some(0));
    let studio = Studio::open("tour-again", &arguments).expect("it opened before");
    studio.wait_for_title("4 of 4 generations, finished");
    assert!(studio.find(|place| place.label == "Skip the tour").is_none());
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
