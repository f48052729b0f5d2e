//! The keyboard: maps key presses to commands.

use bevy::input::keyboard::{Key, KeyboardInput};
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;

use crate::studio::commands::actions::{Situation, of_keys};
use crate::studio::commands::turn::Turn;
use crate::studio::commands::{Command, PlayerCommand, StageCommand, WindowCommand};
use crate::studio::schedule::FrameSet;
use crate::studio::ui::viewport::StageArea;
use crate::studio::workspace::situation::CurrentSituation;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, read.in_set(FrameSet::TakeIn));
}

/// Sends the commands of this frame's key presses in their order, except for keys that a panel uses.
///
/// Reads the character on the key instead of the key's position, which differs between keyboard layouts.
fn read(
    mut presses: MessageReader<KeyboardInput>,
    mut held: Local<Held>,
    now: CurrentSituation,
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
        if situation.is_presenting {
            send.write_batch(of_presenter(&press.logical_key));
            continue;
        }
        let leaves = press.logical_key == Key::Escape && situation.is_covered;
        let (is_typing, is_steering) = (area.takes_letters(), egui.wants_any_keyboard_input());
        let is_taken = held.is_for_panel(&press.logical_key, is_typing, is_steering);
        if is_taken && !leaves {
            continue;
        }
        send.write_batch(command(&press.logical_key, *held, situation));
    }
}

/// Modifier keys that are held down.
#[derive(Debug, Clone, Copy, Default)]
struct Held {
    control: bool,
    shift: bool,
}

impl Held {
    /// Returns whether a panel uses a key: a text field, or a list or slider with the keyboard focus. F1, F5 and F11
    /// always are shortcuts, and so are characters while nothing is typed.
    fn is_for_panel(self, key: &Key, is_typing: bool, is_steering: bool) -> bool {
        match key {
            Key::F1 | Key::F5 | Key::F11 => false,
            // A key that is pressed with Ctrl types no character.
            key if is_typing => !self.is_command(key),
            // Lists, sliders and buttons with the focus use keys such as arrows, Enter and Space, but no characters.
            Key::Character(_) => false,
            _ => is_steering && !self.control,
        }
    }

    /// Returns whether a key is a shortcut with Ctrl that text fields do not use.
    fn is_command(self, key: &Key) -> bool {
        let is_theirs =
            |text: &str| ["a", "c", "v", "x", "z", "y"].contains(&text.to_lowercase().as_str());
        self.control && !matches!(key, Key::Character(text) if is_theirs(text))
    }
}

/// Returns the command of a key in the presenting mode. The keys of a presenter's clicker go through the champions, and
/// every other key returns to the window.
fn of_presenter(key: &Key) -> Option<Command> {
    let turn = |turn: Turn| Some(Command::Stage(StageCommand::TakeTurn(turn)));
    match key {
        Key::PageDown | Key::ArrowRight | Key::ArrowDown | Key::Enter => turn(Turn::Next),
        Key::PageUp | Key::ArrowLeft | Key::ArrowUp | Key::Backspace => turn(Turn::Previous),
        // A clicker sends F5 to begin a presentation; the key begins it again.
        Key::F5 | Key::Home => turn(Turn::First),
        Key::Space => Some(Command::Player(PlayerCommand::Toggle)),
        Key::Character(text) if matches!(text.as_str(), "b" | "B" | ".") => {
            Some(Command::Window(WindowCommand::ToggleBlack))
        }
        key if is_of_keyboard_itself(key) => None,
        _ => Some(Command::Window(WindowCommand::TogglePresenting)),
    }
}

/// Returns whether a key only modifies other keys, or controls the computer: sound, light, pictures of the screen.
fn is_of_keyboard_itself(key: &Key) -> bool {
    matches!(
        key,
        Key::Shift
            | Key::Control
            | Key::Alt
            | Key::AltGraph
            | Key::Super
            | Key::Meta
            | Key::Hyper
            | Key::Symbol
            | Key::SymbolLock
            | Key::Fn
            | Key::FnLock
            | Key::CapsLock
            | Key::NumLock
            | Key::ScrollLock
            | Key::PrintScreen
            | Key::AudioVolumeUp
            | Key::AudioVolumeDown
            | Key::AudioVolumeMute
            | Key::BrightnessUp
            | Key::BrightnessDown
            | Key::Unidentified(_)
            | Key::Dead(_)
    )
}

/// Returns the name of a shortcut, such as `Ctrl Shift Z`; `None` for a key without a name.
fn name_of(key: &Key, held: Held) -> Option<String> {
    let (name, is_letter) = match key {
        Key::Space => ("Space".to_owned(), true),
        Key::Home => ("Home".to_owned(), true),
        Key::End => ("End".to_owned(), true),
        Key::ArrowLeft => ("Left".to_owned(), true),
        Key::ArrowRight => ("Right".to_owned(), true),
        Key::Escape => ("Esc".to_owned(), true),
        Key::F1 => ("F1".to_owned(), true),
        Key::F5 => ("F5".to_owned(), true),
        Key::F11 => ("F11".to_owned(), true),
        Key::Character(text) => (text.to_uppercase(), text.chars().all(char::is_alphabetic)),
        _ => return None,
    };
    let control = if held.control { "Ctrl " } else { "" };
    // Keyboards differ in which characters need Shift, so Shift is ignored for characters.
    let shift = if held.shift && is_letter { "Shift " } else { "" };
    Some(format!("{control}{shift}{name}"))
}

/// Returns the command of a key press.
fn command(key: &Key, held: Held, situation: Situation) -> Option<Command> {
    let name = name_of(key, held)?;
    let digit = name.parse().ok().filter(|digit| *digit > 0);
    of_keys(&name)?.command(Situation { digit, ..situation })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::actions::actions;
    use crate::studio::commands::pick::Pick;
    use crate::studio::commands::{PlanCommand, RunCommand};

    const NONE: Held = Held { control: false, shift: false };
    const CONTROL: Held = Held { control: true, shift: false };
    const SHIFT: Held = Held { control: false, shift: true };

    fn character(text: &str) -> Key {
        Key::Character(text.into())
    }

    /// Returns the key press of a shortcut, from its name.
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
            "F5" => Key::F5,
            "F11" => Key::F11,
            text => character(&text.to_lowercase()),
        };
        (key, Held { control, shift })
    }

    #[test]
    fn every_shortcut_triggers_its_action() {
        let situation =
            Situation { is_race: true, can_undo: true, can_redo: true, ..Situation::default() };
        for action in actions() {
            for name in action.keys {
                let (key, held) = pressed(name);
                assert_eq!(name_of(&key, held).as_deref(), Some(*name));
                assert!(command(&key, held, situation).is_some(), "{name}");
            }
        }
    }

    #[test]
    fn the_command_of_a_key_depends_on_the_situation() {
        let calm = Situation::default();
        assert_eq!(command(&Key::Escape, NONE, calm), None, "nothing to leave");
        let is_race = Situation { is_race: true, ..calm };
        assert_eq!(
            command(&Key::Escape, NONE, is_race),
            Some(Command::Stage(StageCommand::Single))
        );
        let is_what_if = Situation { is_what_if: true, ..calm };
        assert_eq!(
            command(&Key::Escape, NONE, is_what_if),
            Some(Command::Plan(PlanCommand::DropChange))
        );
        let is_covered = Situation { is_covered: true, ..is_what_if };
        assert_eq!(
            command(&Key::Escape, NONE, is_covered),
            Some(Command::Window(WindowCommand::CloseModal))
        );
        let is_running = Situation { is_running: true, ..calm };
        assert_eq!(
            command(&character("e"), NONE, is_running),
            Some(Command::Run(RunCommand::Pause))
        );
        assert_eq!(command(&character("e"), NONE, calm), Some(Command::Run(RunCommand::Start)));
        let third = Command::Stage(StageCommand::Show(Pick::Generation(3)));
        assert_eq!(command(&character("3"), NONE, calm), Some(third));
    }

    #[test]
    fn a_clicker_leads_through_a_presentation_and_any_other_key_ends_it() {
        let turn = |turn: Turn| Some(Command::Stage(StageCommand::TakeTurn(turn)));
        let black = Some(Command::Window(WindowCommand::ToggleBlack));
        for (key, expected) in [
            (Key::PageDown, turn(Turn::Next)),
            (Key::PageUp, turn(Turn::Previous)),
            (Key::ArrowRight, turn(Turn::Next)),
            (Key::ArrowLeft, turn(Turn::Previous)),
            (Key::F5, turn(Turn::First)),
            (character("b"), black.clone()),
            (character("."), black),
            (Key::Space, Some(Command::Player(PlayerCommand::Toggle))),
            (Key::Shift, None),
            (Key::AudioVolumeUp, None),
        ] {
            assert_eq!(of_presenter(&key), expected, "{key:?}");
        }
        for key in [Key::Escape, Key::F11, Key::Tab, Key::F1, character("x"), character("n")] {
            let leave = Command::Window(WindowCommand::TogglePresenting);
            assert_eq!(of_presenter(&key), Some(leave), "{key:?}");
        }
    }

    #[test]
    fn unused_keys_do_nothing() {
        let calm = Situation::default();
        for text in ["q", "x", "*"] {
            assert_eq!(command(&character(text), NONE, calm), None, "{text}");
        }
        assert_eq!(command(&character("r"), CONTROL, calm), None, "control and R");
        assert_eq!(command(&character("Q"), CONTROL, calm), Some(Command::Quit), "large letters");
        assert_eq!(
            command(&character("R"), SHIFT, calm),
            Some(Command::Player(PlayerCommand::Restart))
        );
    }

    #[test]
    fn a_text_field_keeps_its_editing_keys() {
        assert!(!CONTROL.is_command(&character("z")));
        assert!(CONTROL.is_command(&character("k")));
        assert!(!NONE.is_command(&character("k")));
    }

    #[test]
    fn letters_typed_for_a_name_are_no_commands() {
        for text in "My ice: 1/2 GLOBAL".chars().map(String::from) {
            assert!(NONE.is_for_panel(&character(&text), true, false), "{text}");
            assert!(SHIFT.is_for_panel(&character(&text), true, false), "{text}");
        }
        for key in [Key::Space, Key::Escape, Key::Enter, Key::ArrowLeft, Key::Home] {
            assert!(NONE.is_for_panel(&key, true, false), "{key:?}");
        }
    }

    #[test]
    fn letters_and_help_keys_work_while_a_list_has_the_focus_and_can_be_typed() {
        let (help, letter, named) = (character("?"), character("n"), Key::Space);
        assert!(!SHIFT.is_for_panel(&help, false, true));
        assert!(SHIFT.is_for_panel(&help, true, true));
        assert!(!NONE.is_for_panel(&Key::F1, true, true));
        assert!(NONE.is_for_panel(&letter, true, true), "typed");
        assert!(!NONE.is_for_panel(&letter, false, true), "a list uses no letters");
        assert!(NONE.is_for_panel(&named, false, true), "a button with the focus uses it");
        assert!(!CONTROL.is_for_panel(&letter, false, true), "no letter");
        assert!(!NONE.is_for_panel(&letter, false, false), "on the stage");
    }
}
