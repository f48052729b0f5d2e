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

/// Depth by which the best snake of a generation is drawn nearer than it is, so that the other snakes do not hide it: about
/// a tenth to a fifth of its distance from the camera.
const OVER_GHOSTS: f32 = 1.5e6;

/// Returns a material that is drawn over the ghosts around it.
pub(crate) fn over_ghosts(material: StandardMaterial) -> StandardMaterial {
    StandardMaterial { depth_bias: OVER_GHOSTS, ..material }
}

/// Meshes and materials that the parts of the scene share.
#[derive(Resource, Debug)]
pub(crate) struct Props {
    /// A cube of one metre; a transform scales it to any box.
    pub cube: Handle<Mesh>,
    /// Materials of the red and of the blue limbs of a snake.
    pub limbs: [Handle<StandardMaterial>; 2],
    /// Materials of the limbs of the best snake of a generation.
    pub limbs_of_best: [Handle<StandardMaterial>; 2],
    /// Cube for the limbs of ghosts. Its faces differ in brightness, because the materials of ghosts are unlit.
    pub ghost_cube: Handle<Mesh>,
    /// Pale, opaque materials of the limbs of ghosts: ghosts hide one another, and no pixel is drawn a hundred times.
    pub ghosts: [Handle<StandardMaterial>; 2],
}

impl FromWorld for Props {
    fn from_world(world: &mut World) -> Self {
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let [cube, ghost_cube] =
            [Cuboid::from_length(1.0).mesh().build(), shaded_cube()].map(|mesh| meshes.add(mesh));
        // A low reflectance preserves the red and the blue of the report under a bright sky.
        let limb = StandardMaterial { perceptual_roughness: 0.5, reflectance: 0.25, ..default() };
        let ghost = StandardMaterial { unlit: true, ..limb.clone() };
        let best = over_ghosts(limb.clone());
        Self {
            cube,
            limbs: [
                themed(world, limb.clone(), |palette| palette.red_limb),
                themed(world, limb, |palette| palette.blue_limb),
            ],
            limbs_of_best: [
                themed(world, best.clone(), |palette| palette.red_limb),
                themed(world, best, |palette| palette.blue_limb),
            ],
            ghost_cube,
            ghosts: [
                themed(world, ghost.clone(), |palette| palette.ghosts[0]),
                themed(world, ghost, |palette| palette.ghosts[1]),
            ],
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
