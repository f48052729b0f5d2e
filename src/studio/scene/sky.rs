//! The sky: a dome around the camera, from the horizon's colour to the zenith's.
//!
//! The ground fades into the horizon's colour, so the horizon is seamless.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::light::{EnvironmentMapLight, NotShadowCaster, NotShadowReceiver};
use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;

use super::meshes::to_mesh;
use crate::studio::schedule::FrameSet;
use crate::studio::ui::theme::{Palette, Theme};
use snakes_lab::mesh::MeshBuilder;

/// Radius of the sky's dome, in metres: beyond the end of the ground, within the camera's far plane.
const RADIUS_M: f32 = 900.0;
/// Elevation above the horizon where the sky's gradient ends, in radians: low, because cameras see only the lower sky.
const ZENITH_RAD: f32 = 0.55;
/// Number of rings of the dome that form the gradient.
const RINGS: usize = 20;
/// Number of sides of the dome.
const SIDES: usize = 24;

/// Marks the dome of the sky.
#[derive(Component)]
struct Dome;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Startup, set_up)
        .add_systems(Update, dress.in_set(FrameSet::Draw).run_if(resource_changed::<Theme>))
        .add_systems(Update, reflect.in_set(FrameSet::Draw))
        .add_systems(PostUpdate, follow.before(TransformSystems::Propagate));
}

fn set_up(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    theme: Res<Theme>,
) {
    commands.spawn((
        Dome,
        Mesh3d(meshes.add(dome(theme.palette()))),
        MeshMaterial3d(materials.add(StandardMaterial {
            unlit: true,
            fog_enabled: false,
            ..default()
        })),
        NotShadowCaster,
        NotShadowReceiver,
        NoFrustumCulling,
    ));
}

/// Recolours the sky after a change of the theme.
fn dress(
    theme: Res<Theme>,
    mut domes: Query<&mut Mesh3d, With<Dome>>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    for mut mesh in &mut domes {
        mesh.0 = meshes.add(dome(theme.palette()));
    }
}

/// Brightness of the reflected sky that matches the drawn one, in cd/m², for the exposure of Bevy's cameras.
const MIRROR_CD_M2: f32 = 1000.0;

/// Lets smooth surfaces, such as ice, reflect the sky. The ambient light already accounts for the sky's light on rough surfaces.
fn reflect(
    theme: Res<Theme>,
    cameras: Query<(Entity, Has<EnvironmentMapLight>), With<Camera3d>>,
    mut images: ResMut<Assets<Image>>,
    mut commands: Commands,
) {
    for (camera, has_sky) in &cameras {
        if has_sky && !theme.is_changed() {
            continue;
        }
        let palette = theme.palette();
        let sky = [palette.zenith, palette.horizon, palette.ground];
        let [top, middle, bottom] = sky;
        let reflected =
            EnvironmentMapLight::hemispherical_gradient(&mut images, top, middle, bottom);
        let dark = EnvironmentMapLight::solid_color(&mut images, Color::BLACK);
        commands.entity(camera).insert(EnvironmentMapLight {
            diffuse_map: dark.diffuse_map,
            intensity: MIRROR_CD_M2,
            // In the environment map y points up; in the world, z.
            rotation: Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            ..reflected
        });
    }
}

/// Keeps the dome centred on the camera.
fn follow(
    cameras: Query<&Transform, (With<Camera3d>, Without<Dome>)>,
    mut domes: Query<&mut Transform, With<Dome>>,
) {
    let Some(camera) = cameras.iter().next() else { return };
    for mut dome in &mut domes {
        dome.set_if_neq(Transform::from_translation(camera.translation));
    }
}

/// Builds the dome of the sky. It is seen from inside, so its columns go to the left.
fn dome(palette: &Palette) -> Mesh {
    let angle = |ring: usize| match ring {
        // The dome continues below the horizon, which only a camera near the end of the ground sees.
        0 => -0.35,
        ring if ring > RINGS => std::f32::consts::FRAC_PI_2,
        ring => ZENITH_RAD * (ring - 1) as f32 / (RINGS - 1) as f32,
    };
    let rows = RINGS + 1;
    let mut solid = MeshBuilder::default();
    solid.patch(SIDES, rows, |side, ring| {
        let (sin, cos) = libm::sincosf(-std::f32::consts::TAU * side as f32 / SIDES as f32);
        let (rise, reach) = libm::sincosf(angle(ring));
        let out = Vec3::new(cos * reach, sin * reach, rise);
        [out * RADIUS_M, -out]
    });
    let colors = (0..=rows).flat_map(|ring| {
        let share = (angle(ring) / ZENITH_RAD).clamp(0.0, 1.0);
        // The colour changes quickly near the horizon and slowly above, like haze.
        let share = share * (2.0 - share);
        let color = palette.horizon.mix(&palette.zenith, share).to_linear();
        std::iter::repeat_n(color.to_f32_array(), SIDES + 1)
    });
    let colors = VertexAttributeValues::Float32x4(colors.collect());
    to_mesh(solid).with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}
