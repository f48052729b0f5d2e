//! State of the camera: mode, view, and what it follows.

use bevy::prelude::*;

use super::view::CameraView;
use crate::studio::commands::camera_mode::CameraMode;

/// Distance of the camera from a point that was double-clicked, in metres.
const FOCUS_M: f32 = 12.0;
/// Rotation by hand after which the view no longer counts as that of its camera mode, in radians.
const TURNED_RAD: f32 = 0.05;

/// State of the camera: mode, view, and what it follows.
#[derive(Resource, Debug, Clone)]
pub(crate) struct CameraRig {
    pub camera_mode: CameraMode,
    /// Target view of the camera.
    pub view: CameraView,
    /// Current view of the camera, which approaches the target view.
    pub(super) shown: CameraView,
    /// Lane that the camera follows; `None` for all lanes.
    pub(super) lane: Option<usize>,
    /// Smoothed position of the followed snakes, in metres; `None` before the first frame.
    pub(super) anchor: Option<Vec3>,
    pub(super) lanes: usize,
}

impl Default for CameraRig {
    fn default() -> Self {
        let view = CameraView::of(CameraMode::Follow, 1);
        Self {
            camera_mode: CameraMode::Follow,
            view,
            shown: view,
            lane: None,
            anchor: None,
            lanes: 1,
        }
    }
}

impl CameraRig {
    /// Switches to a camera mode.
    pub fn take(&mut self, camera_mode: CameraMode) {
        self.camera_mode = camera_mode;
        if self.follows() {
            // Wrap the current yaw, so that the camera turns the short way.
            let turn = std::f32::consts::TAU;
            self.shown.yaw_rad -= libm::roundf(self.shown.yaw_rad / turn) * turn;
            self.view = CameraView::of(camera_mode, self.lanes);
            self.lane = None;
        } else {
            // The free camera keeps its current view.
            self.view = self.shown;
        }
    }

    /// Updates the mode after the view was turned by hand: a turned view from the side or from above becomes a
    /// following view at an angle.
    pub(super) fn turned_by_hand(&mut self) {
        let own = CameraView::of(self.camera_mode, self.lanes);
        let (yaw_rad, pitch_rad) = (self.view.yaw_rad, self.view.pitch_rad);
        let off_rad = match self.camera_mode {
            CameraMode::Side => {
                (yaw_rad - own.yaw_rad).abs().max((pitch_rad - own.pitch_rad).abs())
            }
            // A view that is turned only about the vertical axis is still from above.
            CameraMode::Top => (pitch_rad - own.pitch_rad).abs(),
            CameraMode::Follow | CameraMode::Free => 0.0,
        };
        if off_rad > TURNED_RAD {
            self.camera_mode = CameraMode::Follow;
        }
    }

    /// Focuses on a lane's snake or, if `lane` is `None`, on a fixed point, in metres.
    pub fn focus_on(&mut self, lane: Option<usize>, point: Vec3) {
        self.view.distance_m = self.view.distance_m.min(FOCUS_M);
        self.lane = lane;
        if lane.is_some() {
            self.view.offset = Vec3::ZERO;
            self.camera_mode = CameraMode::Follow;
        } else {
            self.camera_mode = CameraMode::Free;
            // The offset starts at the current target, so that the camera glides to the point.
            self.view.offset = point - self.anchor.unwrap_or_default();
        }
    }

    /// Returns whether the camera follows one snake or all snakes.
    pub(super) fn follows(&self) -> bool {
        self.camera_mode != CameraMode::Free
    }

    /// Returns the current transform of the camera.
    pub fn place(&self) -> Transform {
        self.shown.looking_at(self.anchor.unwrap_or_default() + self.shown.offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_turned_by_hand_is_no_longer_the_one_from_the_side_or_from_above() {
        let turned = |camera_mode: CameraMode, yaw_rad: f32, pitch_rad: f32| {
            let mut rig = CameraRig::default();
            rig.take(camera_mode);
            rig.view.yaw_rad += yaw_rad;
            rig.view.pitch_rad += pitch_rad;
            rig.view.distance_m /= 2.0;
            rig.turned_by_hand();
            (rig.camera_mode, rig.follows())
        };
        assert_eq!(turned(CameraMode::Side, 0.0, 0.0), (CameraMode::Side, true), "only nearer");
        assert_eq!(turned(CameraMode::Side, 0.3, 0.0), (CameraMode::Follow, true));
        assert_eq!(turned(CameraMode::Side, 0.0, 0.3), (CameraMode::Follow, true));
        assert_eq!(turned(CameraMode::Top, 0.3, 0.0), (CameraMode::Top, true), "still above");
        assert_eq!(turned(CameraMode::Top, 0.0, -0.3), (CameraMode::Follow, true));
        assert_eq!(turned(CameraMode::Free, 0.3, 0.3), (CameraMode::Free, false));
    }
}
