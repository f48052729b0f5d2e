//! Chooses the next action of a random hand, from a seed and from the controls that the window shows.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;
use snakes_core::rng::{Purpose, stream};

use crate::window::places::{Area, Place};

/// Width and height of the screen, in pixels, for windows of several sizes.
pub const SCREEN: (i32, i32) = (1280, 800);
/// Usual width and height of the window: the smallest for which the panels are laid out, and the fastest to draw.
pub const USUAL_SIZE: (i32, i32) = (1024, 640);

/// Texts that the hand types. No text has a slash or leads to the parent folder, so no path leaves the test's folder.
const TEXTS: [&str; 24] = [
    "0",
    "-1",
    "1",
    "7.5",
    "0.001",
    "0,5",
    "12 m",
    "1e9",
    "nan",
    "inf",
    "99999999999999999999",
    "ice",
    "climb",
    "my snake",
    "My Ice 2",
    ".hidden",
    "a.ron",
    "climber.ron",
    "saves",
    "damaged",
    "race",
    "run friction",
    "quit now",
    "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx",
];

/// Keys for moving within panels and editing text, as xdotool names them.
const PANEL_KEYS: [&str; 24] = [
    "Tab",
    "Tab",
    "shift+Tab",
    "Return",
    "Return",
    "space",
    "Up",
    "Down",
    "Left",
    "Right",
    "shift+Down",
    "shift+Right",
    "Page_Up",
    "Page_Down",
    "Delete",
    "BackSpace",
    "F2",
    "F5",
    "ctrl+a",
    "ctrl+c",
    "ctrl+x",
    "ctrl+v",
    "Menu",
    "alt+F",
];

/// An action, as commands for xdotool.
#[derive(Debug)]
pub struct Action {
    /// Description of the action in words.
    pub words: String,
    /// Name of the control at which the action aims; `None` without one.
    pub control: Option<String>,
    /// Commands for xdotool; `WINDOW` stands for the window's number.
    pub script: Vec<String>,
    /// Number of frames to wait for before the next action.
    pub frames: u64,
    /// New size of the window; `None` if it is not resized.
    pub resized: Option<(i32, i32)>,
}

/// Chooses random actions.
///
/// The hand is careful for some actions in a row: it waits until their effects are visible, and so gets through menus and dialogs.
/// Then it is hurried, and several clicks and keys reach the program in a frame.
pub struct RandomHand {
    rng: ChaCha8Rng,
    is_careful: bool,
    shortcuts: Vec<String>,
}

impl RandomHand {
    /// Creates the hand of a seed.
    pub fn new(seed: u64) -> Self {
        Self {
            rng: stream(seed, 0, 0, Purpose::Calibration),
            is_careful: true,
            shortcuts: shortcuts(),
        }
    }

    /// Returns the next action in a window of this size that shows these controls.
    pub fn act(&mut self, places: &[Place], size: (i32, i32)) -> Action {
        let kind = self.rng.random_range(0..100);
        let mut action = match kind {
            0..42 => self.use_control(places, size),
            42..54 => {
                let at = self.point(size);
                self.click(at, "the window")
            }
            54..64 => {
                let (from, to) = (self.point(size), self.point(size));
                self.drag(from, to, "the window")
            }
            64..78 => {
                let key = self.one_of_shortcuts();
                press(&key)
            }
            78..86 => {
                let key = self.one_of(&PANEL_KEYS);
                press(key)
            }
            86..89 => self.type_text(),
            89..95 => self.scroll(size),
            95..98 => press("Escape"),
            _ => self.resize(),
        };
        if self.rng.random_bool(0.05) {
            self.is_careful = self.rng.random_bool(0.08);
        }
        action.frames = if self.is_careful { self.rng.random_range(1..=2) } else { 0 };
        action
    }

    /// Uses a control in the way that its role suggests, or clicks it.
    fn use_control(&mut self, places: &[Place], (width, height): (i32, i32)) -> Action {
        let is_in_sight = |place: &&Place| {
            let (x, y) = place.area.middle();
            !["Label", "Frame"].contains(&place.role.as_str())
                && (0..width).contains(&x)
                && (0..height).contains(&y)
        };
        let shown: Vec<&Place> = places.iter().filter(is_in_sight).collect();
        let Some(place) = shown.choose(&mut self.rng) else {
            let at = self.point((width, height));
            return self.click(at, "the window");
        };
        let name = format!("{} {:?}", place.role, place.label);
        let (from, to) = (self.within(place.area), self.within(place.area));
        let mut action = match place.role.as_str() {
            "Slider" | "SpinButton" if self.rng.random_bool(0.6) => self.drag(from, to, &name),
            "TextInput" | "SpinButton" => self.fill_in(from, &name),
            _ if self.rng.random_bool(0.08) => self.drag(from, to, &name),
            _ => self.click(from, &name),
        };
        action.control = Some(name);
        action
    }

    /// Clicks a field, types, and leaves it in one of several ways.
    fn fill_in(&mut self, at: (i32, i32), name: &str) -> Action {
        let mut action = self.click(at, name);
        let text = self.one_of(&TEXTS);
        action.script.push("sleep 0.15".to_owned());
        if self.rng.random_bool(0.7) {
            action.script.push("key ctrl+a".to_owned());
        }
        action.script.push(typed(text));
        let last = self.one_of(&["Return", "Return", "Tab", "Escape", "shift"]);
        action.script.push(format!("key {last}"));
        action.words += &format!(", type {text:?}, {last}");
        action
    }

    fn click(&mut self, (x, y): (i32, i32), name: &str) -> Action {
        let button = self.one_of(&["1", "1", "1", "1", "1", "1", "1", "1", "3", "2"]);
        let times = self.one_of(&["once", "once", "once", "once", "once", "once", "twice"]);
        let held = self.one_of(&["", "", "", "", "", "", "", "shift", "ctrl", "alt"]);
        let mut script = vec![format!("mousemove {x} {y}")];
        if !held.is_empty() {
            script.push(format!("keydown {held}"));
        }
        if self.rng.random_bool(0.3) {
            // The button is pressed for longer than a frame.
            script.extend([format!("mousedown {button}"), "sleep 0.25".to_owned()]);
            script.push(format!("mouseup {button}"));
        } else {
            script.push(format!("click {button}"));
        }
        if times == "twice" {
            script.extend(["sleep 0.1".to_owned(), format!("click {button}")]);
        }
        if !held.is_empty() {
            script.push(format!("keyup {held}"));
        }
        action(format!("click {button} {times} at {x},{y} on {name}, holding {held:?}"), script)
    }

    fn drag(&mut self, (x, y): (i32, i32), (to_x, to_y): (i32, i32), name: &str) -> Action {
        let button = self.one_of(&["1", "1", "1", "1", "3", "2"]);
        let mut script = vec![format!("mousemove {x} {y}"), format!("mousedown {button}")];
        script.push(format!("mousemove {} {}", (x + to_x) / 2, (y + to_y) / 2));
        if self.rng.random_bool(0.5) {
            // The button is held across frames.
            script.push("sleep 0.25".to_owned());
        }
        script.extend([format!("mousemove {to_x} {to_y}"), "sleep 0.05".to_owned()]);
        if self.rng.random_bool(0.1) {
            script.push("key Escape".to_owned());
        }
        script.push(format!("mouseup {button}"));
        action(format!("drag {button} from {x},{y} to {to_x},{to_y} on {name}"), script)
    }

    fn scroll(&mut self, size: (i32, i32)) -> Action {
        let (x, y) = self.point(size);
        let (direction, times) = (self.one_of(&["4", "5", "5"]), self.rng.random_range(1..8));
        let held = self.one_of(&["", "", "", "", "ctrl", "shift"]);
        let turn = format!("click --repeat {times} --delay 20 {direction}");
        let mut script = vec![format!("mousemove {x} {y}")];
        if held.is_empty() {
            script.push(turn);
        } else {
            script.extend([format!("keydown {held}"), turn, format!("keyup {held}")]);
        }
        action(format!("scroll {direction} {times} times at {x},{y}, holding {held:?}"), script)
    }

    fn type_text(&mut self) -> Action {
        let text = self.one_of(&TEXTS);
        action(format!("type {text:?}"), vec![typed(text)])
    }

    fn resize(&mut self) -> Action {
        let (width, height) = if self.rng.random_bool(0.6) {
            USUAL_SIZE
        } else {
            let width = self.rng.random_range(USUAL_SIZE.0..=SCREEN.0);
            (width, self.rng.random_range(USUAL_SIZE.1..=SCREEN.1))
        };
        let script = vec![format!("windowsize WINDOW {width} {height}")];
        let resized = Some((width, height));
        Action { resized, ..action(format!("resize to {width}x{height}"), script) }
    }

    fn point(&mut self, (width, height): (i32, i32)) -> (i32, i32) {
        (self.rng.random_range(0..width), self.rng.random_range(0..height))
    }

    fn within(&mut self, area: Area) -> (i32, i32) {
        area.at(self.rng.random_range(0.1..0.9), self.rng.random_range(0.2..0.8))
    }

    fn one_of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.rng.random_range(0..all.len())]
    }

    fn one_of_shortcuts(&mut self) -> String {
        self.shortcuts[self.rng.random_range(0..self.shortcuts.len())].clone()
    }
}

fn action(words: String, script: Vec<String>) -> Action {
    Action { words, control: None, script, frames: 0, resized: None }
}

fn press(key: &str) -> Action {
    action(format!("press {key}"), vec![format!("key {key}")])
}

fn typed(text: &str) -> String {
    format!("type --delay 5 -- \"{text}\"")
}

/// Returns all shortcuts of the program in the notation of xdotool, read from the source of menus and keys.
fn shortcuts() -> Vec<String> {
    let source = include_str!("../../../../src/studio/commands/actions.rs");
    let lists = source.split("&[").skip(1).filter_map(|rest| rest.split_once(']'));
    let quoted = lists.flat_map(|(list, _)| list.split('"').skip(1).step_by(2));
    let keys: Vec<String> = quoted.filter(|text| text.len() < 14).map(xdotool_key).collect();
    assert!(keys.len() > 50 && keys.contains(&"ctrl+z".to_owned()), "{keys:?}");
    keys
}

/// Converts a shortcut such as `Ctrl Shift Z` into `ctrl+shift+z`.
fn xdotool_key(shortcut: &str) -> String {
    let parts = shortcut.split(' ').map(|part| match part {
        "Esc" => "Escape".to_owned(),
        "+" => "plus".to_owned(),
        "-" => "minus".to_owned(),
        "=" => "equal".to_owned(),
        "?" => "question".to_owned(),
        "Left" | "Right" | "Home" | "End" | "F1" => part.to_owned(),
        other => other.to_lowercase(),
    });
    parts.collect::<Vec<_>>().join("+")
}
