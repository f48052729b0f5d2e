//! Real key presses and mouse input.

use std::time::Duration;

use super::display::Studio;

/// Number of frames until an input takes effect: the frame that is being drawn, a frame that reads the input, and a frame that
/// applies the commands.
const FRAMES: u64 = 3;

impl Studio {
    /// Calls `act`, and waits until its effect is drawn. Software rendering can take a second for a frame.
    fn for_frames(&self, act: impl FnOnce()) {
        let before = self.frame();
        act();
        self.wait(|| self.frame() >= before + FRAMES, || format!("{FRAMES} frames after {before}"));
    }

    /// Presses and releases a key.
    pub fn key(&self, key: &str) {
        self.for_frames(|| self.xdotool(&["key", key]));
    }

    /// Calls `act` while a key is held down.
    pub fn holding(&self, key: &str, act: impl FnOnce()) {
        self.for_frames(|| self.xdotool(&["keydown", key]));
        act();
        self.for_frames(|| self.xdotool(&["keyup", key]));
    }

    /// Types into the focused widget.
    pub fn type_text(&self, text: &str) {
        self.for_frames(|| self.xdotool(&["type", "--delay", "150", text]));
    }

    /// Replaces the text of the focused field.
    pub fn retype(&self, text: &str) {
        // Ctrl A would fail, because a field reads modifiers at the end of a frame, possibly after their release.
        self.key("End");
        self.xdotool(&["key", "--repeat", "40", "--delay", "20", "BackSpace"]);
        self.type_text(text);
    }

    /// Moves the pointer to a point of the window.
    pub fn move_to(&self, (x, y): (i32, i32)) {
        self.for_frames(|| self.xdotool(&["mousemove", &x.to_string(), &y.to_string()]));
    }

    /// Clicks a point of the window.
    pub fn click_at(&self, at: (i32, i32)) {
        self.move_to(at);
        // Press and release follow at once, because egui treats a longer press differently.
        self.for_frames(|| self.xdotool(&["click", "1"]));
    }

    /// Clicks a point of the window twice.
    pub fn double_click_at(&self, at: (i32, i32)) {
        self.move_to(at);
        self.xdotool(&["click", "1"]);
        // The two clicks are in separate frames, but close in time.
        std::thread::sleep(Duration::from_millis(150));
        self.for_frames(|| self.xdotool(&["click", "1"]));
    }

    /// Drags with a mouse button from one point of the window to another.
    pub fn drag(&self, button: u32, from: (i32, i32), to: (i32, i32)) {
        self.drag_and_hold(button, from, to, || {});
    }

    /// Drags and keeps the button pressed until `then` has happened.
    pub fn drag_and_hold(
        &self,
        button: u32,
        from: (i32, i32),
        to: (i32, i32),
        then: impl FnOnce(),
    ) {
        let button = button.to_string();
        self.move_to(from);
        self.for_frames(|| self.xdotool(&["mousedown", &button]));
        self.move_to(to);
        then();
        self.for_frames(|| self.xdotool(&["mouseup", &button]));
    }

    /// Turns the mouse wheel over a point of the window. Up is away from the user.
    pub fn wheel(&self, is_up: bool, at: (i32, i32)) {
        self.move_to(at);
        let button = if is_up { "4" } else { "5" };
        self.for_frames(|| self.xdotool(&["click", "--repeat", "3", "--delay", "50", button]));
    }
}
