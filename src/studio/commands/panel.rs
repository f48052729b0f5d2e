//! Panels and their names.

use serde::{Deserialize, Serialize};

/// A panel, shown as a tab of the window. Panels can be docked anywhere, except that the stage stays in the main window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum PanelKind {
    /// Panel with the 3D view and its player.
    Stage,
    /// Panel to start, pause and configure evolution.
    Run,
    /// Panel for the settings of the world and the snake.
    World,
    /// Panel with charts of the run.
    Charts,
    /// Panel with the champions of the run's generations.
    Champions,
    /// Panel with saved champions and runs.
    Library,
    /// Panel with lessons that reproduce findings of the report.
    Lessons,
    /// Panel with the senses and the controller of the snake on the stage.
    Senses,
    /// Panel for other computers that take part in the evaluations.
    Machines,
    /// Panel to edit the blocks of the snake on the stage.
    Body,
    /// Panel to edit the stairs of the next run.
    Stairs,
}

impl PanelKind {
    /// All panels except the stage, in the order of the menu.
    pub const ALL: [Self; 10] = [
        Self::Run,
        Self::World,
        Self::Lessons,
        Self::Library,
        Self::Charts,
        Self::Champions,
        Self::Senses,
        Self::Machines,
        Self::Body,
        Self::Stairs,
    ];

    /// Panels of the initial layout, in the order of their tabs. The remaining ones are rarely needed and open on
    /// demand.
    pub const INITIAL: &'static [Self] = Self::ALL.split_at(4).0;

    /// Returns the label of the tab, the shortcuts, and the panel's purpose.
    fn words(self) -> (&'static str, &'static [&'static str], &'static str) {
        match self {
            Self::Stage => ("Stage", &[], "The snake on its stairs"),
            Self::Run => ("Watch", &["Ctrl 1"], "Watch evolution, start and pause it"),
            Self::World => ("Change", &["Ctrl 2"], "Change the surface, the snake and the stairs"),
            Self::Charts => ("Charts", &["Ctrl 3"], "See how evolution works"),
            Self::Champions => ("Champions", &["Ctrl 4"], "Replay the best of every generation"),
            Self::Library => {
                ("Library", &["Ctrl 5"], "All saved champions and runs: replay, race, export")
            }
            Self::Lessons => ("Learn", &["Ctrl 6"], "Two-minute experiments"),
            Self::Senses => {
                ("Senses", &["Ctrl 7"], "What the snake senses, and its controller at work")
            }
            Self::Machines => ("Machines", &["Ctrl 8"], "Let other computers compute, too"),
            Self::Body => {
                ("Body", &["Ctrl 9"], "The blocks of the snake: change, add and remove them")
            }
            Self::Stairs => (
                "Stairs",
                &["Ctrl T"],
                "The stairs of the next run: drag their edges, draw random ones, save them",
            ),
        }
    }

    /// Returns the label of the panel's tab.
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// Returns the shortcuts that open the panel.
    pub fn keys(self) -> &'static [&'static str] {
        self.words().1
    }

    /// Returns the tooltip, with the first shortcut if there is one.
    pub fn hint(self) -> String {
        let (_, keys, hint) = self.words();
        keys.first().map_or_else(|| hint.to_owned(), |key| format!("{hint} ({key})"))
    }
}
