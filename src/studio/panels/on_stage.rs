//! State of the stage that the panels read.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_egui::egui;

use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::{Command, PlayerCommand, ViewCommand};
use crate::studio::scene::camera::StageCamera;
use crate::studio::scene::camera::rig::CameraRig;
use crate::studio::scene::overlays::Overlays;
use crate::studio::scene::quality::StageQuality;
use crate::studio::scene::stage_view::StageView;
use crate::studio::scene::way_back::WayBack;
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
    pub way_back: Res<'w, WayBack>,
    pub quality: Res<'w, StageQuality>,
    camera: Query<'w, 's, (&'static Camera, &'static Transform), With<StageCamera>>,
}

impl OnStage<'_, '_> {
    /// Returns what the stage's camera sees, if there is a camera.
    pub fn view(&self, context: &egui::Context) -> Option<StageView<'_>> {
        let (camera, place) = self.camera.single().ok()?;
        Some(StageView::new(camera, place, context))
    }

    /// Returns whether the setting that a command toggles is on, or `None` for other commands.
    pub fn is_on(&self, command: &Command, theme: Theme) -> Option<bool> {
        match command {
            Command::Player(PlayerCommand::ToggleLoop) => Some(self.playback.loops),
            Command::View(ViewCommand::ToggleFollow) => {
                Some(self.rig.camera_mode != CameraMode::Free)
            }
            Command::View(ViewCommand::ToggleOverlay(overlay)) => {
                Some(self.overlays.contains(overlay))
            }
            Command::View(ViewCommand::ToggleTheme) => Some(theme == Theme::Dark),
            _ => None,
        }
    }
}
