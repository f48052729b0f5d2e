//! Panels and their names.

use serde::{Deserialize, Serialize};

use super::hinted::hinted_values;

hinted_values! {
    /// A panel, shown as a tab of the window. Panels can be docked anywhere, except that the stage stays in the main window. Its name is the
    /// label of its tab.
    #[derive(Serialize, Deserialize)]
    pub enum PanelKind {
        Stage = "Stage", "The snake on its stairs";
        Run = "Watch", "Watch evolution, start and pause it";
        World = "Change", "Change the surface, the snake and the stairs";
        Lessons = "Learn", "Two-minute experiments";
        Library = "Library", "All saved champions and runs: replay, race, export";
        Charts = "Charts", "See how evolution works";
        Champions = "Champions", "Replay the best of every generation";
        Senses = "Senses", "What the snake senses, and its controller at work";
        Machines = "Machines", "Let other computers compute, too";
        Body = "Body", "The blocks of the snake: change, add and remove them";
        Stairs = "Stairs", "The stairs of the next run: drag their edges, draw random ones, save them";
    }
}

impl PanelKind {
    /// All panels except the stage, in the order of the menu.
    pub const IN_MENU: &'static [Self] = Self::ALL.split_at(1).1;

    /// Panels of the initial layout, in the order of their tabs. The remaining ones are rarely needed and open on
    /// demand.
    pub const INITIAL: &'static [Self] = Self::IN_MENU.split_at(4).0;

    /// Returns the shortcuts that open the panel.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Stage => &[],
            Self::Run => &["Ctrl 1"],
            Self::World => &["Ctrl 2"],
            Self::Lessons => &["Ctrl 6"],
            Self::Library => &["Ctrl 5"],
            Self::Charts => &["Ctrl 3"],
            Self::Champions => &["Ctrl 4"],
            Self::Senses => &["Ctrl 7"],
            Self::Machines => &["Ctrl 8"],
            Self::Body => &["Ctrl 9"],
            Self::Stairs => &["Ctrl T"],
        }
    }

    /// Returns the tooltip, with the first shortcut if there is one.
    pub fn hint_with_key(self) -> String {
        let hint = self.hint();
        self.keys().first().map_or_else(|| hint.to_owned(), |key| format!("{hint} ({key})"))
    }
}
