//! Everything that can be done by name: what the menus list, what keys do, what the palette of commands finds, and what
//! the overlay of keys shows. There is one list, so that none of them can say what another does not do.

use super::casting::Pick;
use super::command::Command;
use super::desk::Over;
use super::overlay::Overlay;
use super::panels::PanelKind;
use super::screenshot::Photograph;
use super::view::Shot;

/// The menus, and the groups of the overlay of keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Menu {
    /// Evolution, and who is shown.
    Run,
    /// Taking back.
    Edit,
    /// The player.
    Stage,
    /// The camera, and what is drawn.
    View,
    /// The panels.
    Panels,
    /// How to learn all this.
    Help,
}

impl Menu {
    /// All of them, in the order of the menu bar.
    pub const ALL: [Self; 6] =
        [Self::Run, Self::Edit, Self::Stage, Self::View, Self::Panels, Self::Help];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Run => "Run",
            Self::Edit => "Edit",
            Self::Stage => "Stage",
            Self::View => "View",
            Self::Panels => "Panels",
            Self::Help => "Help",
        }
    }
}

/// What an action's meaning depends on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Situation {
    /// Evolution is going on.
    pub is_running: bool,
    /// A change is tried out.
    pub is_what_if: bool,
    /// Several are on the stage.
    pub is_race: bool,
    /// Something lies over the window: the keys, the palette, the tour.
    pub is_covered: bool,
    /// There is something to take back.
    pub can_undo: bool,
    /// There is something to do again.
    pub can_redo: bool,
    /// The digit that was pressed, if one was.
    pub digit: Option<u32>,
}

/// Something that can be done by name.
pub(super) struct Action {
    /// The menu in which it is.
    pub menu: Menu,
    /// Its name.
    pub name: &'static str,
    /// The keys that do it, such as `Ctrl Z`; the first is the one that is shown.
    pub keys: &'static [&'static str],
    /// What it asks for. None: there is nothing to do now.
    pub asks: fn(Situation) -> Option<Command>,
}

const fn action(
    menu: Menu,
    name: &'static str,
    keys: &'static [&'static str],
    asks: fn(Situation) -> Option<Command>,
) -> Action {
    Action { menu, name, keys, asks }
}

impl Action {
    /// The key that is shown beside its name, or nothing.
    pub fn key(&self) -> &'static str {
        match self.keys {
            ["1", ..] => "1 ... 9",
            [first, ..] => first,
            [] => "",
        }
    }
}

/// What the keys ask for: the exact ones, or those without Shift where Shift makes no difference.
pub(super) fn of_keys(keys: &str) -> Option<&'static Action> {
    let exact = |keys: &str| ACTIONS.iter().find(|action| action.keys.contains(&keys));
    exact(keys).or_else(|| exact(keys.strip_prefix("Shift ")?))
}

/// All of them, by menu.
pub(super) const ACTIONS: &[Action] = &[
    action(Menu::Run, "Start or pause evolution", &["E"], |now| {
        Some(if now.is_running { Command::Pause } else { Command::Start })
    }),
    action(Menu::Run, "Evolve one generation", &["G"], |_| Some(Command::SingleGeneration)),
    action(Menu::Run, "Reset the run", &[], |_| Some(Command::Reset)),
    action(
        Menu::Run,
        "Show a generation's champion",
        &["1", "2", "3", "4", "5", "6", "7", "8", "9"],
        |now| now.digit.map(|generation| Command::Show(Pick::Generation(generation))),
    ),
    action(Menu::Run, "Show the saved champion", &["0"], |_| Some(Command::Show(Pick::Opening(0)))),
    action(Menu::Run, "Race the generations", &["N"], |_| Some(Command::RaceGenerations)),
    action(Menu::Run, "Race the latest ten", &["M"], |_| Some(Command::RaceLeaders(None))),
    action(Menu::Run, "Quit", &["Ctrl Q"], |_| Some(Command::Quit)),
    action(Menu::Edit, "Undo", &["Ctrl Z"], |now| now.can_undo.then_some(Command::Undo)),
    action(Menu::Edit, "Redo", &["Ctrl Shift Z", "Ctrl Y"], |now| {
        now.can_redo.then_some(Command::Redo)
    }),
    action(Menu::Edit, "Keep the change that is tried", &[], |now| {
        now.is_what_if.then_some(Command::KeepChange)
    }),
    action(Menu::Edit, "Leave a race, drop a change", &["Esc"], |now| match now {
        Situation { is_covered: true, .. } => Some(Command::Uncover),
        Situation { is_what_if: true, .. } => Some(Command::DropChange),
        Situation { is_race: true, .. } => Some(Command::Single),
        _ => None,
    }),
    action(Menu::Stage, "Hold or play", &["Space"], |_| Some(Command::TogglePlayback)),
    action(Menu::Stage, "A physics step back", &["Left"], |_| {
        Some(Command::Step { forward: false })
    }),
    action(Menu::Stage, "A physics step on", &["Right"], |_| Some(Command::Step { forward: true })),
    action(Menu::Stage, "To the start", &["R"], |_| Some(Command::Restart)),
    action(Menu::Stage, "To the end", &["End"], |_| Some(Command::SeekEnd)),
    action(Menu::Stage, "Faster", &["+", "="], |_| Some(Command::ChangeSpeed { faster: true })),
    action(Menu::Stage, "Slower", &["-"], |_| Some(Command::ChangeSpeed { faster: false })),
    action(Menu::Stage, "Loop, or stay at the end", &["O"], |_| Some(Command::ToggleLoop)),
    action(Menu::View, "Follow the snake, or not", &["F"], |_| Some(Command::ToggleFollow)),
    action(Menu::View, "The next camera", &["C"], |_| Some(Command::NextShot)),
    action(Menu::View, "From the side", &[], |_| Some(Command::Look(Shot::Side))),
    action(Menu::View, "From above", &[], |_| Some(Command::Look(Shot::Top))),
    action(Menu::View, "Put the camera back", &["Home"], |_| Some(Command::ResetCamera)),
    action(Menu::View, "Contacts and their forces", &["V"], |_| {
        Some(Command::Toggle(Overlay::Contacts))
    }),
    action(Menu::View, "The joints' torques", &["J"], |_| Some(Command::Toggle(Overlay::Torques))),
    action(Menu::View, "The trail", &["B"], |_| Some(Command::Toggle(Overlay::Trail))),
    action(Menu::View, "The fitness line", &["L"], |_| Some(Command::Toggle(Overlay::FitnessLine))),
    action(Menu::View, "The engine's own lines", &["D"], |_| {
        Some(Command::Toggle(Overlay::Wireframe))
    }),
    action(Menu::View, "Smooth edges, or faster drawing", &["A"], |_| {
        Some(Command::ToggleSmoothEdges)
    }),
    action(Menu::View, "The light or the dark theme", &["T"], |_| Some(Command::ToggleTheme)),
    action(Menu::View, "Larger panels", &["Ctrl +", "Ctrl ="], |_| {
        Some(Command::ChangeScale { larger: true })
    }),
    action(Menu::View, "Smaller panels", &["Ctrl -"], |_| {
        Some(Command::ChangeScale { larger: false })
    }),
    action(Menu::View, "Panels of the usual size", &["Ctrl 0"], |_| Some(Command::ResetScale)),
    action(Menu::View, "The stage alone", &["H"], |_| Some(Command::ToggleBare)),
    action(Menu::View, "A picture of the stage", &["P"], |_| {
        Some(Command::TakePicture(Photograph::Stage))
    }),
    action(Menu::View, "A picture of the window", &["Shift P"], |_| {
        Some(Command::TakePicture(Photograph::Window))
    }),
    action(Menu::Panels, "Run", &["Ctrl 1"], |_| Some(Command::Open(PanelKind::Run))),
    action(Menu::Panels, "World", &["Ctrl 2"], |_| Some(Command::Open(PanelKind::World))),
    action(Menu::Panels, "Charts", &["Ctrl 3"], |_| Some(Command::Open(PanelKind::Charts))),
    action(Menu::Panels, "Champions", &["Ctrl 4"], |_| Some(Command::Open(PanelKind::Champions))),
    action(Menu::Panels, "Library", &["Ctrl 5"], |_| Some(Command::Open(PanelKind::Library))),
    action(Menu::Panels, "Lessons", &["Ctrl 6"], |_| Some(Command::Open(PanelKind::Lessons))),
    action(Menu::Panels, "Close the panel used last", &["Ctrl W"], |_| Some(Command::ClosePanel)),
    action(Menu::Panels, "Put all panels back", &[], |_| Some(Command::ResetLayout)),
    action(Menu::Help, "All keys", &["?", "F1"], |_| Some(Command::Cover(Over::Keys))),
    action(Menu::Help, "Find a command", &["Ctrl K", "Ctrl P"], |_| {
        Some(Command::Cover(Over::Palette))
    }),
    action(Menu::Help, "Take the tour", &[], |_| Some(Command::Cover(Over::Tour(0)))),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_name_and_no_key_stands_for_two_actions() {
        let mut names = BTreeSet::new();
        let mut keys = BTreeSet::new();
        for action in ACTIONS {
            assert!(names.insert(action.name), "{} twice", action.name);
            for key in action.keys {
                assert!(keys.insert(*key), "{key} twice");
            }
        }
    }

    #[test]
    fn every_menu_has_actions_and_lists_them_together() {
        let mut menus: Vec<Menu> = ACTIONS.iter().map(|action| action.menu).collect();
        menus.dedup();
        assert_eq!(menus, Menu::ALL);
    }

    #[test]
    fn shift_makes_no_difference_where_there_is_no_key_of_its_own() {
        assert_eq!(of_keys("Shift R").map(|action| action.name), Some("To the start"));
        assert_eq!(of_keys("Shift P").map(|action| action.name), Some("A picture of the window"));
        assert!(of_keys("Ctrl R").is_none());
    }
}
