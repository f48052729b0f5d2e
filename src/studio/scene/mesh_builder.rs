//! Builds meshes from a few curved patches that form one body and are drawn in one call.
//!
//! Bodies are closed or flat. Triangles are counterclockwise seen from outside.

use std::f32::consts::{PI, TAU};

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;

/// Vertices and triangles of a body.
#[derive(Debug, Clone, Default)]
pub(crate) struct MeshBuilder {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub indices: Vec<u32>,
    /// Factor for the material's colour at each vertex.
    tones: Vec<Vec3>,
    /// Factor for the vertices that follow; `None` leaves the material's colour as it is.
    tone: Option<Vec3>,
}

/// Sides of round shapes: enough for something as thick as an arm.
const SIDES: usize = 14;
/// Distance from a plane within which a corner counts as on it, in metres.
const SLIVER_M: f32 = 1.0e-4;

impl MeshBuilder {
    /// A patch of `columns` by `rows` cells. `at` gives the position and normal of a corner. Seen from outside, rows go
    /// up if columns go to the right.
    pub fn patch(
        &mut self,
        columns: usize,
        rows: usize,
        at: impl Fn(usize, usize) -> (Vec3, Vec3),
    ) {
        let first = self.positions.len() as u32;
        for row in 0..=rows {
            for column in 0..=columns {
                let (position, normal) = at(column, row);
                self.positions.push(position);
                self.normals.push(normal);
                self.tones.push(self.tone.unwrap_or(Vec3::ONE));
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

    /// Multiplies the material's colour, in linear light, for the parts that follow.
    pub fn tone(&mut self, factor: Vec3) {
        self.tone = Some(factor);
    }

    /// A flat rectangle around `centre`; `right` and `up` lead from there to the middle of its edges.
    pub fn sheet(&mut self, centre: Vec3, right: Vec3, up: Vec3) {
        let normal = right.cross(up).normalize_or_zero();
        let share = |of: usize| of as f32 * 2.0 - 1.0;
        self.patch(1, 1, |column, row| (centre + right * share(column) + up * share(row), normal));
    }

    /// A flat triangle, whose corners are counterclockwise seen from outside.
    pub fn triangle(&mut self, corners: [Vec3; 3]) {
        let first = self.positions.len() as u32;
        let [a, b, c] = corners;
        self.positions.extend(corners);
        self.normals.extend([(b - a).cross(c - a).normalize_or_zero(); 3]);
        self.tones.extend([self.tone.unwrap_or(Vec3::ONE); 3]);
        self.indices.extend([first, first + 1, first + 2]);
    }

    /// A cylinder between two points.
    pub fn cylinder(&mut self, from: Vec3, to: Vec3, radius: f32) {
        let axis = (to - from).normalize_or_zero();
        let (right, up) = axis.any_orthonormal_pair();
        let out = |side: usize| {
            let (sin, cos) = libm::sincosf(TAU * side as f32 / SIDES as f32);
            right * cos + up * sin
        };
        let ends = [from, to];
        self.patch(SIDES, 1, |side, end| (ends[end] + out(side) * radius, out(side)));
        self.patch(SIDES, 1, |side, end| (to + out(side) * radius * (1 - end) as f32, axis));
        self.patch(SIDES, 1, |side, end| (from + out(side) * radius * end as f32, -axis));
    }

    /// A sphere.
    pub fn ball(&mut self, centre: Vec3, radius: f32) {
        let rows = SIDES / 2;
        self.patch(SIDES, rows, |side, row| {
            let (sin, cos) = libm::sincosf(TAU * side as f32 / SIDES as f32);
            let (rise, reach) = libm::sincosf(PI * (row as f32 / rows as f32 - 0.5));
            let out = Vec3::new(cos * reach, sin * reach, rise);
            (centre + out * radius, out)
        });
    }

    /// The mesh, kept on the graphics card only.
    pub fn into_mesh(self) -> Mesh {
        let flat = |of: Vec<Vec3>| of.into_iter().map(|at| at.to_array()).collect::<Vec<_>>();
        let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD);
        if self.tone.is_some() {
            let colors: Vec<[f32; 4]> =
                self.tones.iter().map(|tone| tone.extend(1.0).to_array()).collect();
            mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
        }
        mesh.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, flat(self.positions))
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, flat(self.normals))
            .with_inserted_indices(Indices::U32(self.indices))
    }

    /// Cuts the triangles that cross the plane at `y_m`, so that a body can bend there.
    pub fn cut_at(&mut self, y_m: f32) {
        let mut cut = Vec::with_capacity(self.indices.len());
        let triangles: Vec<[u32; 3]> = self.indices.as_chunks::<3>().0.to_vec();
        for corners in triangles {
            let side = |corner: u32| self.positions[corner as usize].y - y_m;
            let sides = corners.map(side);
            // The corner that is alone on its side of the plane.
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

    /// Adds the vertex at `y_m` between two others, and returns its index.
    fn vertex_between(&mut self, from: u32, to: u32, y_m: f32) -> u32 {
        let [from, to] = [from as usize, to as usize];
        let [start, end] = [self.positions[from], self.positions[to]];
        let share = (y_m - start.y) / (end.y - start.y);
        self.positions.push(start.lerp(end, share));
        self.normals.push(self.normals[from].lerp(self.normals[to], share).normalize_or_zero());
        self.tones.push(self.tones[from].lerp(self.tones[to], share));
        self.positions.len() as u32 - 1
    }

    /// The mesh, each of whose vertices follows the two bones next to it, by their distances along y. `bones_m` has the bones'
    /// places on the y axis at rest, in metres, the highest first.
    pub fn into_mesh_along(self, bones_m: &[f32]) -> Mesh {
        let last = bones_m.len().saturating_sub(1);
        let bones = self.positions.iter().map(|at| {
            let behind = bones_m.iter().position(|bone_m| *bone_m <= at.y).unwrap_or(last);
            let ahead = behind.saturating_sub(1);
            let apart_m = bones_m[ahead] - bones_m[behind];
            let share = if apart_m > 0.0 { (bones_m[ahead] - at.y) / apart_m } else { 0.0 };
            let share = share.clamp(0.0, 1.0);
            ([ahead as u16, behind as u16, 0, 0], [1.0 - share, share, 0.0, 0.0])
        });
        let (indices, weights): (Vec<[u16; 4]>, Vec<[f32; 4]>) = bones.unzip();
        self.into_mesh()
            .with_inserted_attribute(
                Mesh::ATTRIBUTE_JOINT_INDEX,
                VertexAttributeValues::Uint16x4(indices),
            )
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
    }

    /// The mesh with a texture that repeats every `tile_m` metres, projected along the axis that each face looks at.
    pub fn into_tiled_mesh(self, tile_m: f32) -> Mesh {
        let place = |(at, normal): (&Vec3, &Vec3)| {
            let facing = normal.abs();
            let on_plane = if facing.z >= facing.x.max(facing.y) {
                [at.y, at.x]
            } else if facing.y >= facing.x {
                [at.x, -at.z]
            } else {
                [at.y, -at.z]
            };
            on_plane.map(|m| m / tile_m)
        };
        let uvs: Vec<[f32; 2]> = self.positions.iter().zip(&self.normals).map(place).collect();
        self.into_mesh().with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Vertices of each triangle.
    fn triangles(solid: &MeshBuilder) -> impl Iterator<Item = [usize; 3]> + '_ {
        solid.indices.chunks(3).map(|corners| [0, 1, 2].map(|corner| corners[corner] as usize))
    }

    /// Asserts that no edge is open and that every triangle faces outward. Returns the enclosed volume.
    pub fn closed_volume(solid: &MeshBuilder) -> f32 {
        let place =
            |index: usize| solid.positions[index].to_array().map(|x| (x * 1.0e4).round() as i64);
        let mut edges = std::collections::BTreeMap::new();
        let mut volume = 0.0;
        for corners in triangles(solid) {
            let [a, b, c] = corners.map(|corner| solid.positions[corner]);
            for [from, to] in [[0, 1], [1, 2], [2, 0]] {
                let (from, to) = (place(corners[from]), place(corners[to]));
                if from != to {
                    *edges
                        .entry(from.min(to))
                        .or_insert(std::collections::BTreeMap::new())
                        .entry(from.max(to))
                        .or_insert(0) += if from < to { 1 } else { -1 };
                }
            }
            let facing = (b - a).cross(c - a);
            let outward: Vec3 = corners.iter().map(|corner| solid.normals[*corner]).sum();
            assert!(facing.dot(outward) >= -1.0e-6, "{corners:?} faces inward");
            volume += a.dot(b.cross(c)) / 6.0;
        }
        let open = edges.values().flat_map(|to| to.values()).filter(|count| **count != 0).count();
        assert_eq!(open, 0, "edges that are not shared by two triangles");
        volume
    }

    #[test]
    fn cylinder_and_sphere_are_closed_with_about_the_exact_volume() {
        let mut cylinder = MeshBuilder::default();
        cylinder.cylinder(Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 2.0, 0.0), 0.5);
        let share = closed_volume(&cylinder) / (PI * 0.25 * 2.0);
        assert!((0.94..1.0).contains(&share), "{share}");
        let mut ball = MeshBuilder::default();
        ball.ball(Vec3::ONE, 0.5);
        let share = closed_volume(&ball) / (PI / 6.0);
        assert!((0.88..1.0).contains(&share), "{share}");
    }
}
