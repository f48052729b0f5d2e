//! Meshes and materials that the parts of the scene share, and materials that follow the theme.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use bevy_egui::egui::Color32;

use crate::studio::ui::theme::{Palette, Theme};

/// Materials whose colours follow the theme, each with a function for its colour.
#[derive(Resource, Default)]
pub(crate) struct ThemedMaterials(Vec<(Handle<StandardMaterial>, Box<ColorOfTheme>)>);

/// Function that returns the colour of a material in a theme.
type ColorOfTheme = dyn Fn(&Palette) -> Color + Send + Sync;

/// Adds a material whose colour follows the theme.
pub(crate) fn themed(
    world: &mut World,
    material: StandardMaterial,
    color: impl Fn(&Palette) -> Color + Send + Sync + 'static,
) -> Handle<StandardMaterial> {
    let handle = world.resource_mut::<Assets<StandardMaterial>>().add(material);
    let mut themed = world.get_resource_or_init::<ThemedMaterials>();
    themed.0.push((handle.clone(), Box::new(color)));
    handle
}

/// Sets the colours of the materials to those of the theme.
pub(super) fn recolor(
    theme: Res<Theme>,
    themed: Res<ThemedMaterials>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (handle, color) in &themed.0 {
        if let Some(mut material) = materials.get_mut(handle) {
            material.base_color = color(theme.palette());
        }
    }
}

/// Converts a colour of the panels for the scene.
pub(crate) fn in_scene(color: Color32) -> Color {
    let [red, green, blue, _] = color.to_array();
    Color::srgb_u8(red, green, blue)
}

/// Opacity of a ghost's limbs.
const GHOST_ALPHA: f32 = 0.18;

/// Meshes and materials that the parts of the scene share.
#[derive(Resource, Debug)]
pub(crate) struct Props {
    /// A cube of one metre; a transform scales it to any box.
    pub cube: Handle<Mesh>,
    /// Material of the first, third, ... limb.
    pub red: Handle<StandardMaterial>,
    /// Material of the second, fourth, ... limb.
    pub blue: Handle<StandardMaterial>,
    /// Cube for the limbs of ghosts. Its faces differ in brightness, because the materials of ghosts are unlit.
    pub ghost_cube: Handle<Mesh>,
    /// Translucent material of the red limbs of ghosts. It must be cheap: where thirty ghosts overlap, each pixel is
    /// drawn a hundred times.
    pub red_ghost: Handle<StandardMaterial>,
    pub blue_ghost: Handle<StandardMaterial>,
}

impl FromWorld for Props {
    fn from_world(world: &mut World) -> Self {
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let [cube, ghost_cube] =
            [Cuboid::from_length(1.0).mesh().build(), shaded_cube()].map(|mesh| meshes.add(mesh));
        // A low reflectance preserves the red and the blue of the report under a bright sky.
        let limb = StandardMaterial { perceptual_roughness: 0.5, reflectance: 0.25, ..default() };
        let ghost = StandardMaterial { alpha_mode: AlphaMode::Blend, unlit: true, ..limb.clone() };
        Self {
            cube,
            red: themed(world, limb.clone(), |palette| palette.red_limb),
            blue: themed(world, limb, |palette| palette.blue_limb),
            ghost_cube,
            red_ghost: themed(world, ghost.clone(), |of| of.red_limb.with_alpha(GHOST_ALPHA)),
            blue_ghost: themed(world, ghost, |of| of.blue_limb.with_alpha(GHOST_ALPHA)),
        }
    }
}

/// Builds a cube of one metre whose faces are brighter the more they face upwards.
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

/// Returns the transform that scales the unit cube to a box.
pub(crate) fn box_transform(centre: Vec3, size: Vec3) -> Transform {
    Transform::from_translation(centre).with_scale(size)
}
