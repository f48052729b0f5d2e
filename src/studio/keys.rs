//! The keyboard: turns what is pressed into the command of an action.

use bevy::input::keyboard::{Key, KeyboardInput};
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;

use super::Frame;
use super::actions::{Situation, of_keys};
use super::command::Command;
use super::now::Now;
use super::stage_area::StageArea;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, read.in_set(Frame::TakeIn));
}

/// Turns the presses of this frame into commands, in their order, unless a panel has use for them.
///
/// It reads what is printed on the key, not where the key is: on a French keyboard Q is elsewhere.
fn read(
    mut presses: MessageReader<KeyboardInput>,
    mut held: Local<Held>,
    now: Now,
    (egui, area): (Res<EguiWantsInput>, Res<StageArea>),
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
        if !press.state.is_pressed() || is_echo {
            continue;
        }
        let situation = now.situation();
        let leaves = press.logical_key == Key::Escape && situation.is_covered;
        let (is_typing, is_steering) = (area.has_text_cursor(), egui.wants_any_keyboard_input());
        let is_taken = held.is_for_panel(&press.logical_key, is_typing, is_steering);
        if is_taken && !leaves {
            continue;
        }
        send.write_batch(command(&press.logical_key, *held, situation));
    }
}

/// The keys that are held down beside others.
#[derive(Debug, Clone, Copy, Default)]
struct Held {
    control: bool,
    shift: bool,
}

impl Held {
    /// Whether a panel has use for a key: a field in which somebody is typing, or a list or a slider that has the
    /// keyboard and keys of its own. Help is there everywhere, but "?" can be typed.
    fn is_for_panel(self, key: &Key, is_typing: bool, is_steering: bool) -> bool {
        match key {
            Key::F1 => false,
            // With Control it is no letter.
            key if is_typing => !self.is_command(key),
            Key::Character(text) if text == "?" => false,
            _ => is_steering && !self.control,
        }
    }

    /// Whether it is a key with Control that text fields have no use for.
    fn is_command(self, key: &Key) -> bool {
        let is_theirs =
            |text: &str| ["a", "c", "v", "x", "z", "y"].contains(&text.to_lowercase().as_str());
        self.control && !matches!(key, Key::Character(text) if is_theirs(text))
    }
}

/// The name of what is pressed, such as `Ctrl Shift Z`.
fn name_of(key: &Key, held: Held) -> Option<String> {
    let (name, is_letter) = match key {
        Key::Space => ("Space".to_owned(), true),
        Key::Home => ("Home".to_owned(), true),
        Key::End => ("End".to_owned(), true),
        Key::ArrowLeft => ("Left".to_owned(), true),
        Key::ArrowRight => ("Right".to_owned(), true),
        Key::Escape => ("Esc".to_owned(), true),
        Key::F1 => ("F1".to_owned(), true),
        Key::Character(text) => (text.to_uppercase(), text.chars().all(char::is_alphabetic)),
        _ => return None,
    };
    let control = if held.control { "Ctrl " } else { "" };
    // Where a sign is printed that needs Shift differs from keyboard to keyboard.
    let shift = if held.shift && is_letter { "Shift " } else { "" };
    Some(format!("{control}{shift}{name}"))
}

/// What a press asks for.
fn command(key: &Key, held: Held, situation: Situation) -> Option<Command> {
    let name = name_of(key, held)?;
    let digit = name.parse().ok().filter(|digit| *digit > 0);
    (of_keys(&name)?.asks)(Situation { digit, ..situation })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::actions::ACTIONS;
    use crate::studio::casting::Pick;

    const NONE: Held = Held { control: false, shift: false };
    const CONTROL: Held = Held { control: true, shift: false };
    const SHIFT: Held = Held { control: false, shift: true };

    fn character(text: &str) -> Key {
        Key::Character(text.into())
    }

    /// What has to be pressed for a key's name.
    fn pressed(name: &str) -> (Key, Held) {
        let control = name.contains("Ctrl ");
        let shift = name.contains("Shift ");
        let last = name.rsplit(' ').next().expect("a key");
        let key = match last {
            "Space" => Key::Space,
            "Home" => Key::Home,
            "End" => Key::End,
            "Left" => Key::ArrowLeft,
            "Right" => Key::ArrowRight,
            "Esc" => Key::Escape,
            "F1" => Key::F1,
            text => character(&text.to_lowercase()),
        };
        (key, Held { control, shift })
    }

    #[test]
    fn every_key_of_every_action_does_that_action() {
        let situation =
            Situation { is_race: true, can_undo: true, can_redo: true, ..Situation::default() };
        for action in ACTIONS {
            for name in action.keys {
                let (key, held) = pressed(name);
                assert_eq!(name_of(&key, held).as_deref(), Some(*name));
                assert!(command(&key, held, situation).is_some(), "{name}");
            }
        }
    }

    #[test]
    fn what_a_key_does_depends_on_the_situation() {
        let calm = Situation::default();
        assert_eq!(command(&Key::Escape, NONE, calm), None, "nothing to leave");
        let is_race = Situation { is_race: true, ..calm };
        assert_eq!(command(&Key::Escape, NONE, is_race), Some(Command::Single));
        let is_what_if = Situation { is_what_if: true, ..calm };
        assert_eq!(command(&Key::Escape, NONE, is_what_if), Some(Command::DropChange));
        let is_covered = Situation { is_covered: true, ..is_what_if };
        assert_eq!(command(&Key::Escape, NONE, is_covered), Some(Command::Uncover));
        let is_running = Situation { is_running: true, ..calm };
        assert_eq!(command(&character("e"), NONE, is_running), Some(Command::Pause));
        assert_eq!(command(&character("e"), NONE, calm), Some(Command::Start));
        let third = Command::Show(Pick::Generation(3));
        assert_eq!(command(&character("3"), NONE, calm), Some(third));
    }

    #[test]
    fn keys_that_no_action_has_do_nothing() {
        let calm = Situation::default();
        for text in ["q", "x", "*"] {
            assert_eq!(command(&character(text), NONE, calm), None, "{text}");
        }
        assert_eq!(command(&character("r"), CONTROL, calm), None, "control and R");
        assert_eq!(command(&character("Q"), CONTROL, calm), Some(Command::Quit), "large letters");
        assert_eq!(command(&character("R"), SHIFT, calm), Some(Command::Restart));
    }

    #[test]
    fn a_text_field_keeps_the_keys_that_texts_are_edited_with() {
        assert!(!CONTROL.is_command(&character("z")));
        assert!(CONTROL.is_command(&character("k")));
        assert!(!NONE.is_command(&character("k")));
    }

    #[test]
    fn help_is_there_while_a_list_has_the_keyboard_and_a_question_mark_can_be_typed() {
        let (help, letter) = (character("?"), character("n"));
        assert!(!SHIFT.is_for_panel(&help, false, true));
        assert!(SHIFT.is_for_panel(&help, true, true));
        assert!(!NONE.is_for_panel(&Key::F1, true, true));
        assert!(NONE.is_for_panel(&letter, false, true), "in a list");
        assert!(!CONTROL.is_for_panel(&letter, false, true), "no letter");
        assert!(!NONE.is_for_panel(&letter, false, false), "on the stage");
    }
}
