//! Keys under keyboard layouts of other scripts, with real key codes; and stale variables of a session.

use std::process::Command;

use super::display::Studio;
use super::picture::Picture;
use super::places::Place;

/// Codes of keys, by their letters on an American keyboard.
const E: &str = "26";
const T: &str = "28";
const A: &str = "38";
const K: &str = "45";
const X: &str = "53";
const V: &str = "55";
const B: &str = "56";

impl Studio {
    /// Changes the layout of the keyboard.
    fn layout(&self, name: &str) {
        let mut command = Command::new("setxkbmap");
        let status = command.arg(name).env("DISPLAY", &self.display).status();
        assert!(status.expect("setxkbmap, which Xvfb needs, starts").success(), "{name}");
    }

    /// Presses a key with Ctrl held down until the press is read.
    fn with_control(&self, key: &str) {
        self.holding("Control_L", || self.key(key));
    }
}

#[test]
fn f1_f2_keys_act_by_their_position_under_a_russian_layout_and_with_a_stale_wayland_display() {
    let arguments = "--preset quick --generations 1000";
    // The Wayland display of a session that has ended.
    let variables = [("WAYLAND_DISPLAY", "wayland-9")];
    let Some(studio) = Studio::open_with("russian-keys", arguments, &variables) else { return };
    let said = studio.log();
    assert!(said.contains("note: WAYLAND_DISPLAY is \"wayland-9\""), "{said}");
    studio.layout("ru");
    studio.wait_for_title("running");
    studio.key(E);
    studio.wait_for_title("paused");
    let brightness = |picture: &Picture| picture.count(|pixel| pixel.iter().all(|of| *of > 120));
    // The run may be paused before the first picture of the scene.
    let light = brightness(&studio.picture_with(|picture| brightness(picture) > 50_000));
    studio.key(T);
    studio.picture_with(|picture| brightness(picture) * 2 < light);
    // In the field of the palette, text is typed, cut and pasted.
    studio.with_control(K);
    let field = |value: &str| {
        let is_it = |place: &Place| place.label == "Find a command" && place.value == value;
        studio.place_where(&format!("a field with {value:?}"), is_it)
    };
    field("");
    studio.key(T);
    field("е");
    studio.with_control(A);
    studio.with_control(X);
    field("");
    studio.with_control(V);
    studio.with_control(V);
    field("ее");
    studio.key("Escape");
    // A clicker's key turns the stage black.
    studio.key("F11");
    studio.wait_for_no("Panel Change");
    let is_black = |picture: &Picture| picture.count(|pixel| *pixel == [0; 3]) > 100_000;
    studio.key(B);
    studio.picture_with(is_black);
    studio.key(B);
    studio.picture_with(|picture| !is_black(picture));
    studio.key("Escape");
    studio.place("Panel Change");
}
