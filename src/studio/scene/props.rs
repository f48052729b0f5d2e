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
    pub stair: Handle<StandardMaterial>,
    pub stair_other: Handle<StandardMaterial>,
}

impl FromWorld for Props {
    fn from_world(world: &mut World) -> Self {
        let cube = world.resource_mut::<Assets<Mesh>>().add(Cuboid::from_length(1.0));
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        // The theme sets the colours.
        let mut material = |perceptual_roughness| {
            materials.add(StandardMaterial { perceptual_roughness, ..default() })
        };
        let [red, blue] = [0.55; 2].map(&mut material);
        let [stair, stair_other] = [0.9; 2].map(&mut material);
        Self { cube, red, blue, stair, stair_other }
    }
}

/// A transform that scales the unit cube to a box.
pub(crate) fn box_transform(centre: Vec3, size: Vec3) -> Transform {
    Transform::from_translation(centre).with_scale(size)
}
