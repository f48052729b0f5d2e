//! State of the stage that the panels read.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::{Command, PlayerCommand, StageCommand, ViewCommand};
use crate::studio::scene::camera::StageCamera;
use crate::studio::scene::camera::rig::CameraRig;
use crate::studio::scene::overlays::Overlays;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::selection::Selection;
use crate::studio::state::following::Following;
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::theme::Theme;

/// State of the stage that the panels read.
#[derive(SystemParam)]
pub(crate) struct OnStage<'w, 's> {
    pub lanes: Query<'w, 's, &'static Lane>,
    pub mode: Res<'w, StageMode>,
    pub playback: Res<'w, Playback>,
    pub selection: Res<'w, Selection>,
    pub rig: Res<'w, CameraRig>,
    pub overlays: Res<'w, Overlays>,
    pub history: Res<'w, UndoHistory>,
    pub following: Res<'w, Following>,
    pub smoothing: Query<'w, 's, &'static Msaa, With<StageCamera>>,
}

impl OnStage<'_, '_> {
    /// Whether the setting that a command toggles is on; `None` for other commands.
    pub fn is_on(&self, command: &Command, theme: Theme) -> Option<bool> {
        match command {
            Command::Player(PlayerCommand::ToggleLoop) => Some(self.playback.loops()),
            Command::View(ViewCommand::ToggleFollow) => {
                Some(self.rig.camera_mode() != CameraMode::Free)
            }
            Command::View(ViewCommand::ToggleOverlay(overlay)) => {
                Some(self.overlays.shows(*overlay))
            }
            Command::View(ViewCommand::ToggleSmoothEdges) => {
                Some(self.smoothing.iter().any(|msaa| *msaa != Msaa::Off))
            }
            Command::View(ViewCommand::ToggleTheme) => Some(theme == Theme::Dark),
            Command::Stage(StageCommand::ToggleFollowEvolution) => {
                Some(self.following.follows_evolution())
            }
            _ => None,
        }
    }
}
