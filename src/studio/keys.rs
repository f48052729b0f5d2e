//! The keyboard: each key sends one command.

use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;

use super::Frame;
use super::command::Command;
use super::evolution::{Evolution, Status};

/// The keys, as they are listed for a person: name, effect.
pub(super) const KEYS: [(&str, &str); 10] = [
    ("Space", "hold or play the stage"),
    ("R", "play from the start"),
    ("E", "start or pause evolution"),
    ("G", "evolve a single generation"),
    ("1 ... 9", "show the champion of a generation"),
    ("0", "show the first champion again"),
    ("F", "follow the snake, or not"),
    ("Home", "put the camera back"),
    ("D", "the physics engine's own lines"),
    ("Ctrl Q", "quit"),
];

const DIGITS: [KeyCode; 10] = [
    KeyCode::Digit0,
    KeyCode::Digit1,
    KeyCode::Digit2,
    KeyCode::Digit3,
    KeyCode::Digit4,
    KeyCode::Digit5,
    KeyCode::Digit6,
    KeyCode::Digit7,
    KeyCode::Digit8,
    KeyCode::Digit9,
];

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, read.in_set(Frame::TakeIn));
}

/// Turns the keys pressed in this frame into commands, unless a text field has the keyboard.
fn read(
    keys: Res<ButtonInput<KeyCode>>,
    egui: Res<EguiWantsInput>,
    evolution: Res<Evolution>,
    mut send: MessageWriter<Command>,
) {
    if egui.wants_any_keyboard_input() {
        return;
    }
    let control = [KeyCode::ControlLeft, KeyCode::ControlRight, KeyCode::SuperLeft];
    // On a slow frame both keys may be down and up again before anybody looks.
    let control = keys.any_pressed(control) || keys.any_just_pressed(control);
    for key in keys.get_just_pressed() {
        let command = match key {
            KeyCode::KeyQ if control => Command::Quit,
            _ if control => continue,
            KeyCode::Space => Command::TogglePlayback,
            KeyCode::KeyR => Command::Restart,
            KeyCode::KeyE if evolution.status() == Status::Running => Command::Pause,
            KeyCode::KeyE => Command::Start,
            KeyCode::KeyG => Command::SingleGeneration,
            KeyCode::KeyF => Command::ToggleFollow,
            KeyCode::KeyD => Command::ToggleWireframe,
            KeyCode::Home => Command::ResetCamera,
            key => match DIGITS.iter().position(|digit| digit == key) {
                Some(0) => Command::ShowOpening,
                Some(generation) => Command::ShowGeneration(generation as u32),
                None => continue,
            },
        };
        send.write(command);
    }
}
