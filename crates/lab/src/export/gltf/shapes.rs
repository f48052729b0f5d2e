//! Triangles of limbs, eyes and stairs, with normals. They are counterclockwise seen from outside.

use std::f32::consts::{PI, TAU};

use crate::export::rounded_box::RoundedBox;
use snakes_core::world::{StairSolid, Vector};

/// Vertices and triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct TriangleSet {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
}

/// Cells of a rounded edge.
const EDGE_CELLS: usize = 3;
/// Radius of the edges as a share of the smallest side, as in the studio.
const EDGE: f32 = 0.2;
/// Sides of a ball.
const SIDES: usize = 16;

impl TriangleSet {
    /// A grid of cells. Seen from outside, rows go up if columns go to the right.
    fn patch(&mut self, columns: usize, rows: usize, at: impl Fn(usize, usize) -> [Vector; 2]) {
        let first = self.positions.len() as u32;
        for row in 0..=rows {
            for column in 0..=columns {
                let [position, normal] = at(column, row);
                self.positions.push(position.to_array());
                self.normals.push(normal.to_array());
            }
        }
        let across = columns as u32 + 1;
        for row in 0..rows as u32 {
            for column in 0..columns as u32 {
                let low = first + row * across + column;
                let high = low + across;
                self.indices.extend([low, low + 1, high + 1, low, high + 1, high]);
            }
        }
    }

    /// A flat rectangle; `right` and `up` lead from its centre to the middle of its edges.
    pub fn rectangle(&mut self, centre: Vector, right: Vector, up: Vector) {
        let normal = right.cross(up).normalize_or_zero();
        let side = |index: usize| index as f32 * 2.0 - 1.0;
        self.patch(1, 1, |column, row| [centre + right * side(column) + up * side(row), normal]);
    }

    /// A box with sharp edges, without the face on which it stands.
    pub fn step(&mut self, solid: &StairSolid) {
        let (centre, turn) = (solid.pose.translation, solid.pose.rotation);
        let half = solid.half_m;
        let [x, y, z] =
            [Vector::X * half.x, Vector::Y * half.y, Vector::Z * half.z].map(|to| turn * to);
        for (out, right, up) in [(x, y, z), (-x, -y, z), (y, -x, z), (-y, x, z), (z, x, y)] {
            self.rectangle(centre + out, right, up);
        }
    }

    /// A box with rounded edges around the origin.
    pub fn rounded_box(size: Vector) -> Self {
        let rounded = RoundedBox::new(size.to_array(), size.min_element() * EDGE, EDGE_CELLS);
        let mut shape = Self::default();
        for face in RoundedBox::faces() {
            shape.patch(rounded.cells(), rounded.cells(), |column, row| {
                rounded.corner(face, column, row).map(Vector::from)
            });
        }
        shape
    }

    /// A ball.
    pub fn ball(&mut self, centre: Vector, radius: f32) {
        let rows = SIDES / 2;
        self.patch(SIDES, rows, |side, row| {
            let (sin, cos) = libm::sincosf(TAU * side as f32 / SIDES as f32);
            let (rise, reach) = libm::sincosf(PI * (row as f32 / rows as f32 - 0.5));
            let out = Vector::new(cos * reach, sin * reach, rise);
            [centre + out * radius, out.normalize()]
        });
        self.remove_flat();
    }

    /// Removes triangles without area, as at the poles of a ball.
    fn remove_flat(&mut self) {
        let positions = &self.positions;
        let at = |index: u32| Vector::from(positions[index as usize]);
        let has_area = |corners: &&[u32]| {
            let [a, b, c] = [at(corners[0]), at(corners[1]), at(corners[2])];
            a.distance(b) > 1.0e-6 && b.distance(c) > 1.0e-6 && c.distance(a) > 1.0e-6
        };
        self.indices = self.indices.chunks(3).filter(has_area).flatten().copied().collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::world::Pose;

    /// The enclosed volume in m³; triangles that face inward count negative.
    fn volume_m3(shape: &TriangleSet) -> f32 {
        let at = |index: u32| Vector::from(shape.positions[index as usize]);
        let corners =
            shape.indices.chunks(3).map(|corners| [at(corners[0]), at(corners[1]), at(corners[2])]);
        corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    #[test]
    fn limbs_and_eyes_are_closed_and_face_outward() {
        let limb = TriangleSet::rounded_box(Vector::new(1.0, 2.0, 1.0));
        let volume = volume_m3(&limb);
        assert!((1.8..2.0).contains(&volume), "{volume} m³");
        for (position, normal) in limb.positions.iter().zip(&limb.normals) {
            assert!(Vector::from(*position).dot(Vector::from(*normal)) > 0.0);
        }
        let mut eye = TriangleSet::default();
        eye.ball(Vector::new(3.0, 0.0, 0.0), 0.5);
        let share = volume_m3(&eye) / (4.0 / 3.0 * PI * 0.125);
        assert!((0.9..1.0).contains(&share), "{share}");
    }

    #[test]
    fn a_step_has_five_faces_that_look_outward() {
        let mut shape = TriangleSet::default();
        let pose = Pose::from_translation(Vector::new(0.0, 1.0, 0.25));
        shape.step(&StairSolid { step: 0, pose, half_m: Vector::new(1.0, 1.0, 0.25) });
        assert_eq!(shape.indices.len(), 5 * 6);
        let centre = Vector::new(0.0, 1.0, 0.25);
        for corners in shape.indices.chunks(3) {
            let [a, b, c] =
                [0, 1, 2].map(|corner| Vector::from(shape.positions[corners[corner] as usize]));
            let facing = (b - a).cross(c - a);
            assert!(facing.dot(a - centre) > 0.0);
            assert!(
                facing.normalize().distance(Vector::from(shape.normals[corners[0] as usize]))
                    < 1e-6
            );
        }
    }
}
