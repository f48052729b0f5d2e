//! Tests of the keys.

use super::*;
use crate::studio::commands::actions::actions;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{PlanCommand, RunCommand};

const NONE: Held = Held { control: false, shift: false, alt_graph: false };
const CONTROL: Held = Held { control: true, ..NONE };
const SHIFT: Held = Held { shift: true, ..NONE };

fn character(text: &str) -> Key {
    Key::Character(text.into())
}

/// The command of a character's key in a calm situation.
fn calm(text: &str, held: Held) -> Option<Command> {
    command(&character(text), held, Situation::default())
}

/// The command that shows the champion of a generation.
fn shown(generation: u32) -> Option<Command> {
    Some(Command::Stage(StageCommand::Show(Pick::Generation(generation))))
}

/// The key press for a shortcut's name.
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
    (key, Held { control, shift, ..NONE })
}

#[test]
fn every_shortcut_triggers_its_action() {
    let situation =
        Situation { can_leave: true, can_undo: true, can_redo: true, ..Situation::default() };
    for action in actions() {
        for name in action.keys {
            let (key, held) = pressed(name);
            assert_eq!(name_of(&key, held).as_deref(), Some(*name));
            assert!(command(&key, held, situation).is_some(), "{name}");
        }
    }
}

#[test]
fn a7_the_command_of_a_key_depends_on_the_situation() {
    let calm = Situation::default();
    let can_leave = Situation { can_leave: true, ..calm };
    let is_what_if = Situation { is_what_if: true, ..calm };
    let is_covered = Situation { is_covered: true, ..is_what_if };
    let is_running = Situation { is_running: true, ..calm };
    for (key, now, expected) in [
        (Key::Escape, calm, None),
        (Key::Escape, can_leave, Some(Command::Stage(StageCommand::Leave))),
        (Key::Escape, is_what_if, Some(Command::Plan(PlanCommand::DropChange))),
        (Key::Escape, is_covered, Some(Command::Window(WindowCommand::CloseModal))),
        (character("e"), is_running, Some(Command::Run(RunCommand::Pause))),
        (character("e"), calm, Some(Command::Run(RunCommand::Start))),
        (character("3"), calm, shown(3)),
    ] {
        assert_eq!(command(&key, NONE, now), expected, "{key:?} in {now:?}");
    }
    let is_finished = Situation { is_finished: true, ..calm };
    let sent = command(&character("e"), NONE, is_finished);
    assert!(matches!(sent, Some(Command::Notify(_))), "it begins no other run: {sent:?}");
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
        assert_eq!(of_presenter(&key, KeyCode::F24), expected, "{key:?}");
    }
    for key in [Key::Escape, Key::F11, Key::Tab, Key::F1, character("x"), character("n")] {
        let leave = Command::Window(WindowCommand::EndPresenting);
        assert_eq!(of_presenter(&key, KeyCode::F24), Some(leave), "{key:?}");
    }
}

#[test]
fn a14_unused_keys_do_nothing_and_the_key_for_a_new_run_begins_one() {
    for text in ["q", "x", "*"] {
        assert_eq!(calm(text, NONE), None, "{text}");
    }
    assert_eq!(calm("r", CONTROL), None, "control and R");
    assert_eq!(calm("Q", CONTROL), Some(Command::Quit), "large letters");
    assert_eq!(calm("n", CONTROL), Some(Command::Run(RunCommand::New)));
    assert_eq!(calm("R", SHIFT), Some(Command::Player(PlayerCommand::Restart)));
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

/// The command of a key without other keys held, from the character that a layout gives it and from its position.
fn on_layout(text: &str, code: KeyCode, held: Held) -> Option<Command> {
    command(&meant_key(&character(text), code, held), held, Situation::default())
}

#[test]
fn f1_letters_of_every_script_act_by_the_position_of_their_key() {
    let theme = calm("t", NONE);
    assert!(theme.is_some());
    // Russian, Greek, Arabic, Hebrew, Thai and Hindi.
    for text in ["е", "τ", "ف", "א", "ะ", "ू"] {
        assert_eq!(on_layout(text, KeyCode::KeyT, NONE), theme, "{text}");
        let find = on_layout(text, KeyCode::KeyK, CONTROL);
        assert_eq!(find, calm("k", CONTROL), "Ctrl K as {text}");
    }
    // An Arabic layout gives two letters for one key.
    assert_eq!(on_layout("لا", KeyCode::KeyF, NONE), calm("f", NONE));
    assert_eq!(on_layout("٣", KeyCode::Digit3, NONE), shown(3), "an Arabic digit");
    assert_eq!(on_layout("؟", KeyCode::Slash, SHIFT), calm("?", SHIFT));
    assert_eq!(on_layout("№", KeyCode::Digit3, SHIFT), None, "a number sign is no digit");
}

#[test]
fn f1_a_latin_letter_acts_wherever_a_layout_puts_it() {
    // German Z and Y, French A and Q, and a Dvorak T.
    for (text, code) in [
        ("z", KeyCode::KeyY),
        ("y", KeyCode::KeyZ),
        ("a", KeyCode::KeyQ),
        ("q", KeyCode::KeyA),
        ("t", KeyCode::KeyK),
    ] {
        for held in [NONE, CONTROL, SHIFT] {
            assert_eq!(meant_key(&character(text), code, held), character(text), "{text}");
        }
    }
    let can_undo = Situation { can_undo: true, ..Situation::default() };
    assert_eq!(command(&character("z"), CONTROL, can_undo), Some(Command::Undo));
}

#[test]
fn f1_french_digit_keys_show_generations_without_shift() {
    let row = ["&", "é", "\"", "'", "(", "-", "è", "_", "ç"];
    use KeyCode::{Digit1, Digit2, Digit3, Digit4, Digit5, Digit6, Digit7, Digit8, Digit9};
    let codes = [Digit1, Digit2, Digit3, Digit4, Digit5, Digit6, Digit7, Digit8, Digit9];
    for (number, (text, code)) in (1..).zip(row.into_iter().zip(codes)) {
        // The character itself decides where it has a command.
        let slower = Some(Command::Player(PlayerCommand::ChangeSpeed { faster: false }));
        let expected = if text == "-" { slower } else { shown(number) };
        assert_eq!(on_layout(text, code, NONE), expected, "{text}");
        assert_eq!(on_layout(&number.to_string(), code, SHIFT), shown(number), "Shift {text}");
    }
    assert_eq!(on_layout("&", KeyCode::Digit7, SHIFT), None, "an American Shift 7");
    assert_eq!(on_layout("à", KeyCode::Digit0, CONTROL), calm("0", CONTROL), "Ctrl 0");
}

#[test]
fn f1_characters_that_need_alt_gr_are_no_commands() {
    let alt_graph = Held { alt_graph: true, ..NONE };
    for (text, code) in [("€", KeyCode::KeyE), ("µ", KeyCode::KeyM), ("ę", KeyCode::KeyE)] {
        assert_eq!(on_layout(text, code, alt_graph), None, "{text}");
        assert_eq!(on_layout(text, code, Held { control: true, ..alt_graph }), None, "{text}");
    }
}

#[test]
fn f1_a_text_field_keeps_its_editing_keys_and_its_letters_on_every_layout() {
    // A Russian layout has these letters on the keys of Z, C, V and K.
    for (text, code) in [("я", KeyCode::KeyZ), ("с", KeyCode::KeyC), ("м", KeyCode::KeyV)] {
        let key = meant_key(&character(text), code, CONTROL);
        assert!(CONTROL.is_for_panel(&key, true, true), "Ctrl {text}");
    }
    let find = meant_key(&character("л"), KeyCode::KeyK, CONTROL);
    assert!(!CONTROL.is_for_panel(&find, true, true));
    let typed = meant_key(&character("л"), KeyCode::KeyK, NONE);
    assert!(NONE.is_for_panel(&typed, true, true), "typed");
}

#[test]
fn f1_a_clicker_turns_the_stage_black_on_every_layout() {
    let black = Some(Command::Window(WindowCommand::ToggleBlack));
    // Russian, Greek, Arabic, Hebrew and French layouts.
    for (text, code) in [
        ("и", KeyCode::KeyB),
        ("ю", KeyCode::Period),
        ("β", KeyCode::KeyB),
        ("لا", KeyCode::KeyB),
        ("ز", KeyCode::Period),
        ("נ", KeyCode::KeyB),
        ("ץ", KeyCode::Period),
        (":", KeyCode::Period),
    ] {
        let key = meant_key(&character(text), code, NONE);
        assert_eq!(of_presenter(&key, code), black, "{text}");
    }
    // A change of the layout does not end the presentation.
    for key in [Key::GroupNext, Key::GroupPrevious, Key::ModeChange, Key::ZenkakuHankaku] {
        assert_eq!(of_presenter(&key, KeyCode::ShiftLeft), None, "{key:?}");
    }
}
