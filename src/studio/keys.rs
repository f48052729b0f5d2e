//! The keyboard: each key sends one command.

use bevy::input::keyboard::{Key, KeyboardInput};
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;

use super::Frame;
use super::casting::Pick;
use super::command::Command;
use super::evolution::{Evolution, Status};
use super::overlay::Overlay;
use super::screenshot::Photograph;
use super::stage::Programme;

/// The keys, as they are listed for a person: name, effect.
pub(super) const KEYS: [(&str, &str); 25] = [
    ("Space", "hold or play the stage"),
    ("Left, Right", "a physics step back, on"),
    ("R, End", "to the start, to the end"),
    ("+, -", "faster, slower"),
    ("O", "loop, or stay at the end"),
    ("E", "start or pause evolution"),
    ("G", "evolve a single generation"),
    ("1 ... 9", "show a generation's champion"),
    ("0", "show the saved champion"),
    ("N", "race the generations"),
    ("M", "race the latest ten"),
    ("Esc", "leave a race, drop a change"),
    ("F", "follow the snake, or not"),
    ("C", "the next camera"),
    ("Home", "put the camera back"),
    ("V", "contacts and their forces"),
    ("J", "the joints' torques"),
    ("B", "the trail"),
    ("L", "the fitness line"),
    ("D", "the engine's own lines"),
    ("A", "smooth edges, or faster drawing"),
    ("T", "the light or the dark theme"),
    ("P", "a picture of the stage"),
    ("Shift P", "a picture of the window"),
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
    mut held: Local<Held>,
    programme: Res<Programme>,
    egui: Res<EguiWantsInput>,
    evolution: Res<Evolution>,
    mut send: MessageWriter<Command>,
) {
    for press in presses.read() {
        match press.logical_key {
            Key::Control | Key::Super => held.control = press.state.is_pressed(),
            Key::Shift => held.shift = press.state.is_pressed(),
            _ => {}
        }
        let repeats = matches!(press.logical_key, Key::ArrowLeft | Key::ArrowRight);
        let is_echo = press.repeat && !repeats;
        if !press.state.is_pressed() || is_echo || egui.wants_any_keyboard_input() {
            continue;
        }
        let situation = Situation {
            is_running: evolution.status() == Status::Running,
            is_what_if: matches!(*programme, Programme::WhatIf { .. }),
            is_race: *programme == Programme::Race,
        };
        send.write_batch(command(&press.logical_key, *held, situation));
    }
}

/// The keys that are held down beside others.
#[derive(Debug, Clone, Copy, Default)]
struct Held {
    control: bool,
    shift: bool,
}

/// What a key's meaning depends on.
#[derive(Debug, Clone, Copy, Default)]
struct Situation {
    is_running: bool,
    is_what_if: bool,
    is_race: bool,
}

/// What a key asks for.
fn command(key: &Key, held: Held, situation: Situation) -> Option<Command> {
    let text = match key {
        Key::Space => " ".to_owned(),
        Key::Home => return Some(Command::ResetCamera),
        Key::End => return Some(Command::SeekEnd),
        Key::ArrowLeft => return Some(Command::Step { forward: false }),
        Key::ArrowRight => return Some(Command::Step { forward: true }),
        Key::Escape if situation.is_what_if => return Some(Command::DropChange),
        Key::Escape => return situation.is_race.then_some(Command::Single),
        Key::Character(text) => text.to_lowercase(),
        _ => return None,
    };
    if held.control {
        return (text == "q").then_some(Command::Quit);
    }
    match text.as_str() {
        " " => Some(Command::TogglePlayback),
        "r" => Some(Command::Restart),
        "e" if situation.is_running => Some(Command::Pause),
        "e" => Some(Command::Start),
        "g" => Some(Command::SingleGeneration),
        "n" => Some(Command::RaceGenerations),
        "m" => Some(Command::RaceLeaders(None)),
        "o" => Some(Command::ToggleLoop),
        "+" | "=" => Some(Command::ChangeSpeed { faster: true }),
        "-" => Some(Command::ChangeSpeed { faster: false }),
        "f" => Some(Command::ToggleFollow),
        "c" => Some(Command::NextShot),
        "v" => Some(Command::Toggle(Overlay::Contacts)),
        "j" => Some(Command::Toggle(Overlay::Torques)),
        "b" => Some(Command::Toggle(Overlay::Trail)),
        "l" => Some(Command::Toggle(Overlay::FitnessLine)),
        "d" => Some(Command::Toggle(Overlay::Wireframe)),
        "a" => Some(Command::ToggleSmoothEdges),
        "t" => Some(Command::ToggleTheme),
        "p" if held.shift => Some(Command::TakePicture(Photograph::Window)),
        "p" => Some(Command::TakePicture(Photograph::Stage)),
        "0" => Some(Command::Show(Pick::Opening(0))),
        digit => digit.parse().ok().map(|generation| Command::Show(Pick::Generation(generation))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_key_does_something_and_nothing_else_does() {
        let (none, control) = (Held::default(), Held { control: true, shift: false });
        let calm = Situation::default();
        let does = |text: &str| command(&Key::Character(text.into()), none, calm);
        for (names, _) in KEYS.into_iter().filter(|(names, _)| *names != "Ctrl Q") {
            for name in names.split([',', ' ']).filter(|name| name.chars().count() == 1) {
                assert!(does(name).is_some(), "{name}");
            }
        }
        assert_eq!(command(&Key::Escape, none, calm), None, "nothing to leave");
        let is_race = Situation { is_race: true, ..calm };
        assert_eq!(command(&Key::Escape, none, is_race), Some(Command::Single));
        for key in [Key::Space, Key::Home, Key::End, Key::ArrowLeft, Key::ArrowRight] {
            assert!(command(&key, none, calm).is_some(), "{key:?}");
        }
        let key = |text: &str| Key::Character(text.into());
        let is_running = Situation { is_running: true, ..calm };
        assert_eq!(command(&key("e"), none, is_running), Some(Command::Pause));
        assert_eq!(command(&key("Q"), control, calm), Some(Command::Quit));
        let is_what_if = Situation { is_what_if: true, ..calm };
        assert_eq!(command(&Key::Escape, none, is_what_if), Some(Command::DropChange));
        for text in ["q", "x", "-1", "*"] {
            assert_eq!(does(text), None, "{text}");
        }
        assert_eq!(command(&key("r"), control, calm), None, "control and R");
    }
}
