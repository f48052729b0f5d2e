//! Conversion of solids of vertices and triangles to Bevy's meshes, which are kept only on the graphics card.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;

use snakes_lab::mesh::MeshBuilder;

/// Number of sides of a ball; enough for a ball as thick as an arm.
pub(crate) const BALL_SIDES: usize = 14;

/// Converts a solid to a mesh.
pub(crate) fn to_mesh(solid: MeshBuilder) -> Mesh {
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD);
    if let Some(colors) = solid.colors() {
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    }
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, solid.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, solid.normals)
        .with_inserted_indices(Indices::U32(solid.indices))
}

/// Converts a solid to a mesh with an opacity at each vertex, which depends on the vertex's position.
pub(crate) fn to_fading_mesh(solid: MeshBuilder, opacity: impl Fn(&Vec3) -> f32) -> Mesh {
    let color = |at: &Vec3| [1.0, 1.0, 1.0, opacity(at)];
    let colors: Vec<[f32; 4]> = solid.positions.iter().map(color).collect();
    to_mesh(solid).with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}

/// Converts a solid to a mesh whose vertices each follow the two neighbouring bones, weighted by their distances along
/// y. `bones_m` has the positions of the bones on the y axis at rest, in metres, in descending order.
pub(crate) fn to_mesh_along(solid: MeshBuilder, bones_m: &[f32]) -> Mesh {
    let last = bones_m.len().saturating_sub(1);
    let bones = solid.positions.iter().map(|at| {
        let behind = bones_m.iter().position(|bone_m| *bone_m <= at.y).unwrap_or(last);
        let ahead = behind.saturating_sub(1);
        let apart_m = bones_m[ahead] - bones_m[behind];
        let share = if apart_m > 0.0 { (bones_m[ahead] - at.y) / apart_m } else { 0.0 };
        let share = share.clamp(0.0, 1.0);
        ([ahead as u16, behind as u16, 0, 0], [1.0 - share, share, 0.0, 0.0])
    });
    let (indices, weights): (Vec<[u16; 4]>, Vec<[f32; 4]>) = bones.unzip();
    let indices = VertexAttributeValues::Uint16x4(indices);
    to_mesh(solid)
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, indices)
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
}

/// Converts a solid to a mesh with a texture that repeats every `tile_m` metres, projected along the main axis of each face's normal.
pub(crate) fn to_tiled_mesh(solid: MeshBuilder, tile_m: f32) -> Mesh {
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
    let uvs: Vec<[f32; 2]> = solid.positions.iter().zip(&solid.normals).map(place).collect();
    to_mesh(solid).with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
}
