//! The sky: a dome around the camera, from the horizon's colour to the zenith's.
//!
//! The ground fades into the same colour at the horizon, so nothing tells where it ends.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;

use super::Frame;
use super::look::{Palette, Theme};
use super::solid::Solid;

/// Radius of the dome, in metres: beyond the ground's end, and nearer than where the camera's view ends.
const RADIUS_M: f32 = 900.0;
/// Up to this height above the horizon, in radians, the gradient runs: low, because that is what one sees.
const ZENITH_RAD: f32 = 0.55;
/// Rings of the gradient.
const RINGS: usize = 20;
/// Sides of the dome.
const SIDES: usize = 24;

/// The dome.
#[derive(Component)]
struct Dome;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, set_up)
        .add_systems(Update, dress.in_set(Frame::Draw).run_if(resource_changed::<Theme>))
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

/// Another theme has another sky.
fn dress(
    theme: Res<Theme>,
    mut domes: Query<&mut Mesh3d, With<Dome>>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    for mut mesh in &mut domes {
        mesh.0 = meshes.add(dome(theme.palette()));
    }
}

/// However far the camera goes, the sky is not nearer.
fn follow(
    cameras: Query<&Transform, (With<Camera3d>, Without<Dome>)>,
    mut domes: Query<&mut Transform, With<Dome>>,
) {
    let Some(camera) = cameras.iter().next() else { return };
    for mut dome in &mut domes {
        dome.set_if_neq(Transform::from_translation(camera.translation));
    }
}

/// Seen from inside: columns go to the left.
fn dome(palette: &Palette) -> Mesh {
    let angle = |ring: usize| match ring {
        // Below the horizon, where only a camera close to the ground's end would look.
        0 => -0.35,
        ring if ring > RINGS => std::f32::consts::FRAC_PI_2,
        ring => ZENITH_RAD * (ring - 1) as f32 / (RINGS - 1) as f32,
    };
    let rows = RINGS + 1;
    let mut solid = Solid::default();
    solid.patch(SIDES, rows, |side, ring| {
        let (sin, cos) = libm::sincosf(-std::f32::consts::TAU * side as f32 / SIDES as f32);
        let (rise, reach) = libm::sincosf(angle(ring));
        let out = Vec3::new(cos * reach, sin * reach, rise);
        (out * RADIUS_M, -out)
    });
    let colors = (0..=rows).flat_map(|ring| {
        let share = (angle(ring) / ZENITH_RAD).clamp(0.0, 1.0);
        // Fast at first and then ever slower, as haze thins out.
        let share = share * (2.0 - share);
        let color = palette.horizon.mix(&palette.zenith, share).to_linear();
        std::iter::repeat_n(color.to_f32_array(), SIDES + 1)
    });
    let colors = VertexAttributeValues::Float32x4(colors.collect());
    solid.into_mesh().with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}
