//! Executes the commands to the view of the stage.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::camera::rig::CameraRig;
use super::overlays::Overlays;
use super::quality::StageQuality;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::{ScreenshotArea, ViewCommand};
use crate::studio::state::shares::StageLook;
use crate::studio::ui::theme::Theme;

/// System parameters that make up the state of the view.
#[derive(SystemParam)]
pub(crate) struct ViewParams<'w> {
    pub rig: ResMut<'w, CameraRig>,
    overlays: ResMut<'w, Overlays>,
    theme: ResMut<'w, Theme>,
    screenshots: MessageWriter<'w, ScreenshotArea>,
    quality: ResMut<'w, StageQuality>,
}

impl ViewParams<'_> {
    /// Returns the look of the stage, for an exported film: camera mode, theme and overlays.
    pub fn look(&self) -> StageLook {
        StageLook {
            camera: self.rig.camera_mode,
            theme: *self.theme,
            overlays: self.overlays.iter().copied().collect(),
        }
    }

    /// Executes a command to the view.
    pub fn apply(&mut self, command: &ViewCommand) {
        match command {
            ViewCommand::SetCamera(camera_mode) => self.rig.take(*camera_mode),
            ViewCommand::NextCameraMode => {
                let next = self.rig.camera_mode.next();
                self.rig.take(next);
            }
            ViewCommand::ToggleFollow => {
                let is_free = self.rig.camera_mode == CameraMode::Free;
                self.rig.take(if is_free { CameraMode::Follow } else { CameraMode::Free });
            }
            ViewCommand::ResetCamera => self.rig.take(CameraMode::Follow),
            ViewCommand::ToggleOverlay(overlay) => self.overlays.toggle(*overlay),
            ViewCommand::SetQuality(quality) => self.quality.chosen = *quality,
            ViewCommand::NextQuality => self.quality.choose_next(),
            ViewCommand::ToggleTheme => *self.theme = self.theme.other(),
            ViewCommand::TakePicture(area) => {
                self.screenshots.write(*area);
            }
        }
    }
}
