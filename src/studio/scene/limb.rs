//! Shape of a limb: a rounded block with a stripe along its top, a light belly, hinges at its ends, and a face on the
//! head.
//!
//! Blocks are drawn a few centimetres shorter at joints, so that the hinges are visible. A drum and a pin across the
//! front limb show the bend axis; a collar on the rear limb shows the twist axis. The stripes show a twist. The physics
//! ignores all of these details.

use bevy::prelude::*;

use super::meshes::{BALL_SIDES, to_mesh, to_mesh_along};
use crate::studio::ui::theme::palette::{AXIS_TONE, BELLY_TONE, TONGUE_TONE};
use snakes_lab::mesh::{Eyes, LIMB_EDGE, MeshBuilder};

/// Parameters of a limb's drawn shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LimbShape {
    /// Physical size of the limb across x, along y and along z, in metres.
    pub size: Vec3,
    /// Whether another limb is in front of the limb; false for the head.
    pub has_front: bool,
    /// Whether another limb is behind the limb; false for the tail.
    pub has_rear: bool,
    /// Whether the hinge about which the limb bends is drawn on the limb, as in a creature, instead of on the limb in front of it.
    pub has_own_hinge: bool,
    /// Number of the limb's parts. A soft limb has several, and rounder edges.
    pub parts: usize,
}

/// Gap that a joint leaves at each of its limbs, in metres.
const CUT_M: f32 = 0.07;
/// Radius of the edges of a soft limb, as a fraction of the smallest side.
const SOFT_EDGE: f32 = 0.42;
/// Number of straight pieces along a soft limb, per part.
const PIECES: usize = 6;
/// Height of painted areas above the block's surface, in metres, to avoid z-fighting.
const PAINT_M: f32 = 0.006;
/// Length by which a hinge's pin stands out of the limb's sides, in metres.
const PIN_END_M: f32 = 0.035;
/// Height of the belly, as a fraction of the limb's height.
const BELLY: f32 = 0.26;

impl LimbShape {
    /// Returns the smaller side of the cross-section, in metres, which scales joints and eyes.
    fn thickness_m(&self) -> f32 {
        self.size.x.min(self.size.z)
    }

    /// Returns the gaps at the front and at the rear, in metres.
    fn cuts_m(&self) -> [f32; 2] {
        let cut_m = CUT_M.min(self.size.y * 0.15);
        [self.has_front, self.has_rear].map(|has| if has { cut_m } else { 0.0 })
    }

    fn edge_m(&self) -> f32 {
        self.size.min_element() * if self.parts > 1 { SOFT_EDGE } else { LIMB_EDGE }
    }

    /// Returns the centres of the parts along y, from the front, in metres.
    fn part_centres_m(&self) -> Vec<f32> {
        let part_m = self.size.y / self.parts.max(1) as f32;
        (0..self.parts).map(|part| self.size.y / 2.0 - part_m * (part as f32 + 0.5)).collect()
    }

    /// Builds the limb's mesh from a solid. The mesh of a soft limb follows the limb's parts: see [`Self::bind_poses`].
    pub fn mesh_of(&self, mut solid: MeshBuilder) -> Mesh {
        if self.parts < 2 {
            return to_mesh(solid);
        }
        let pieces = self.parts * PIECES;
        let piece_m = self.size.y / pieces as f32;
        let cuts = (1..pieces).map(|cut| self.size.y / 2.0 - piece_m * cut as f32);
        cuts.for_each(|y_m| solid.cut_at(y_m));
        to_mesh_along(solid, &self.part_centres_m())
    }

    /// Returns, for each part of a soft limb, the transform from the limb's frame to the part's frame at rest.
    pub fn bind_poses(&self) -> Vec<Mat4> {
        let to_part = |y_m: f32| Mat4::from_translation(Vec3::NEG_Y * y_m);
        self.part_centres_m().into_iter().map(to_part).collect()
    }

    /// Builds the block, which is red or blue.
    pub fn block(&self) -> MeshBuilder {
        let [front, rear] = self.cuts_m();
        let size = self.size - Vec3::Y * (front + rear);
        let mut solid = MeshBuilder::default();
        // Wider edges need more pieces, or else the belly would be hidden beneath them.
        let pieces = if self.parts > 1 { 10 } else { 4 };
        solid.rounded_box(Vec3::Y * (rear - front) / 2.0, size, self.edge_m(), pieces);
        solid
    }

    /// Builds the light details: stripe, belly, eyes and tongue.
    pub fn white(&self) -> MeshBuilder {
        let mut solid = MeshBuilder::default();
        let [front_cut, rear_cut] = self.cuts_m();
        // The stripe on the head ends behind the eyes.
        let front =
            if self.has_front { front_cut + self.edge_m() } else { self.eyes().radius_m * 3.4 };
        let rear = rear_cut + self.edge_m();
        let length = (self.size.y - front - rear).max(0.0);
        let centre = Vec3::new(0.0, (rear - front) / 2.0, self.size.z / 2.0 + PAINT_M);
        solid.tone(Vec3::ONE);
        solid.sheet(centre, Vec3::X * self.thickness_m() * 0.07, Vec3::Y * length / 2.0);
        if !self.has_front {
            self.eyes().add_to(&mut solid, BALL_SIDES);
            self.tongue(&mut solid);
        }
        solid.tone(BELLY_TONE);
        self.belly(&mut solid);
        solid
    }

    /// Adds the belly: a light band around the lower part, which follows the block's round edges.
    fn belly(&self, solid: &mut MeshBuilder) {
        // Number of strips of the band, from one side across the bottom to the other. Wide edges need more, or else the
        // band would cut into them.
        let strips = if self.parts > 1 { 40 } else { 14 };
        let [front, rear] = self.cuts_m();
        let edge_m = self.edge_m();
        let half_length = ((self.size.y - front - rear) / 2.0 - edge_m).max(0.0);
        let middle_y = (rear - front) / 2.0;
        let (half_x, half_z) = (self.size.x / 2.0, self.size.z / 2.0);
        let inner = Vec2::new(half_x - edge_m, half_z - edge_m).max(Vec2::ZERO);
        // Goes from the right end of the band to the left one: down the side, around the edge, along the bottom, and up again.
        let place = |strip: usize| {
            let share = strip as f32 / strips as f32;
            let side = if share < 0.5 { 1.0 } else { -1.0 };
            let along = 1.0 - (share - 0.5).abs() * 2.0;
            let (out, normal) = if along < 0.2 {
                let top = self.size.z * BELLY - half_z;
                let z = top + (-inner.y - top) * (along / 0.2).min(1.0);
                (Vec2::new(half_x, z.max(-inner.y)), Vec2::X)
            } else if along < 0.8 {
                let (sin, cos) = libm::sincosf((along - 0.2) / 0.6 * std::f32::consts::FRAC_PI_2);
                let normal = Vec2::new(cos, -sin);
                (Vec2::new(inner.x, -inner.y) + normal * edge_m, normal)
            } else {
                (Vec2::new(inner.x * (1.0 - along) / 0.2, -half_z), Vec2::NEG_Y)
            };
            let at = out + normal * PAINT_M;
            (Vec2::new(at.x * side, at.y), Vec2::new(normal.x * side, normal.y))
        };
        solid.patch(1, strips, |end, strip| {
            let (at, normal) = place(strips - strip);
            let y = middle_y + half_length * (end as f32 * 2.0 - 1.0);
            [Vec3::new(at.x, y, at.y), Vec3::new(normal.x, 0.0, normal.y)]
        });
    }

    /// Adds a forked tongue, which is visible from all sides.
    fn tongue(&self, solid: &mut MeshBuilder) {
        solid.tone(TONGUE_TONE);
        let unit = self.thickness_m();
        let root = Vec3::new(0.0, self.size.y / 2.0, -0.12 * self.size.z);
        let fork = root + Vec3::new(0.0, 0.16, -0.02) * unit;
        solid.cylinder(root - Vec3::Y * 0.05 * unit, fork, 0.035 * unit);
        for side in [1.0, -1.0] {
            solid.cylinder(fork, fork + Vec3::new(side * 0.07, 0.12, 0.03) * unit, 0.025 * unit);
        }
    }

    /// Builds the dark details: hinges and pupils.
    pub fn dark(&self) -> MeshBuilder {
        let mut solid = MeshBuilder::default();
        let (thickness, half) = (self.thickness_m(), self.size.y / 2.0);
        let [front, rear] = self.cuts_m();
        solid.tone(Vec3::ONE);
        // Place of the bend axis along y, and radii of its drum and its pin as fractions of the thickness.
        let (axis_y, drum, pin) = match self.has_own_hinge {
            true => (half, OWN_HINGE, OWN_HINGE * 0.5),
            false => (-half, 0.2, 0.085),
        };
        let (joint, has_hinge) = (Vec3::Y * axis_y, self.has_rear || self.has_own_hinge);
        if has_hinge {
            // The drum fills the gap that a strong bend opens.
            let end = Vec3::X * (self.size.x * 0.34);
            solid.cylinder(joint - end, joint + end, thickness * drum);
        }
        if self.has_rear {
            for side in [1.0, -1.0] {
                // The lug on each side holds the pin.
                let lug = Vec3::new(side * self.size.x * 0.42, -half + rear * 0.9, 0.0);
                let size = Vec3::new(self.size.x * 0.08, rear * 2.6, thickness * 0.3);
                solid.rounded_box(lug, size, size.x * 0.4, 1);
            }
        }
        if self.has_front {
            let joint = Vec3::Y * half;
            solid.cylinder(joint - Vec3::Y * front * 1.6, joint, thickness * 0.3);
        } else {
            self.eyes().add_pupils_to(&mut solid, BALL_SIDES);
        }
        if has_hinge {
            // The bend axis is a bright pin that stands out at both sides.
            solid.tone(AXIS_TONE);
            let end = Vec3::X * (self.size.x / 2.0 + PIN_END_M);
            solid.cylinder(joint - end, joint + end, thickness * pin);
        }
        solid
    }

    /// Builds a ring around the head, in the colour of the snake's lane.
    pub fn collar(&self) -> MeshBuilder {
        let mut solid = MeshBuilder::default();
        let band = self.thickness_m() * COLLAR_OUT;
        let size = Vec3::new(self.size.x + band, self.size.y * 0.13, self.size.z + band);
        // The ring is behind the middle of the head, where a neck would be.
        solid.rounded_box(Vec3::NEG_Y * self.size.y * 0.2, size, self.edge_m(), 3);
        solid
    }

    fn eyes(&self) -> Eyes {
        Eyes::of(self.size, self.edge_m())
    }
}

/// Radius of the hinge on a creature's limb, as a fraction of the limb's thickness.
const OWN_HINGE: f32 = 0.12;
/// Thickness that a collar adds to the head's, as a fraction of the head's thickness.
const COLLAR_OUT: f32 = 0.07;

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec3 = Vec3::new(1.0, 2.0, 1.0);
    const HEAD: LimbShape =
        LimbShape { size: SIZE, has_front: false, has_rear: true, has_own_hinge: false, parts: 1 };

    fn reach(solid: &MeshBuilder, along: impl Fn(&Vec3) -> f32) -> [f32; 2] {
        let places = || solid.positions.iter().map(&along);
        [places().fold(f32::MAX, f32::min), places().fold(f32::MIN, f32::max)]
    }

    #[test]
    fn a_block_is_shorter_only_at_joints() {
        let [rear, front] = reach(&HEAD.block(), |at| at.y);
        assert!((front - 1.0).abs() < 1.0e-5 && (rear + 1.0 - CUT_M).abs() < 1.0e-5);
        assert!(HEAD.block().volume_m3() > 0.88 * SIZE.element_product());
    }

    #[test]
    fn a_soft_limb_is_cut_into_pieces_that_follow_its_parts() {
        let soft = LimbShape { parts: 3, ..HEAD };
        let mut pieces = soft.block();
        (1..18).for_each(|cut| pieces.cut_at(1.0 - cut as f32 / 9.0));
        let mesh = soft.mesh_of(soft.block());
        let count = mesh.count_vertices();
        assert_eq!(count, pieces.positions.len());
        for attribute in [Mesh::ATTRIBUTE_JOINT_INDEX, Mesh::ATTRIBUTE_JOINT_WEIGHT] {
            assert_eq!(mesh.attribute(attribute).map(|values| values.len()), Some(count));
        }
        let at_rest: Vec<f32> =
            soft.bind_poses().iter().map(|way| way.transform_point3(Vec3::ZERO).y).collect();
        assert!((at_rest[0] + 2.0 / 3.0).abs() < 1e-6 && at_rest[1].abs() < 1e-6);
    }

    #[test]
    fn eyes_and_the_axis_of_a_joint_are_seen_from_the_side() {
        // The Side view shows only what stands out of the side faces.
        let of_eyes = |at: &Vec3| if at.y > 0.4 { at.x } else { 0.0 };
        let [left, right] = reach(&HEAD.white(), of_eyes);
        assert!(left < -0.6 && right > 0.6, "{left} to {right}");
        let of_axis = |at: &Vec3| if at.y < -0.8 { at.x } else { 0.0 };
        let [left, right] = reach(&HEAD.dark(), of_axis);
        assert!(left < -0.52 && right > 0.52, "{left} to {right}");
    }

    #[test]
    fn the_belly_lies_just_below_the_block() {
        let below = HEAD.white().positions.into_iter().filter(|at| at.z < -0.4);
        let lowest_m = below.map(|at| at.z).fold(0.0, f32::min);
        assert!((-0.51..-0.5).contains(&lowest_m), "{lowest_m}");
    }

    #[test]
    fn very_short_and_jointless_limbs_are_drawn() {
        let short = Vec3::new(1.0, 0.1, 1.0);
        for has_front in [false, true] {
            for has_rear in [false, true] {
                let (size, has_own_hinge) = (short, has_front && !has_rear);
                let shape = LimbShape { size, has_front, has_rear, has_own_hinge, parts: 1 };
                assert!(shape.block().volume_m3() > 0.0);
                let parts = [shape.block(), shape.white(), shape.dark(), shape.collar()];
                let positions = parts.iter().flat_map(|solid| &solid.positions);
                assert!(positions.clone().all(|at| at.is_finite()));
            }
        }
    }
}
