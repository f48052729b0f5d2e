//! Meshes and materials that the parts of the scene share.

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
    /// The same for ghosts, translucent.
    pub red_ghost: Handle<StandardMaterial>,
    pub blue_ghost: Handle<StandardMaterial>,
}

impl FromWorld for Props {
    fn from_world(world: &mut World) -> Self {
        let cube = world.resource_mut::<Assets<Mesh>>().add(Cuboid::from_length(1.0));
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        // The theme sets the colours.
        let mut material = |alpha_mode| {
            // Little reflectance keeps the red and the blue of the report under a bright sky.
            let (perceptual_roughness, reflectance) = (0.5, 0.25);
            materials.add(StandardMaterial {
                perceptual_roughness,
                reflectance,
                alpha_mode,
                ..default()
            })
        };
        let [red, blue] = [AlphaMode::Opaque; 2].map(&mut material);
        let [red_ghost, blue_ghost] = [AlphaMode::Blend; 2].map(&mut material);
        Self { cube, red, blue, red_ghost, blue_ghost }
    }
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
