//! Real key presses and mouse input.

use std::time::Duration;

use super::display::Studio;

/// Longer than a frame, because egui and Bevy must draw one between a press and the next move.
pub const A_FRAME: Duration = Duration::from_millis(700);

fn for_a_frame() {
    std::thread::sleep(A_FRAME);
}

impl Studio {
    /// Presses and releases a key.
    pub fn key(&self, key: &str) {
        self.xdotool(&["key", key]);
        for_a_frame();
    }

    /// Acts while a key is held down.
    pub fn holding(&self, key: &str, act: impl FnOnce()) {
        self.xdotool(&["keydown", key]);
        for_a_frame();
        act();
        self.xdotool(&["keyup", key]);
        for_a_frame();
    }

    /// Types into the focused widget.
    pub fn type_text(&self, text: &str) {
        self.xdotool(&["type", "--delay", "150", text]);
        for_a_frame();
    }

    /// Replaces the text of the focused field.
    pub fn retype(&self, text: &str) {
        // Not with Ctrl A, because a field reads modifiers at the end of a frame, which may be after their release.
        self.key("End");
        self.xdotool(&["key", "--repeat", "40", "--delay", "20", "BackSpace"]);
        self.type_text(text);
    }

    /// Moves the pointer.
    pub fn move_to(&self, (x, y): (i32, i32)) {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string()]);
        for_a_frame();
    }

    /// Clicks a point of the window.
    pub fn click_at(&self, at: (i32, i32)) {
        self.move_to(at);
        // Press and release at once, because egui treats a longer press differently.
        self.xdotool(&["click", "1"]);
        for_a_frame();
    }

    /// Clicks a point of the window twice.
    pub fn double_click_at(&self, at: (i32, i32)) {
        self.move_to(at);
        self.xdotool(&["click", "1"]);
        // In separate frames, but close in time.
        std::thread::sleep(Duration::from_millis(250));
        self.xdotool(&["click", "1"]);
        for_a_frame();
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
        self.xdotool(&["mousedown", &button]);
        for_a_frame();
        self.move_to(to);
        then();
        self.xdotool(&["mouseup", &button]);
        for_a_frame();
    }

    /// Turns the wheel over a point of the window; up is away from the user.
    pub fn wheel(&self, is_up: bool, at: (i32, i32)) {
        self.move_to(at);
        let button = if is_up { "4" } else { "5" };
        self.xdotool(&["click", "--repeat", "3", "--delay", "50", button]);
        for_a_frame();
    }
}
