//! The presenting mode: the stage alone on the full screen, with a large caption.

use super::display::Studio;
use super::picture::Picture;
use super::places::Place;

/// A tab of the panels, which the presenting mode hides.
const TAB: &str = "Panel Change";
/// A button of the player, which the presenting mode hides, too.
const PLAYER: &str = "Play from start";

fn has(studio: &Studio, label: &str) -> bool {
    studio.find(|place| place.label == label).is_some()
}

/// Returns whether a text is legible from the back of a room: at least a twentieth of the window high.
fn is_large(studio: &Studio, place: &Place) -> bool {
    place.area.height() * 20 >= studio.size.1
}

#[test]
fn the_flag_and_f11_present_the_stage_with_a_large_caption_and_escape_restores_the_window() {
    let Some(studio) = Studio::open("presenting", "--present --preset quick") else { return };
    studio.place_with("climber: ");
    assert!(!has(&studio, TAB));
    studio.wait_for_title("4 of 4 generations, finished");
    // Any key that a clicker does not have ends the mode, and does nothing else.
    studio.key("n");
    studio.place(TAB);
    assert!(!studio.title().contains("showing a race of "), "{}", studio.title());
    let before = studio.stage();
    assert!(has(&studio, TAB) && has(&studio, PLAYER));
    studio.key("F11");
    studio.wait_for_no(TAB);
    assert!(!has(&studio, PLAYER));
    let caption = studio.place_with("climber: ");
    assert!(is_large(&studio, &caption), "{caption:?}");
    let stage = studio.stage();
    assert_eq!((stage.left, stage.right, stage.top), (0, studio.size.0, 0));
    assert!(stage.bottom <= caption.area.top, "nothing lies behind the caption");
    studio.key("space");
    studio.wait_for_title(", stopped at ");
    studio.key("space");
    studio.wait_for_title_without(", stopped at ");
    // The keys of a clicker step through the champions of the generations.
    studio.key("Next");
    studio.place_with("Generation 1: ");
    studio.key("Next");
    studio.place_with("Generation 2: ");
    studio.key("Prior");
    studio.place_with("Generation 1: ");
    let is_black = |picture: &Picture| picture.count(|pixel| *pixel == [0; 3]) > 100_000;
    studio.key("b");
    studio.picture_with(is_black);
    studio.key("b");
    studio.picture_with(|picture| !is_black(picture));
    assert!(!has(&studio, TAB), "it still presents");
    studio.key("Escape");
    studio.place(TAB);
    studio.place(PLAYER);
    studio.wait(|| studio.stage() == before, || format!("{before:?} in {:?}", studio.stage()));
}
