//! Meshes and materials that the parts of the scene share, and materials that follow the theme.

use bevy::math::Affine2;
use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use bevy::render::render_resource::Face;
use bevy_egui::egui::Color32;

use super::surface_texture::meadow;
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

/// Material whose colour follows the theme.
type Paint = Handle<StandardMaterial>;

/// Meshes and materials that the parts of the scene share.
#[derive(Resource, Debug)]
pub(crate) struct Props {
    /// A cube of one metre; a transform scales it to any box.
    pub cube: Handle<Mesh>,
    /// Cube for the limbs of ghosts. Its faces differ in brightness, because the materials of ghosts are unlit.
    pub ghost_cube: Handle<Mesh>,
    /// Materials of a snake: of its red and of its blue limbs, and of the light and of the dark details on limbs.
    pub limbs: [Paint; 4],
    /// Materials of the best snake of a generation, in the order of `limbs`.
    pub limbs_of_best: [Paint; 4],
    /// Pale, opaque materials of the limbs of ghosts: ghosts hide one another, and no pixel is drawn a hundred times.
    pub ghosts: [Paint; 2],
    /// Materials in the colours of the lanes: see [`Self::of_lane`].
    lanes: Vec<Paint>,
    /// Materials of the fittings of the stairs: see [`super::landing`].
    pub wood: Paint,
    pub wall: Paint,
    pub white: Paint,
    pub lamp: Paint,
    pub shine: Paint,
    /// Material of the mesh that casts the stairs' shadow. It is never seen, so it has the same colour in all themes.
    pub caster: Paint,
    /// Materials of dark and lit strips on the edges of steps, and of the glow around lit ones.
    pub dark_strip: Paint,
    pub lit_strip: Paint,
    pub glow: Paint,
    /// Material of the dents in soft surfaces.
    pub dent: Paint,
    /// Materials of a flag's post and cloth.
    pub post: Paint,
    pub cloth: Paint,
    /// Materials of the ground, of its grid, and of all plants.
    pub ground: Paint,
    pub grid: Paint,
    pub leaves: Paint,
}

/// Half the side of the drawn ground, in metres. The physical ground is infinite; fog hides the end of the drawn one.
pub(super) const GROUND_HALF_M: f32 = 600.0;
/// Side of the square that the texture of the ground covers, in metres.
const MEADOW_M: f32 = 9.0;
/// Number of lane colours in the palette.
const LANE_COLORS: usize = 10;
/// Brightness factor of a lit strip: so bright that it glows in a picture with bloom.
const GLOWING: f32 = 1.7;

impl FromWorld for Props {
    fn from_world(world: &mut World) -> Self {
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let [cube, ghost_cube] =
            [Cuboid::from_length(1.0).mesh().build(), shaded_cube()].map(|mesh| meshes.add(mesh));
        let meadow = world.resource_mut::<Assets<Image>>().add(meadow());
        let rough = |perceptual_roughness, reflectance| StandardMaterial {
            perceptual_roughness,
            reflectance,
            ..default()
        };
        let unlit = |alpha_mode| StandardMaterial { unlit: true, alpha_mode, ..default() };
        // A low reflectance preserves the red and the blue of the report under a bright sky.
        let limb = rough(0.5, 0.25);
        let dark = StandardMaterial { metallic: 0.4, ..rough(0.35, 0.5) };
        let mut snake = |depth_bias| {
            let at =
                |material: &StandardMaterial| StandardMaterial { depth_bias, ..material.clone() };
            [
                themed(world, at(&limb), |palette| palette.red_limb),
                themed(world, at(&limb), |palette| palette.blue_limb),
                themed(world, at(&rough(0.4, 0.5)), |palette| palette.white),
                themed(world, at(&dark), |palette| palette.metal),
            ]
        };
        let [limbs, limbs_of_best] = [0.0, OVER_GHOSTS].map(&mut snake);
        let ghosts = [0, 1].map(|index| {
            themed(world, unlit(AlphaMode::Opaque), move |palette| palette.ghosts[index])
        });
        let of_lane = |number| {
            let color = move |palette: &Palette| in_scene(palette.lane_color(number));
            themed(world, rough(0.7, 0.2), color)
        };
        let lanes = (0..LANE_COLORS).map(of_lane).collect();
        let ground = StandardMaterial {
            base_color_texture: Some(meadow),
            uv_transform: Affine2::from_scale(Vec2::splat(2.0 * GROUND_HALF_M / MEADOW_M)),
            ..rough(1.0, 0.1)
        };
        // Blades of grass are seen from both sides.
        let leaves = StandardMaterial { cull_mode: None, ..rough(1.0, 0.1) };
        // Only faces that look away from the light cast shadows. A lit face would shadow itself in the saw-tooth
        // pattern of the shadow map's pixels.
        let caster = StandardMaterial { cull_mode: Some(Face::Front), ..default() };
        let mut paint =
            |material, color: fn(&Palette) -> Color| -> Paint { themed(world, material, color) };
        Self {
            cube,
            ghost_cube,
            limbs,
            limbs_of_best,
            ghosts,
            lanes,
            wood: paint(rough(0.8, 0.2), |palette| palette.wood),
            wall: paint(rough(0.8, 0.2), |palette| palette.wall),
            white: paint(rough(0.8, 0.2), |palette| palette.white),
            lamp: paint(unlit(AlphaMode::Opaque), |palette| palette.lamp),
            shine: paint(unlit(AlphaMode::Add), |palette| palette.lamp),
            caster: paint(caster, |_| Color::WHITE),
            dark_strip: paint(rough(0.8, 0.5), |palette| palette.step_edge),
            lit_strip: paint(unlit(AlphaMode::Opaque), |palette| {
                (palette.step_edge_lit.to_linear() * GLOWING).into()
            }),
            glow: paint(unlit(AlphaMode::Blend), |palette| palette.step_edge_lit),
            dent: paint(unlit(AlphaMode::Blend), |palette| palette.dent),
            post: paint(rough(0.9, 0.1), |palette| palette.metal),
            cloth: paint(rough(0.9, 0.1), |palette| palette.flag),
            ground: paint(ground, |palette| palette.ground),
            // The grid is translucent, so that a line in a shadow is darker than the shadow.
            grid: paint(unlit(AlphaMode::Blend), |palette| palette.grid),
            leaves: paint(leaves, |palette| palette.leaves),
        }
    }
}

impl Props {
    /// Returns the material in the colour of a lane; the first lane is 0.
    pub fn of_lane(&self, number: usize) -> &Handle<StandardMaterial> {
        &self.lanes[number % LANE_COLORS]
    }
}

/// Returns the components that draw a mesh with a material.
pub(super) fn piece(
    mesh: &Handle<Mesh>,
    material: &Handle<StandardMaterial>,
) -> (Mesh3d, MeshMaterial3d<StandardMaterial>) {
    (Mesh3d(mesh.clone()), MeshMaterial3d(material.clone()))
}

/// Builds a cube of one metre whose faces are brighter the more they face upwards.
fn shaded_cube() -> Mesh {
    let mesh = Cuboid::from_length(1.0).mesh().build();
    let normals = mesh.attribute(Mesh::ATTRIBUTE_NORMAL).and_then(VertexAttributeValues::as_float3);
    let shade = |&[x, _, z]: &[f32; 3]| {
        let brightness = 0.85 + 0.15 * z - 0.1 * x.abs();
        [brightness, brightness, brightness, 1.0]
    };
    let colors: Vec<[f32; 4]> = normals.unwrap_or_default().iter().map(shade).collect();
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_faces_of_a_ghosts_cube_are_brighter_the_more_they_face_upwards() {
        let cube = shaded_cube();
        let normals = cube.attribute(Mesh::ATTRIBUTE_NORMAL).and_then(|of| of.as_float3());
        let Some(VertexAttributeValues::Float32x4(colors)) = cube.attribute(Mesh::ATTRIBUTE_COLOR)
        else {
            panic!("four numbers per vertex");
        };
        let of_face = |z: f32| {
            let at = normals.expect("normals").iter().position(|normal| normal[2] == z);
            colors[at.expect("a face")][0]
        };
        assert!(of_face(1.0) > of_face(0.0) && of_face(0.0) > of_face(-1.0));
    }
}
