//! The keyboard: maps key presses to commands.

use bevy::input::keyboard::{Key, KeyboardInput};
use bevy::prelude::*;
use bevy_egui::egui::Key as KeyPosition;
use bevy_egui::helpers::{bevy_to_egui_key, bevy_to_egui_physical_key};
use bevy_egui::input::EguiWantsInput;

use crate::studio::commands::actions::{Situation, of_keys};
use crate::studio::commands::{Command, PlayerCommand, StageCommand, Turn, WindowCommand};
use crate::studio::panels::situation::CurrentSituation;
use crate::studio::schedule::FrameSet;
use crate::studio::ui::viewport::StageArea;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, read.in_set(FrameSet::TakeIn));
}

/// Sends the commands of this frame's key presses in their order, except for keys that a panel uses.
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
            Key::AltGraph => held.alt_graph = press.state.is_pressed(),
            _ => {}
        }
        let key = meant_key(&press.logical_key, press.key_code, *held);
        let repeats = matches!(key, Key::ArrowLeft | Key::ArrowRight);
        let is_echo = press.repeat && !repeats;
        if !press.state.is_pressed() || is_echo {
            continue;
        }
        let situation = now.situation();
        if situation.is_presenting {
            send.write_batch(of_presenter(&key, press.key_code));
            continue;
        }
        let leaves = key == Key::Escape && situation.is_covered;
        let (is_typing, is_steering) = (area.takes_letters(), egui.wants_any_keyboard_input());
        let is_taken = held.is_for_panel(&key, is_typing, is_steering);
        if is_taken && !leaves {
            continue;
        }
        send.write_batch(command(&key, *held, situation));
    }
}

/// The key that decides which command a press gives. The character on the key decides, wherever a keyboard layout puts it.
/// A character outside ASCII, such as a Cyrillic or Arabic letter, has no command; then the character that an American
/// keyboard has in this position decides. The same holds for the digit keys of French and Czech keyboards, which give
/// digits only with Shift, except where their own character has a command.
fn meant_key(key: &Key, code: KeyCode, held: Held) -> Key {
    let Key::Character(text) = key else { return key.clone() };
    let american = american_character(code, held.shift);
    let is_digit_key = american.is_some_and(|text| text.chars().all(|of| of.is_ascii_digit()));
    let has_meaning = text.is_ascii() && (!is_digit_key || of_keys(text).is_some());
    match american {
        // With AltGr a key gives a character of its own, such as the euro sign.
        Some(american) if !has_meaning && !held.alt_graph => Key::Character(american.into()),
        _ => key.clone(),
    }
}

/// The character that a key gives on an American keyboard, if a command may bear its name.
fn american_character(code: KeyCode, shift: bool) -> Option<&'static str> {
    match (bevy_to_egui_physical_key(&code)?, shift) {
        (KeyPosition::Minus, false) => Some("-"),
        (KeyPosition::Equals, false) => Some("="),
        (KeyPosition::Equals, true) => Some("+"),
        (KeyPosition::Period, false) => Some("."),
        (KeyPosition::Slash, true) => Some("?"),
        (position, shift) => {
            let name = position.name();
            let of_name =
                |letter: char| letter.is_ascii_uppercase() || !shift && letter.is_ascii_digit();
            (name.len() == 1 && name.chars().all(of_name)).then_some(name)
        }
    }
}

/// Modifier keys that are held down.
#[derive(Debug, Clone, Copy, Default)]
struct Held {
    control: bool,
    shift: bool,
    alt_graph: bool,
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
fn of_presenter(key: &Key, code: KeyCode) -> Option<Command> {
    let turn = |turn: Turn| Some(Command::Stage(StageCommand::TakeTurn(turn)));
    let black = || Some(Command::Window(WindowCommand::ToggleBlack));
    match key {
        Key::PageDown | Key::ArrowRight | Key::ArrowDown | Key::Enter => turn(Turn::Next),
        Key::PageUp | Key::ArrowLeft | Key::ArrowUp | Key::Backspace => turn(Turn::Previous),
        // A clicker sends F5 to begin a presentation; the key begins it again.
        Key::F5 | Key::Home => turn(Turn::First),
        Key::Space => Some(Command::Player(PlayerCommand::Toggle)),
        // A clicker sends the position of B or of the full stop, whatever the layout makes of it.
        _ if matches!(code, KeyCode::KeyB | KeyCode::Period) => black(),
        Key::Character(text) if matches!(text.as_str(), "b" | "B" | ".") => black(),
        // egui knows no keys that only modify others, such as the keyboard's layout, or control the computer: sound, light.
        key if !matches!(key, Key::Character(_)) && bevy_to_egui_key(key).is_none() => None,
        // Several keys of one frame end it once.
        _ => Some(Command::Window(WindowCommand::EndPresenting)),
    }
}

/// Returns the name of a shortcut, such as `Ctrl Shift Z`; `None` for a key without a name.
fn name_of(key: &Key, held: Held) -> Option<String> {
    let (name, is_letter) = match key {
        Key::Character(text) => (text.to_uppercase(), text.chars().all(char::is_alphabetic)),
        Key::Escape => ("Esc".to_owned(), true),
        named => (bevy_to_egui_key(named)?.name().to_owned(), true),
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
mod tests;
