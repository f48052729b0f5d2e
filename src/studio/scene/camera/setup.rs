//! A camera's setup, kept while the presenting mode moves the camera by itself.

use bevy::prelude::*;

use super::rig::CameraRig;
use super::view::CameraView;
use crate::studio::commands::camera_mode::CameraMode;

/// Mode and view of a camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CameraSetup {
    camera_mode: CameraMode,
    view: CameraView,
    lane: Option<usize>,
    anchor: Option<Vec3>,
    /// Whether it was a view of several lanes.
    are_many: bool,
}

impl CameraRig {
    /// The current setup.
    pub fn setup(&self) -> CameraSetup {
        CameraSetup {
            camera_mode: self.camera_mode,
            view: self.view,
            lane: self.lane,
            anchor: self.anchor,
            are_many: self.lanes > 1,
        }
    }

    /// Returns to an earlier setup. If the stage has one lane instead of several meanwhile, or the other way round,
    /// only the mode comes back, because the view would not suit them.
    pub fn restore(&mut self, setup: CameraSetup) {
        self.take(setup.camera_mode);
        let is_free = setup.camera_mode == CameraMode::Free;
        if !is_free && setup.are_many != (self.lanes > 1) {
            return;
        }
        (self.view, self.shown, self.lane) = (setup.view, setup.view, setup.lane);
        if is_free {
            // A free camera stands where it stood; a following one is with its snake at once.
            self.anchor = setup.anchor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_camera_comes_back_to_its_place() {
        let mut rig = CameraRig { anchor: Some(Vec3::new(0.0, -7.0, 0.5)), ..CameraRig::default() };
        rig.take(CameraMode::Free);
        rig.view.yaw_rad = 0.3;
        rig.shown = rig.view;
        let (setup, place) = (rig.setup(), rig.place());
        rig.take(CameraMode::Follow);
        rig.anchor = Some(Vec3::new(0.0, 20.0, 5.0));
        rig.restore(setup);
        assert_eq!((rig.place(), rig.camera_mode()), (place, CameraMode::Free));
        assert!(!rig.follows);
    }

    #[test]
    fn a_turned_camera_follows_again_with_the_same_view_unless_other_lanes_are_on_stage() {
        let mut rig = CameraRig::default();
        rig.view.yaw_rad = 0.3;
        let setup = rig.setup();
        rig.take(CameraMode::Follow);
        rig.restore(setup);
        assert_eq!(rig.view, setup.view);
        rig.lanes = 3;
        rig.restore(setup);
        assert_eq!(rig.view, CameraView::of(CameraMode::Follow, 3));
    }
}
