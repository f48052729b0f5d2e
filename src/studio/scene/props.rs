//! Meshes and materials that the parts of the scene share.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;

/// Shared meshes and materials.
#[derive(Resource, Debug)]
pub(crate) struct Props {
    /// A cube of one metre; a transform scales it to any box.
    pub cube: Handle<Mesh>,
    /// Material of the first, third, ... limb.
    pub red: Handle<StandardMaterial>,
    /// Material of the second, fourth, ... limb.
    pub blue: Handle<StandardMaterial>,
    /// The cube for ghosts: its faces have their own brightness, because the materials of ghosts have no light.
    pub ghost_cube: Handle<Mesh>,
    /// The same materials for ghosts, translucent. Where thirty ghosts overlap, each pixel is drawn a hundred times, which
    /// has to be cheap.
    pub red_ghost: Handle<StandardMaterial>,
    pub blue_ghost: Handle<StandardMaterial>,
}

impl FromWorld for Props {
    fn from_world(world: &mut World) -> Self {
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let [cube, ghost_cube] =
            [Cuboid::from_length(1.0).mesh().build(), shaded_cube()].map(|mesh| meshes.add(mesh));
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        // The theme sets the colours.
        let mut material = |alpha_mode| {
            // Little reflectance keeps the red and the blue of the report under a bright sky.
            let (perceptual_roughness, reflectance) = (0.5, 0.25);
            materials.add(StandardMaterial {
                perceptual_roughness,
                reflectance,
                alpha_mode,
                unlit: alpha_mode != AlphaMode::Opaque,
                ..default()
            })
        };
        let [red, blue] = [AlphaMode::Opaque; 2].map(&mut material);
        let [red_ghost, blue_ghost] = [AlphaMode::Blend; 2].map(&mut material);
        Self { cube, red, blue, ghost_cube, red_ghost, blue_ghost }
    }
}

/// A cube of one metre whose faces are brighter the more they face upwards.
fn shaded_cube() -> Mesh {
    let mesh = Cuboid::from_length(1.0).mesh().build();
    let normals = mesh.attribute(Mesh::ATTRIBUTE_NORMAL).and_then(VertexAttributeValues::as_float3);
    let shade = |&[x, y, _]: &[f32; 3]| {
        let brightness = 0.75 + 0.25 * y - 0.1 * x.abs();
        [brightness, brightness, brightness, 1.0]
    };
    let colors: Vec<[f32; 4]> = normals.unwrap_or_default().iter().map(shade).collect();
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}

/// Gives materials the colours of the theme.
pub(crate) fn recolor<'h>(
    materials: &mut Assets<StandardMaterial>,
    colors: impl IntoIterator<Item = (&'h Handle<StandardMaterial>, Color)>,
) {
    for (handle, color) in colors {
        if let Some(mut material) = materials.get_mut(handle) {
            material.base_color = color;
        }
    }
}

/// A transform that scales the unit cube to a box.
pub(crate) fn box_transform(centre: Vec3, size: Vec3) -> Transform {
    Transform::from_translation(centre).with_scale(size)
}
