//! Places of the scene in the window, as the stage's camera shows them.

use bevy::prelude::*;
use bevy_egui::egui;

use super::landing::gate;
use crate::studio::stage::lane::Lane;

/// View of the stage's camera.
pub(crate) struct StageView<'a> {
    camera: &'a Camera,
    place: GlobalTransform,
    pixels_per_point: f32,
}

impl<'a> StageView<'a> {
    /// Creates the view of a camera at `place`.
    pub fn new(camera: &'a Camera, place: &Transform, context: &egui::Context) -> Self {
        Self { camera, place: (*place).into(), pixels_per_point: context.zoom_factor() }
    }

    /// Returns the place of a point of the scene in the window, in egui points; `None` behind the camera.
    pub fn point_of(&self, at: Vec3) -> Option<egui::Pos2> {
        let point = self.camera.world_to_viewport(&self.place, at).ok()? / self.pixels_per_point;
        Some(egui::pos2(point.x, point.y))
    }

    /// Returns the rectangle around a box with this half size, in egui points. `to_scene` moves the box from the origin to its place.
    fn around(&self, half: Vec3, to_scene: impl Fn(Vec3) -> Vec3) -> Option<egui::Rect> {
        let sign = |corner: u8| [1, 2, 4].map(|axis| if corner & axis == 0 { -1.0 } else { 1.0 });
        let corner = |corner| self.point_of(to_scene(Vec3::from(sign(corner)) * half));
        Some(egui::Rect::from_points(&(0..8).map(corner).collect::<Option<Vec<_>>>()?))
    }

    /// Returns the rectangle around a limb of a lane; the head is 0. `None` if the camera does not see all of it.
    pub fn limb(&self, lane: &Lane, limb: usize) -> Option<egui::Rect> {
        let parts = lane.body.parts_of(limb);
        let of_limb = lane.drawn_poses().zip(&lane.body.parts).skip(parts.start).take(parts.len());
        let around = of_limb.map(|(pose, plan)| {
            self.around(Vec3::from(plan.size_m()) / 2.0, |at| pose * at + lane.offset())
        });
        around.reduce(|all, part| Some(all?.union(part?)))?
    }

    /// Returns the rectangle around the gate at the top of a lane's stairs. `None` without stairs, or if the camera does not see all of it.
    pub fn gate(&self, lane: &Lane) -> Option<egui::Rect> {
        let [middle, half] = gate(&lane.trial().stairs)?;
        self.around(half, |at| middle + at + lane.offset())
    }
}
