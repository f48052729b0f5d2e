//! Panels and their names.

use serde::{Deserialize, Serialize};

/// A tab of the window. Panels can be docked anywhere; the stage stays in the main window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum PanelKind {
    /// The 3D view with its player.
    Stage,
    /// Start, pause and configure evolution.
    Run,
    /// Settings of the world and the snake.
    World,
    /// Charts of the run.
    Charts,
    /// Champions of the generations.
    Champions,
    /// Saved champions and runs.
    Library,
    /// Lessons that reproduce findings of the report.
    Lessons,
    /// Senses and controller of the snake on the stage.
    Senses,
    /// Other computers that compute, too.
    Machines,
    /// The blocks of the snake on the stage, to be edited.
    Body,
    /// The stairs of the next run, to be edited.
    Stairs,
}

impl PanelKind {
    /// All panels except the stage, in the order of the menu.
    pub const ALL: [Self; 10] = [
        Self::Run,
        Self::World,
        Self::Charts,
        Self::Champions,
        Self::Library,
        Self::Lessons,
        Self::Senses,
        Self::Machines,
        Self::Body,
        Self::Stairs,
    ];

    /// The panels of the initial layout, in the order of their tabs. Few people have several computers, so the others open
    /// on demand.
    pub const INITIAL: &'static [Self] = Self::ALL.split_at(7).0;

    /// Label of the tab, shortcuts, and what the panel is for.
    fn words(self) -> (&'static str, &'static [&'static str], &'static str) {
        match self {
            Self::Stage => ("Stage", &[], "The snake on its stairs"),
            Self::Run => ("Run", &["Ctrl 1"], "Start, pause and configure evolution"),
            Self::World => ("World", &["Ctrl 2"], "Change the surface, the snake and the stairs"),
            Self::Charts => ("Charts", &["Ctrl 3"], "See how evolution works"),
            Self::Champions => ("Champions", &["Ctrl 4"], "Replay the best of every generation"),
            Self::Library => {
                ("Library", &["Ctrl 5"], "All saved champions and runs: replay, race, export")
            }
            Self::Lessons => ("Lessons", &["Ctrl 6"], "Two-minute experiments"),
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

    /// Label of the tab.
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// Shortcuts that open the panel.
    pub fn keys(self) -> &'static [&'static str] {
        self.words().1
    }

    /// Tooltip.
    pub fn hint(self) -> String {
        let (_, keys, hint) = self.words();
        keys.first().map_or_else(|| hint.to_owned(), |key| format!("{hint} ({key})"))
    }
}
