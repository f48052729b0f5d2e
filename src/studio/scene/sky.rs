//! The sky: a dome around the camera with clouds, the sun or the moon and stars, and hills before it.
//!
//! The ground fades into the horizon's colour, so the horizon is seamless. The clouds are colours of the dome's vertices, computed once
//! for each theme, so that the sky costs no more than a gradient.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::camera::visibility::NoFrustumCulling;
use bevy::light::{EnvironmentMapLight, NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;

use super::LIGHT_FROM;
use super::meshes::{to_fading_mesh, to_mesh};
use super::props::themed;
use super::surface_texture::{SIDE, noise, random, rise};
use crate::studio::schedule::FrameSet;
use crate::studio::ui::theme::{Palette, Theme};
use snakes_lab::mesh::MeshBuilder;

/// Radius of the sky's dome, in metres: beyond the end of the ground, within the camera's far plane.
const RADIUS_M: f32 = 900.0;
/// Elevation above the horizon where the sky's gradient ends, in radians: low, because cameras see only the lower sky.
const ZENITH_RAD: f32 = 0.55;
/// Elevation above the horizon where the clouds end, in radians.
const CLOUDS_END_RAD: f32 = 1.0;
/// Number of rings of the dome up to the end of the clouds.
const RINGS: usize = 48;
/// Number of sides of the dome.
const SIDES: usize = 160;
/// Layers of hills, the farthest first: number, lowest and highest elevation in radians, and share of the hills' colour in the haze.
const HILLS: [(u32, [f32; 2], f32); 2] = [(1, [0.0, 0.085], 0.45), (2, [-0.01, 0.05], 0.8)];
/// Half the width of a star, in radians.
const STAR_RAD: f32 = 0.001;
/// Radius of the disc of the sun or the moon, in radians: larger than in nature, so that it is recognized.
const DISC_RAD: f32 = 0.028;

/// Marks the dome of the sky.
#[derive(Component)]
struct Dome;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Startup, set_up)
        .add_systems(Update, dress.in_set(FrameSet::Draw).run_if(resource_changed::<Theme>))
        .add_systems(Update, reflect.in_set(FrameSet::Draw))
        .add_systems(PostUpdate, follow.before(TransformSystems::Propagate));
}

fn set_up(world: &mut World) {
    let sky = StandardMaterial { unlit: true, fog_enabled: false, ..default() };
    let light = StandardMaterial { alpha_mode: AlphaMode::Blend, ..sky.clone() };
    let light = themed(world, light, |palette| palette.sun_disc);
    let sky = world.resource_mut::<Assets<StandardMaterial>>().add(sky);
    let disc = world.resource_mut::<Assets<Mesh>>().add(disc());
    let is_far = (NotShadowCaster, NotShadowReceiver, NoFrustumCulling);
    let disc = (Mesh3d(disc), MeshMaterial3d(light), is_far.clone());
    // The dome gets its mesh in the colours of the theme before the first frame: see `dress`.
    world.spawn((Dome, Mesh3d::default(), MeshMaterial3d(sky), is_far)).with_child(disc);
}

/// Builds the dome of the sky in the colours of the theme, at the start and after a change.
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
        let [top, middle, bottom] = [palette.zenith, palette.horizon, palette.ground];
        let reflected =
            EnvironmentMapLight::hemispherical_gradient(&mut images, top, middle, bottom);
        let dark = EnvironmentMapLight::solid_color(&mut images, Color::BLACK);
        commands.entity(camera).insert(EnvironmentMapLight {
            diffuse_map: dark.diffuse_map,
            intensity: MIRROR_CD_M2,
            // In the environment map y points up; in the world, z.
            rotation: Quat::from_rotation_x(FRAC_PI_2),
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

/// Returns the direction of a point of the sky from its azimuth and its elevation, in radians.
fn direction(azimuth_rad: f32, elevation_rad: f32) -> Vec3 {
    let (rise, reach) = libm::sincosf(elevation_rad);
    let (sin, cos) = libm::sincosf(azimuth_rad);
    Vec3::new(cos * reach, sin * reach, rise)
}

/// Builds the dome of the sky with its clouds and stars, and the hills before it. The dome is seen from inside, so its columns go to
/// the left.
fn dome(palette: &Palette) -> Mesh {
    let azimuth_rad = |side: usize| -TAU * side as f32 / SIDES as f32;
    let (mut solid, mut colors) = (MeshBuilder::default(), Vec::new());
    let mut patch = |rows: usize, radius_m: f32, at: &dyn Fn(usize, usize) -> (f32, Color)| {
        let corners = (0..=rows).flat_map(|row| (0..=SIDES).map(move |side| at(side, row)));
        let corners: Vec<(f32, Color)> = corners.collect();
        solid.patch(SIDES, rows, |side, row| {
            let (elevation_rad, _) = corners[row * (SIDES + 1) + side];
            let out = direction(azimuth_rad(side), elevation_rad);
            [out * radius_m, -out]
        });
        colors.extend(corners.iter().map(|(_, color)| color.to_linear().to_f32_array()));
    };
    patch(RINGS + 1, RADIUS_M, &|side, ring| {
        let elevation_rad = match ring {
            // The dome continues below the horizon, which only a camera near the end of the ground sees.
            0 => -0.35,
            ring if ring > RINGS => FRAC_PI_2,
            ring => CLOUDS_END_RAD * (ring - 1) as f32 / (RINGS - 1) as f32,
        };
        (elevation_rad, sky_color(palette, side, elevation_rad))
    });
    for (layer, [least_rad, most_rad], share) in HILLS {
        patch(1, RADIUS_M * (0.98 - 0.01 * layer as f32), &|side, row| {
            let height = cloudy(side * SIDE / SIDES, 0, layer);
            let top_rad = least_rad + (most_rad - least_rad) * height;
            // The foot of the hills lies in the haze, which has the colour of the horizon.
            let (elevation_rad, share) = [(-0.01, share * 0.3), (top_rad, share)][row];
            (elevation_rad, palette.horizon.mix(&palette.hills, share))
        });
    }
    for star in 0..palette.stars {
        let chance = |salt: u32| random(star, salt, 61);
        let out = direction(chance(0) * TAU, 0.12 + chance(1) * 1.2);
        let (right, up) = out.any_orthonormal_pair();
        let half_m = RADIUS_M * STAR_RAD * (0.6 + 0.6 * chance(2));
        solid.sheet(out * RADIUS_M * 0.99, right * half_m, -up * half_m);
        let color = palette.zenith.mix(&palette.sun_disc, 0.35 + 0.65 * chance(3));
        colors.extend([color.to_linear().to_f32_array(); 4]);
    }
    to_mesh(solid).with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}

/// Returns the colour of the sky at a column of the dome and an elevation, in radians.
fn sky_color(palette: &Palette, side: usize, elevation_rad: f32) -> Color {
    let share = (elevation_rad / ZENITH_RAD).clamp(0.0, 1.0);
    // The colour changes quickly near the horizon and slowly above, like haze.
    let clear = palette.horizon.mix(&palette.zenith, share * (2.0 - share));
    let height = (elevation_rad / CLOUDS_END_RAD).clamp(0.0, 1.0);
    let row = (height * (SIDE - 1) as f32) as usize;
    let shape = rise(cloudy(side * SIDE / SIDES, row, 0), 0.50, 0.72);
    // Clouds dissolve in the haze and towards the zenith.
    let is_visible = rise(height, 0.03, 0.15) * (1.0 - rise(height, 0.7, 1.0));
    clear.mix(&palette.cloud, shape * is_visible * 0.8)
}

/// Returns cloudy noise from 0 to 1 around the sky, in pixels of [`SIDE`].
fn cloudy(x: usize, y: usize, seed: u32) -> f32 {
    let (x, y) = (x % SIDE, y % SIDE);
    [(6, 0.5), (13, 0.3), (29, 0.2)]
        .into_iter()
        .map(|(cells, share)| share * noise(x, y, cells, 51 + seed))
        .sum()
}

/// Builds the disc of the sun or the moon, with a halo, on the dome.
fn disc() -> Mesh {
    let mut solid = MeshBuilder::default();
    let out = LIGHT_FROM.normalize();
    let (right, up) = out.any_orthonormal_pair();
    let radius_rad = |ring: usize| DISC_RAD * [0.0, 1.0, 1.15, 6.0][ring];
    let middle = out * RADIUS_M * 0.985;
    solid.patch(48, 3, |side, ring| {
        let (sin, cos) = libm::sincosf(TAU * side as f32 / 48.0);
        [middle + (right * cos + up * sin) * RADIUS_M * radius_rad(ring), -out]
    });
    to_fading_mesh(solid, |at| {
        let ring = at.distance(middle) / (RADIUS_M * DISC_RAD);
        match ring {
            ..1.05 => 1.0,
            ..2.0 => 0.3,
            _ => 0.0,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_meets_itself_behind_the_viewer_and_its_horizon_has_the_fogs_colour() {
        for theme in [Theme::Light, Theme::Dark] {
            let palette = theme.palette();
            for row in 0..40 {
                let elevation_rad = row as f32 * 0.03;
                assert_eq!(
                    sky_color(palette, 0, elevation_rad),
                    sky_color(palette, SIDES, elevation_rad)
                );
            }
            let far =
                |a: Color, b: Color| a.to_linear().to_vec3().distance(b.to_linear().to_vec3());
            assert!(
                (0..SIDES).all(|side| far(sky_color(palette, side, 0.0), palette.horizon) < 1e-6)
            );
        }
    }

    #[test]
    fn clouds_cover_some_of_the_sky_but_not_most_of_it() {
        let palette = Theme::Light.palette();
        let clear = palette.horizon.mix(&palette.zenith, 0.75);
        let cover = (0..SIDES).filter(|side| {
            let here = sky_color(palette, *side, ZENITH_RAD / 2.0).to_linear();
            here.to_vec3().distance(clear.to_linear().to_vec3()) > 0.1
        });
        assert!((SIDES / 10..SIDES * 6 / 10).contains(&cover.count()));
    }
}
