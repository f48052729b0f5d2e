//! The keyboard: each key sends one command.

use bevy::input::keyboard::{Key, KeyboardInput};
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;

use super::Frame;
use super::command::Command;
use super::evolution::{Evolution, Status};

/// The keys, as they are listed for a person: name, effect.
pub(super) const KEYS: [(&str, &str); 11] = [
    ("Space", "hold or play the stage"),
    ("R", "play from the start"),
    ("E", "start or pause evolution"),
    ("G", "evolve a single generation"),
    ("1 ... 9", "show a generation's champion"),
    ("0", "show the saved champion again"),
    ("F", "follow the snake, or not"),
    ("Home", "put the camera back"),
    ("T", "the light or the dark theme"),
    ("D", "the physics engine's own lines"),
    ("Ctrl Q", "quit"),
];

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, read.in_set(Frame::TakeIn));
}

/// Turns the presses of this frame into commands, in their order, unless a text field has the keyboard.
///
/// It reads what is printed on the key, not where the key is: on a French keyboard Q is elsewhere.
fn read(
    mut presses: MessageReader<KeyboardInput>,
    mut control_is_down: Local<bool>,
    egui: Res<EguiWantsInput>,
    evolution: Res<Evolution>,
    mut send: MessageWriter<Command>,
) {
    for press in presses.read() {
        if matches!(press.logical_key, Key::Control | Key::Super) {
            *control_is_down = press.state.is_pressed();
        }
        if !press.state.is_pressed() || press.repeat || egui.wants_any_keyboard_input() {
            continue;
        }
        let is_running = evolution.status() == Status::Running;
        if let Some(command) = command(&press.logical_key, *control_is_down, is_running) {
            send.write(command);
        }
    }
}

/// What a key asks for.
fn command(key: &Key, control_is_down: bool, is_running: bool) -> Option<Command> {
    let text = match key {
        Key::Space => " ".to_owned(),
        Key::Home => return Some(Command::ResetCamera),
        Key::Character(text) => text.to_lowercase(),
        _ => return None,
    };
    if control_is_down {
        return (text == "q").then_some(Command::Quit);
    }
    match text.as_str() {
        " " => Some(Command::TogglePlayback),
        "r" => Some(Command::Restart),
        "e" if is_running => Some(Command::Pause),
        "e" => Some(Command::Start),
        "g" => Some(Command::SingleGeneration),
        "f" => Some(Command::ToggleFollow),
        "t" => Some(Command::ToggleTheme),
        "d" => Some(Command::ToggleWireframe),
        "0" => Some(Command::ShowOpening),
        digit => digit.parse().ok().map(Command::ShowGeneration),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_key_does_something_and_nothing_else_does() {
        let does = |text: &str| command(&Key::Character(text.into()), false, false);
        for key in ["r", "E", "g", "f", "T", "D", "0", "1", "9"] {
            assert!(does(key).is_some(), "{key}");
        }
        assert_eq!(command(&Key::Space, false, false), Some(Command::TogglePlayback));
        assert_eq!(command(&Key::Character("e".into()), false, true), Some(Command::Pause));
        assert_eq!(command(&Key::Character("Q".into()), true, false), Some(Command::Quit));
        for key in ["q", "x", "-1", "+"] {
            assert_eq!(does(key), None, "{key}");
        }
        assert_eq!(command(&Key::Character("r".into()), true, false), None, "control and R");
    }
}
