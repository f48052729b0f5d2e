//! What a limb looks like: a rounded block with a stripe along its top, the joints' metal at its ends, eyes on the
//! head.
//!
//! A block is drawn a few centimetres shorter than it is where a joint is, so that the joint shows: a pin across
//! the front limb, about which it bends, and a collar on the rear limb, in which it twists. A twisted snake's
//! stripes do not line up. Nothing of this touches the physics.

use bevy::prelude::*;

use super::solid::Solid;

/// What decides how a limb looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LimbShape {
    /// Its physical size across x, along y and along z, in metres.
    pub size: Vec3,
    /// Whether a limb is in front of it; the head has none.
    pub has_front: bool,
    /// Whether a limb is behind it; the tail has none.
    pub has_rear: bool,
}

/// How much shorter a limb is drawn at a joint, in metres.
const CUT_M: f32 = 0.07;
/// Radius of the edges, as a share of the least side.
const EDGE: f32 = 0.10;
/// How far paint is above what it is painted on, in metres, so that neither hides the other.
const PAINT_M: f32 = 0.006;
/// How far the pin looks out of a limb's sides, in metres.
const PIN_END_M: f32 = 0.025;

impl LimbShape {
    /// The least side across: what joints and eyes are measured by.
    fn thickness_m(&self) -> f32 {
        self.size.x.min(self.size.z)
    }

    /// How much is missing at the front and at the rear, in metres.
    fn cuts_m(&self) -> [f32; 2] {
        let cut_m = CUT_M.min(self.size.y * 0.15);
        [self.has_front, self.has_rear].map(|has| if has { cut_m } else { 0.0 })
    }

    fn edge_m(&self) -> f32 {
        self.size.min_element() * EDGE
    }

    /// The block, in the snake's red or blue.
    pub fn block(&self) -> Solid {
        let [front, rear] = self.cuts_m();
        let size = self.size - Vec3::Y * (front + rear);
        let mut solid = Solid::default();
        solid.rounded_box(Vec3::Y * (rear - front) / 2.0, size, self.edge_m(), 3);
        solid
    }

    /// What is white: the stripe, the eyes.
    pub fn white(&self) -> Solid {
        let mut solid = Solid::default();
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

    /// What is dark: the joints' metal, the pupils.
    pub fn dark(&self) -> Solid {
        let mut solid = Solid::default();
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

    /// Where the head's eyes are: on top, so that they are seen from everywhere.
    fn eyes(&self) -> [Vec3; 2] {
        let radius = self.eye_m();
        let (y, z) = (self.size.y / 2.0 - radius * 1.7, self.size.z / 2.0 + radius * 0.25);
        [-1.0, 1.0].map(|side| Vec3::new(side * self.size.x * 0.26, y, z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::solid::tests::closed_volume;

    const SIZE: Vec3 = Vec3::new(1.0, 2.0, 1.0);

    fn reach_y_m(solid: &Solid) -> [f32; 2] {
        let ys = || solid.positions.iter().map(|at| at.y);
        [ys().fold(f32::MAX, f32::min), ys().fold(f32::MIN, f32::max)]
    }

    #[test]
    fn a_block_is_shorter_only_where_a_joint_is() {
        let head = LimbShape { size: SIZE, has_front: false, has_rear: true };
        let [rear, front] = reach_y_m(&head.block());
        assert!((front - 1.0).abs() < 1.0e-5 && (rear + 1.0 - CUT_M).abs() < 1.0e-5);
        assert!(closed_volume(&head.block()) > 0.9 * SIZE.element_product());
    }

    #[test]
    fn a_limb_too_short_for_a_gap_and_one_without_joints_are_drawn_too() {
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
