//! The presenting mode: the stage alone on the full screen, with a large caption.

use super::display::Studio;
use super::places::Place;

/// A tab of the panels, which the presenting mode hides.
const TAB: &str = "Panel World";
/// A button of the player, which it hides, too.
const PLAYER: &str = "Play from start";

fn has(studio: &Studio, label: &str) -> bool {
    studio.find(|place| place.label == label).is_some()
}

/// Whether a text is high enough to be read from the back of a room: a twentieth of the window.
fn is_large(studio: &Studio, place: &Place) -> bool {
    place.area.height() * 20 >= studio.size().1
}

#[test]
fn f11_presents_the_stage_with_a_large_caption_and_escape_restores_the_window() {
    let Some(studio) = Studio::open("presenting", "--preset quick") else { return };
    studio.pause_evolution();
    let before = studio.stage();
    assert!(has(&studio, TAB) && has(&studio, PLAYER));
    studio.key("F11");
    studio.wait_for_no(TAB);
    assert!(!has(&studio, PLAYER));
    let caption = studio.place_with("climber: ");
    assert!(is_large(&studio, &caption), "{caption:?}");
    let stage = studio.stage();
    assert_eq!((stage.left, stage.right, stage.top), (0, studio.size().0, 0));
    assert!(stage.bottom <= caption.area.top, "nothing lies behind the caption");
    // The keys of the player and of the view work.
    studio.key("space");
    studio.wait_for_title(", stopped at ");
    studio.key("space");
    studio.wait_for_title_without(", stopped at ");
    studio.key("question");
    studio.place("Keyboard and mouse");
    studio.key("Escape");
    studio.wait_for_no("Keyboard and mouse");
    assert!(!has(&studio, TAB), "Escape closes the topmost view first");
    studio.key("Escape");
    studio.place(TAB);
    studio.place(PLAYER);
    studio.wait(|| studio.stage() == before, || format!("{before:?} in {:?}", studio.stage()));
}

#[test]
fn the_flag_presents_from_the_start_and_the_caption_follows_the_stage() {
    let arguments = "--present --preset quick --seed 3";
    let Some(studio) = Studio::open_following("present-flag", arguments) else { return };
    let caption = studio.place_with("Generation 1: ");
    assert!(is_large(&studio, &caption), "{caption:?}");
    assert!(!has(&studio, TAB));
    studio.wait_for_title("4 of 4 generations, finished");
    studio.key("n");
    studio.wait_for_title("showing a race of ");
    studio.place_with(" leads: ");
    studio.key("F11");
    studio.place(TAB);
}
