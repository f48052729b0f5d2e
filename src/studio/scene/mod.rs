//! The scene: its light, and the plugins of its parts. All colours come from the theme.

pub mod best_flag;
mod cache;
pub mod camera;
pub mod confetti;
pub mod dents;
pub mod ground;
pub mod landing;
pub mod lane_marks;
mod lane_pieces;
pub mod limb;
pub mod meshes;
mod mipmaps;
pub mod name_tags;
pub mod overlays;
mod plain_sky;
mod plants;
pub mod props;
pub mod quality;
pub mod sky;
pub mod snake;
pub mod stage_view;
pub mod stairs;
pub mod step_edges;
pub mod step_labels;
pub mod surface_look;
pub mod surface_material;
pub mod surface_texture;
pub mod text;
pub mod view_commands;
pub mod way_back;
pub mod wireframe;

use bevy::light::{CascadeShadowConfig, CascadeShadowConfigBuilder};
use bevy::pbr::DistanceFog;
use bevy::prelude::*;

use super::schedule::FrameSet;
use super::ui::theme::Theme;

use props::Props;
use surface_material::SurfaceMaterials;
use text::TextMeshes;
use way_back::WayBack;

/// Adds the scene of the window: everything that is drawn, the camera and the mouse.
pub(super) fn plugin(app: &mut App) {
    app.add_plugins((
        drawing,
        camera::plugin,
        camera::mouse::plugin,
        quality::watch_frames,
        wireframe::plugin,
        name_tags::plugin,
        plain_sky::plugin,
        confetti::plugin,
    ));
}

/// Adds the parts of the scene that pictures without a window also have.
pub(super) fn drawing(app: &mut App) {
    app.init_resource::<Theme>()
        .init_resource::<Props>()
        .init_resource::<TextMeshes>()
        .init_resource::<SurfaceMaterials>()
        .init_resource::<WayBack>()
        .add_plugins((quality::plugin, sky::plugin, snake::plugin, overlays::plugin))
        .add_systems(Startup, (set_up, ground::set_up))
        .add_systems(
            Update,
            (
                (lane_pieces::build, (step_edges::light, dents::place)).chain(),
                (fit_shadows, plants::plant, best_flag::plant),
                (dress, props::recolor, surface_material::dress).run_if(resource_changed::<Theme>),
            )
                .in_set(FrameSet::Draw),
        )
        .add_systems(PostUpdate, lane_marks::show.before(TransformSystems::Propagate));
}

/// Direction to the sun or the moon: behind the viewer's right shoulder in the default view, so that treads and risers have different
/// brightness.
const LIGHT_FROM: Vec3 = Vec3::new(9.0, -12.0, 16.0);
/// Ratio of the shadows' reach to the distance of the point at which the camera looks, so that shadows cover its surroundings.
const SHADOWS_BEYOND: f32 = 1.7;
/// Allowed reach of the shadows, in metres from the camera.
const SHADOWS_END_M: std::ops::RangeInclusive<f32> = 14.0..=150.0;
/// Ratio between two steps of the shadows' reach. The reach changes in steps, so that shadows do not crawl while the camera moves.
const SHADOW_STEP: f32 = 1.3;

fn set_up(mut commands: Commands) {
    commands.spawn((
        DirectionalLight {
            shadow_maps_enabled: true,
            // A smaller depth bias, in metres, makes treads cast saw-tooth shadows on the risers behind them.
            shadow_depth_bias: 0.09,
            ..default()
        },
        Transform::from_translation(LIGHT_FROM).looking_at(Vec3::ZERO, Vec3::Z),
        shadows_until(*SHADOWS_END_M.end()),
    ));
}

fn shadows_until(end_m: f32) -> CascadeShadowConfig {
    CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: end_m, ..default() }.build()
}

/// Fits the shadow map to the view. Shadows are sharp when the camera is near, and remain visible when it is far away.
fn fit_shadows(
    cameras: Query<&Transform, With<Camera3d>>,
    mut suns: Query<&mut CascadeShadowConfig, With<DirectionalLight>>,
    mut end_m: Local<f32>,
) {
    let Some(camera) = cameras.iter().next() else { return };
    let fitting_m = shadows_end_m(camera);
    if *end_m != fitting_m {
        *end_m = fitting_m;
        suns.iter_mut().for_each(|mut sun| *sun = shadows_until(fitting_m));
    }
}

/// Returns the reach of the shadows for a camera, in metres: beyond the ground point at which it looks.
fn shadows_end_m(camera: &Transform) -> f32 {
    let down = (-camera.forward().z).max(0.01);
    let looked_at_m = camera.translation.z.max(0.0) / down;
    let (nearest_m, farthest_m) = (*SHADOWS_END_M.start(), *SHADOWS_END_M.end());
    let wanted_m = (looked_at_m * SHADOWS_BEYOND).clamp(nearest_m, farthest_m);
    let steps = (libm::logf(wanted_m / nearest_m) / libm::logf(SHADOW_STEP)).ceil();
    nearest_m * libm::powf(SHADOW_STEP, steps)
}

/// Applies the theme's colours to light and fog.
fn dress(
    theme: Res<Theme>,
    mut suns: Query<&mut DirectionalLight>,
    mut fogs: Query<&mut DistanceFog>,
    mut commands: Commands,
) {
    let palette = theme.palette();
    for mut sun in &mut suns {
        sun.color = palette.sun;
        sun.illuminance = palette.sun_lux;
    }
    fogs.iter_mut().for_each(|mut fog| fog.color = palette.horizon);
    commands.insert_resource(ClearColor(palette.horizon));
    commands.insert_resource(GlobalAmbientLight {
        color: palette.ambient,
        brightness: palette.ambient_cd_m2,
        ..default()
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shadows_reach_beyond_the_target_and_change_in_steps() {
        let from = |distance_m: f32| {
            let eye = Vec3::new(distance_m * 0.8, 0.0, distance_m * 0.6);
            shadows_end_m(&Transform::from_translation(eye).looking_at(Vec3::ZERO, Vec3::Z))
        };
        for distance_m in [3.0, 24.0, 60.0] {
            assert!(from(distance_m) > distance_m * 1.5, "{distance_m}: {}", from(distance_m));
        }
        assert_eq!(from(24.0), from(24.1));
        assert!(from(8.0) < from(24.0) && from(500.0) < 200.0);
    }
}
