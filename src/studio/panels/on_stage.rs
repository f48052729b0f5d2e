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
    /// Returns a rectangle around each limb of a lane in the window, from the head, in points; `None` for a limb that
    /// the camera does not see.
    pub fn limbs_in_window(&self, context: &egui::Context, lane: &Lane) -> Vec<Option<egui::Rect>> {
        let Ok((camera, place)) = self.camera.single() else { return Vec::new() };
        let place = GlobalTransform::from(*place);
        let point_of = |at: Vec3| {
            let pixel = camera.world_to_viewport(&place, at + lane.offset()).ok()?;
            let point = pixel / context.zoom_factor();
            Some(egui::pos2(point.x, point.y))
        };
        let parts = lane.drawn_poses().zip(&lane.body.parts);
        let around = parts.map(|(pose, plan)| {
            let half = Vec3::from(plan.size_m()) / 2.0;
            let ends = [-1.0, 1.0];
            let corners = ends.into_iter().flat_map(|x| {
                ends.into_iter().flat_map(move |y| ends.map(|z| Vec3::new(x, y, z) * half))
            });
            let points: Option<Vec<egui::Pos2>> =
                corners.map(|corner| point_of(pose * corner)).collect();
            points.map(|points| egui::Rect::from_points(&points))
        });
        let around: Vec<Option<egui::Rect>> = around.collect();
        let limb = |limb: usize| {
            let parts = around.get(lane.body.parts_of(limb)).unwrap_or_default();
            let parts: Option<Vec<egui::Rect>> = parts.iter().copied().collect();
            parts?.into_iter().reduce(egui::Rect::union)
        };
        (0..lane.body.limbs()).map(limb).collect()
    }

    /// Returns whether the setting that a command toggles is on, or `None` for other commands.
    pub fn is_on(&self, command: &Command, theme: Theme) -> Option<bool> {
        match command {
            Command::Player(PlayerCommand::ToggleLoop) => Some(self.playback.loops),
            Command::View(ViewCommand::ToggleFollow) => {
                Some(self.rig.camera_mode() != CameraMode::Free)
            }
            Command::View(ViewCommand::ToggleOverlay(overlay)) => {
                Some(self.overlays.shows(*overlay))
            }
            Command::View(ViewCommand::ToggleTheme) => Some(theme == Theme::Dark),
            _ => None,
        }
    }
}
