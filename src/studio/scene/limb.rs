//! Shape of a limb: a rounded block with a stripe along its top, metal joints at its ends, and eyes on the head.
//!
//! Blocks are drawn a few centimetres shorter at joints, so that the joints show: a pin across the front limb for
//! bending, and a collar on the rear limb for twisting. The stripes show a twist. The physics ignores all of this.

use bevy::prelude::*;

use super::mesh_builder::MeshBuilder;

/// Parameters of a limb's shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LimbShape {
    /// Its physical size across x, along y and along z, in metres.
    pub size: Vec3,
    /// Whether another limb is in front of it; false for the head.
    pub has_front: bool,
    /// Whether another limb is behind it; false for the tail.
    pub has_rear: bool,
}

/// Gap at a joint on each limb, in metres.
const CUT_M: f32 = 0.07;
/// Radius of the edges, as a fraction of the smallest side.
const EDGE: f32 = 0.10;
/// Height of paint above its surface, in metres, to avoid z-fighting.
const PAINT_M: f32 = 0.006;
/// Length of the pin outside a limb's sides, in metres.
const PIN_END_M: f32 = 0.025;

impl LimbShape {
    /// Smaller side of the cross-section, which scales joints and eyes.
    fn thickness_m(&self) -> f32 {
        self.size.x.min(self.size.z)
    }

    /// Gaps at the front and at the rear, in metres.
    fn cuts_m(&self) -> [f32; 2] {
        let cut_m = CUT_M.min(self.size.y * 0.15);
        [self.has_front, self.has_rear].map(|has| if has { cut_m } else { 0.0 })
    }

    fn edge_m(&self) -> f32 {
        self.size.min_element() * EDGE
    }

    /// The block, in the snake's red or blue.
    pub fn block(&self) -> MeshBuilder {
        let [front, rear] = self.cuts_m();
        let size = self.size - Vec3::Y * (front + rear);
        let mut solid = MeshBuilder::default();
        solid.rounded_box(Vec3::Y * (rear - front) / 2.0, size, self.edge_m(), 3);
        solid
    }

    /// White parts: stripe and eyes.
    pub fn white(&self) -> MeshBuilder {
        let mut solid = MeshBuilder::default();
        let [front, rear] = self.cuts_m();
        // The head's stripe ends behind the eyes.
        let front = if self.has_front { front + self.edge_m() } else { self.eye_m() * 3.2 };
        let rear = rear + self.edge_m();
        let length = (self.size.y - front - rear).max(0.0);
        let centre = Vec3::new(0.0, (rear - front) / 2.0, self.size.z / 2.0 + PAINT_M);
        solid.sheet(centre, Vec3::X * self.thickness_m() * 0.07, Vec3::Y * length / 2.0);
        if !self.has_front {
            self.eyes().into_iter().for_each(|eye| solid.ball(eye, self.eye_m()));
        }
        solid
    }

    /// Dark parts: joints and pupils.
    pub fn dark(&self) -> MeshBuilder {
        let mut solid = MeshBuilder::default();
        let (thickness, half) = (self.thickness_m(), self.size.y / 2.0);
        let [front, rear] = self.cuts_m();
        if self.has_rear {
            let joint = Vec3::Y * -half;
            let end = Vec3::X * (self.size.x / 2.0 + PIN_END_M);
            solid.cylinder(joint - end, joint + end, thickness * 0.13);
            solid.cylinder(joint, joint + Vec3::Y * rear * 1.2, thickness * 0.22);
        }
        if self.has_front {
            let joint = Vec3::Y * half;
            solid.cylinder(joint - Vec3::Y * front * 1.2, joint, thickness * 0.34);
        } else {
            for eye in self.eyes() {
                let gaze = Vec3::new(eye.x.signum() * 0.75, 0.7, 0.3).normalize();
                solid.ball(eye + gaze * self.eye_m() * 0.5, self.eye_m() * 0.64);
            }
        }
        solid
    }

    fn eye_m(&self) -> f32 {
        self.thickness_m() * 0.19
    }

    /// Positions of the eyes: on top of the head, visible from all sides.
    fn eyes(&self) -> [Vec3; 2] {
        let radius = self.eye_m();
        let (y, z) = (self.size.y / 2.0 - radius * 1.7, self.size.z / 2.0 + radius * 0.25);
        [-1.0, 1.0].map(|side| Vec3::new(side * self.size.x * 0.26, y, z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::scene::mesh_builder::tests::closed_volume;

    const SIZE: Vec3 = Vec3::new(1.0, 2.0, 1.0);

    fn reach_y_m(solid: &MeshBuilder) -> [f32; 2] {
        let ys = || solid.positions.iter().map(|at| at.y);
        [ys().fold(f32::MAX, f32::min), ys().fold(f32::MIN, f32::max)]
    }

    #[test]
    fn a_block_is_shorter_only_at_joints() {
        let head = LimbShape { size: SIZE, has_front: false, has_rear: true };
        let [rear, front] = reach_y_m(&head.block());
        assert!((front - 1.0).abs() < 1.0e-5 && (rear + 1.0 - CUT_M).abs() < 1.0e-5);
        assert!(closed_volume(&head.block()) > 0.9 * SIZE.element_product());
    }

    #[test]
    fn very_short_and_jointless_limbs_are_drawn() {
        let short = Vec3::new(1.0, 0.1, 1.0);
        for has_front in [false, true] {
            for has_rear in [false, true] {
                let shape = LimbShape { size: short, has_front, has_rear };
                assert!(closed_volume(&shape.block()) > 0.0);
                let parts = [shape.block(), shape.white(), shape.dark()];
                let positions = parts.iter().flat_map(|solid| &solid.positions);
                assert!(positions.clone().all(|at| at.is_finite()));
            }
        }
    }
}
