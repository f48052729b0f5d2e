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
    pub const INITIAL: [Self; 7] = [
        Self::Run,
        Self::World,
        Self::Charts,
        Self::Champions,
        Self::Library,
        Self::Lessons,
        Self::Senses,
    ];

    /// Label of the tab.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stage => "Stage",
            Self::Run => "Run",
            Self::World => "World",
            Self::Charts => "Charts",
            Self::Champions => "Champions",
            Self::Library => "Library",
            Self::Lessons => "Lessons",
            Self::Senses => "Senses",
            Self::Machines => "Machines",
            Self::Body => "Body",
            Self::Stairs => "Stairs",
        }
    }

    /// Tooltip.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Stage => "The snake on its stairs",
            Self::Run => "Start, pause and configure evolution (Ctrl 1)",
            Self::World => "Change the surface, the snake and the stairs (Ctrl 2)",
            Self::Charts => "See how evolution works (Ctrl 3)",
            Self::Champions => "Replay the best of every generation (Ctrl 4)",
            Self::Library => "All saved champions and runs: replay, race, export (Ctrl 5)",
            Self::Lessons => "Two-minute experiments (Ctrl 6)",
            Self::Senses => "What the snake senses, and its controller at work (Ctrl 7)",
            Self::Body => "The blocks of the snake: change, add and remove them (Ctrl 9)",
            Self::Stairs => {
                "The stairs of the next run: drag their edges, draw random ones, save them (Ctrl T)"
            }
            Self::Machines => "Let other computers compute, too (Ctrl 8)",
        }
    }
}
