//! Meshes of limbs, stairs and fittings, for the window and for animated scenes.
//!
//! A mesh consists of a few curved patches that form one body. Bodies are closed or flat. Triangles are counterclockwise seen from
//! outside.

mod eyes;
mod outlines;
mod rounded_box;

use std::f32::consts::{PI, TAU};

use rounded_box::RoundedBox;
use snakes_core::world::Vector;

pub use eyes::Eyes;
pub use outlines::Outlines;

/// Radius of the edges of a rigid limb, as a share of its smallest side.
pub const LIMB_EDGE: f32 = 0.2;

/// Builder for the vertices and triangles of a mesh.
#[derive(Debug, Clone, Default)]
pub struct MeshBuilder {
    /// Positions of the vertices, in metres.
    pub positions: Vec<Vector>,
    /// Normal of each vertex.
    pub normals: Vec<Vector>,
    /// Indices of the vertices, three for each triangle.
    pub indices: Vec<u32>,
    /// Factor on the material's colour at each vertex.
    tones: Vec<Vector>,
    /// Factor for the vertices that are added next; `None` leaves the material's colour unchanged.
    tone: Option<Vector>,
}

/// Number of sides of a cylinder.
const SIDES: usize = 14;
/// Distance from a plane within which a corner counts as on the plane, in metres.
const SLIVER_M: f32 = 1.0e-4;

impl MeshBuilder {
    /// Adds a patch of `columns` by `rows` cells. `at` gives the position and normal of a corner. Seen from outside, rows go up if
    /// columns go to the right.
    pub fn patch(&mut self, columns: usize, rows: usize, at: impl Fn(usize, usize) -> [Vector; 2]) {
        let first = self.positions.len() as u32;
        for row in 0..=rows {
            for column in 0..=columns {
                let [position, normal] = at(column, row);
                self.positions.push(position);
                self.normals.push(normal);
                self.tones.push(self.tone.unwrap_or(Vector::ONE));
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

    /// Sets the factor on the material's colour, in linear light, for the vertices that are added next.
    pub fn tone(&mut self, factor: Vector) {
        self.tone = Some(factor);
    }

    /// Multiplies the tone of every vertex so far by a factor of its position.
    pub fn shade(&mut self, factor: impl Fn(Vector) -> f32) {
        self.tone.get_or_insert(Vector::ONE);
        let shaded = self.tones.iter_mut().zip(&self.positions);
        shaded.for_each(|(tone, at)| *tone *= factor(*at));
    }

    /// Adds a flat rectangle around `centre`. `right` and `up` lead from the centre to the middle of two edges.
    pub fn sheet(&mut self, centre: Vector, right: Vector, up: Vector) {
        let normal = right.cross(up).normalize_or_zero();
        let share = |of: usize| of as f32 * 2.0 - 1.0;
        self.patch(1, 1, |column, row| [centre + right * share(column) + up * share(row), normal]);
    }

    /// Adds a flat triangle. Its corners are counterclockwise seen from outside.
    pub fn triangle(&mut self, corners: [Vector; 3]) {
        let first = self.positions.len() as u32;
        let [a, b, c] = corners;
        self.positions.extend(corners);
        self.normals.extend([(b - a).cross(c - a).normalize_or_zero(); 3]);
        self.tones.extend([self.tone.unwrap_or(Vector::ONE); 3]);
        self.indices.extend([first, first + 1, first + 2]);
    }

    /// Adds a closed cylinder between two points.
    pub fn cylinder(&mut self, from: Vector, to: Vector, radius: f32) {
        let axis = (to - from).normalize_or_zero();
        let (right, up) = axis.any_orthonormal_pair();
        let out = |side: usize| {
            let (sin, cos) = libm::sincosf(TAU * side as f32 / SIDES as f32);
            right * cos + up * sin
        };
        let ends = [from, to];
        self.patch(SIDES, 1, |side, end| [ends[end] + out(side) * radius, out(side)]);
        self.patch(SIDES, 1, |side, end| [to + out(side) * radius * (1 - end) as f32, axis]);
        self.patch(SIDES, 1, |side, end| [from + out(side) * radius * end as f32, -axis]);
    }

    /// Adds a sphere with this number of sides, without the triangles at its poles, which have no area.
    pub fn ball(&mut self, centre: Vector, radius: f32, sides: usize) {
        let (rows, first) = (sides / 2, self.indices.len());
        self.patch(sides, rows, |side, row| {
            let (sin, cos) = libm::sincosf(TAU * side as f32 / sides as f32);
            let (rise, reach) = libm::sincosf(PI * (row as f32 / rows as f32 - 0.5));
            let out = Vector::new(cos * reach, sin * reach, rise);
            [centre + out * radius, out.normalize()]
        });
        let triangles = self.indices.split_off(first);
        let has_area = |corners: &&[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            a.distance(b) > 1.0e-6 && b.distance(c) > 1.0e-6 && c.distance(a) > 1.0e-6
        };
        self.indices.extend(triangles.as_chunks().0.iter().filter(has_area).flatten());
    }

    /// Adds a box around `centre`. `size` includes the rounded edges. A box that is too thin gets a smaller radius.
    pub fn rounded_box(&mut self, centre: Vector, size: Vector, radius: f32, edge_cells: usize) {
        let rounded = RoundedBox::new(size, radius, edge_cells);
        for face in RoundedBox::faces() {
            self.patch(rounded.cells(), rounded.cells(), |column, row| {
                let [position, normal] = rounded.corner(face, column, row);
                [centre + position, normal]
            });
        }
    }

    /// Returns the factor on the material's colour at each vertex (red, green, blue, and 1 for opacity), or `None` if no vertex was
    /// toned.
    pub fn colors(&self) -> Option<Vec<[f32; 4]>> {
        self.tone?;
        Some(self.tones.iter().map(|tone| tone.extend(1.0).to_array()).collect())
    }

    /// Returns the volume that a closed body encloses, in m³. Triangles that face inward reduce it.
    pub fn volume_m3(&self) -> f32 {
        let of_triangle = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            a.dot(b.cross(c)) / 6.0
        };
        self.indices.as_chunks().0.iter().map(of_triangle).sum()
    }

    /// Cuts the triangles that cross the plane at `y_m`, so that a body can bend there.
    pub fn cut_at(&mut self, y_m: f32) {
        let mut cut = Vec::with_capacity(self.indices.len());
        let triangles: Vec<[u32; 3]> = self.indices.as_chunks::<3>().0.to_vec();
        for corners in triangles {
            let side = |corner: u32| self.positions[corner as usize].y - y_m;
            let sides = corners.map(side);
            // Finds the corner that is alone on its side of the plane.
            let alone = (0..3).find(|&corner| {
                let [own, next, last] = [0, 1, 2].map(|step| sides[(corner + step) % 3]);
                (own > SLIVER_M && next < -SLIVER_M && last < -SLIVER_M)
                    || (own < -SLIVER_M && next > SLIVER_M && last > SLIVER_M)
                    || (own > SLIVER_M && next < -SLIVER_M && last.abs() <= SLIVER_M)
                    || (own < -SLIVER_M && next > SLIVER_M && last.abs() <= SLIVER_M)
            });
            let Some(alone) = alone else {
                cut.extend(corners);
                continue;
            };
            let [own, next, last] = [0, 1, 2].map(|step| corners[(alone + step) % 3]);
            let between = self.vertex_between(own, next, y_m);
            if sides[(alone + 2) % 3].abs() <= SLIVER_M {
                cut.extend([own, between, last, between, next, last]);
                continue;
            }
            let other = self.vertex_between(own, last, y_m);
            cut.extend([own, between, other, between, next, last, between, last, other]);
        }
        self.indices = cut;
    }

    /// Adds a vertex at `y_m` between two others, and returns its index.
    fn vertex_between(&mut self, from: u32, to: u32, y_m: f32) -> u32 {
        let [from, to] = [from as usize, to as usize];
        let [start, end] = [self.positions[from], self.positions[to]];
        let share = (y_m - start.y) / (end.y - start.y);
        self.positions.push(start.lerp(end, share));
        self.normals.push(self.normals[from].lerp(self.normals[to], share).normalize_or_zero());
        self.tones.push(self.tones[from].lerp(self.tones[to], share));
        self.positions.len() as u32 - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Asserts that the mesh has no open edge and that every triangle faces outward. Returns the enclosed volume.
    fn closed_volume_m3(solid: &MeshBuilder) -> f32 {
        let place = |corner: u32| {
            solid.positions[corner as usize].to_array().map(|x| (x * 1.0e4).round() as i64)
        };
        let mut edges = BTreeMap::new();
        for corners in solid.indices.as_chunks::<3>().0 {
            let [a, b, c] = corners.map(|corner| solid.positions[corner as usize]);
            for [from, to] in [[0, 1], [1, 2], [2, 0]] {
                let (from, to) = (place(corners[from]), place(corners[to]));
                *edges.entry((from.min(to), from.max(to))).or_insert(0) += from.cmp(&to) as i32;
            }
            let facing = (b - a).cross(c - a);
            let outward: Vector = corners.iter().map(|at| solid.normals[*at as usize]).sum();
            assert!(facing.dot(outward) >= -1.0e-6, "{corners:?} faces inward");
        }
        let open = edges.values().filter(|count| **count != 0).count();
        assert_eq!(open, 0, "edges that are not shared by two triangles");
        solid.volume_m3()
    }

    #[test]
    fn round_shapes_are_closed_with_about_the_exact_volume() {
        let mut cylinder = MeshBuilder::default();
        cylinder.cylinder(Vector::new(1.0, 0.0, 0.0), Vector::new(1.0, 2.0, 0.0), 0.5);
        let share = closed_volume_m3(&cylinder) / (PI * 0.25 * 2.0);
        assert!((0.94..1.0).contains(&share), "{share}");
        let mut ball = MeshBuilder::default();
        ball.ball(Vector::ONE, 0.5, 14);
        let share = closed_volume_m3(&ball) / (PI / 6.0);
        assert!((0.88..1.0).contains(&share), "{share}");
        for (size, radius) in [(Vector::new(1.0, 2.0, 0.8), 0.1), (Vector::splat(0.1), 0.4)] {
            let mut solid = MeshBuilder::default();
            solid.rounded_box(Vector::ONE, size, radius, 3);
            let share = closed_volume_m3(&solid) / size.element_product();
            assert!((0.5..1.0).contains(&share), "{share}");
        }
    }

    #[test]
    fn a_body_that_is_cut_into_pieces_is_still_closed() {
        let mut whole = MeshBuilder::default();
        whole.rounded_box(Vector::Y * 0.035, Vector::new(1.0, 1.93, 1.0), 0.42, 10);
        let mut pieces = whole.clone();
        (1..18).for_each(|cut| pieces.cut_at(1.0 - cut as f32 / 9.0));
        assert!(pieces.indices.len() > 2 * whole.indices.len());
        assert!((closed_volume_m3(&pieces) - closed_volume_m3(&whole)).abs() < 1.0e-4);
    }
}
