//! What stands still: lights, the stairs of the trial on show, and, each in a file of its own, what is around and on
//! them. All of it has the theme's colours.

use bevy::light::{CascadeShadowConfig, CascadeShadowConfigBuilder, DirectionalLightShadowMap};
use bevy::pbr::DistanceFog;
use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;

use super::lane::Lane;
use super::look::Theme;
use super::quality::Quality;
use super::{Frame, ground, lettering, marks, nosing, paint, sky};
use crate::world::StairBox;

/// The meshes and materials that everything is built of.
#[derive(Resource, Debug)]
pub(super) struct Props {
    /// A cube of one metre; a transform makes any box of it.
    pub cube: Handle<Mesh>,
    /// Of the first, third, ... limb.
    pub red: Handle<StandardMaterial>,
    /// Of the second, fourth, ... limb.
    pub blue: Handle<StandardMaterial>,
    stair: Handle<StandardMaterial>,
    stair_other: Handle<StandardMaterial>,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Theme>()
        .init_resource::<Props>()
        .add_plugins((
            sky::plugin,
            ground::plugin,
            lettering::plugin,
            nosing::plugin,
            paint::plugin,
            marks::plugin,
        ))
        .add_systems(Startup, set_up)
        .add_systems(Update, (build_stairs, fit_shadows).in_set(Frame::Draw))
        .add_systems(Update, dress.in_set(Frame::Draw).run_if(resource_changed::<Theme>));
}

/// Shadows reach beyond what is looked at by this factor: to the far end of what stands around it.
const SHADOWS_BEYOND: f32 = 1.7;
/// Nearest and farthest end of the shadows, in metres from the camera.
const SHADOWS_END_M: std::ops::RangeInclusive<f32> = 14.0..=150.0;
/// From one end of the shadows to the next larger one: in steps, so that they do not crawl while the camera moves.
const SHADOW_STEP: f32 = 1.3;

impl FromWorld for Props {
    fn from_world(world: &mut World) -> Self {
        let cube = world.resource_mut::<Assets<Mesh>>().add(Cuboid::from_length(1.0));
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        // They get their colours with the theme.
        let mut material = |perceptual_roughness| {
            materials.add(StandardMaterial { perceptual_roughness, ..default() })
        };
        let [red, blue] = [0.55; 2].map(&mut material);
        let [stair, stair_other] = [0.9; 2].map(&mut material);
        Self { cube, red, blue, stair, stair_other }
    }
}

/// A transform that makes the unit cube a box.
pub(super) fn box_transform(centre: Vec3, size: Vec3) -> Transform {
    Transform::from_translation(centre).with_scale(size)
}

fn set_up(mut commands: Commands, adapter: Res<RenderAdapterInfo>) {
    let size = Quality::suiting(&adapter).shadow_map_pixels;
    commands.insert_resource(DirectionalLightShadowMap { size });
    commands.spawn((
        DirectionalLight {
            shadow_maps_enabled: true,
            // Below this, in metres, a tread darkens the foot of the riser behind it in teeth.
            shadow_depth_bias: 0.09,
            ..default()
        },
        // From behind the viewer's right shoulder, so that both treads and risers are lit and differ.
        Transform::from_xyz(9.0, -12.0, 16.0).looking_at(Vec3::ZERO, Vec3::Z),
        shadows_until(*SHADOWS_END_M.end()),
    ));
}

fn shadows_until(end_m: f32) -> CascadeShadowConfig {
    CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: end_m, ..default() }.build()
}

/// Spends the shadow map on what is in view: from near by, shadows are sharp; from far away, they are still there.
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

/// Where shadows may end for a camera: beyond the place on the ground that it looks at.
fn shadows_end_m(camera: &Transform) -> f32 {
    let down = (-camera.forward().z).max(0.01);
    let looked_at_m = camera.translation.z.max(0.0) / down;
    let (nearest_m, farthest_m) = (*SHADOWS_END_M.start(), *SHADOWS_END_M.end());
    let wanted_m = (looked_at_m * SHADOWS_BEYOND).clamp(nearest_m, farthest_m);
    let steps = (libm::logf(wanted_m / nearest_m) / libm::logf(SHADOW_STEP)).ceil();
    nearest_m * libm::powf(SHADOW_STEP, steps)
}

/// Gives everything the colours of the theme.
fn dress(
    theme: Res<Theme>,
    props: Res<Props>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut suns: Query<&mut DirectionalLight>,
    mut fogs: Query<&mut DistanceFog>,
    mut commands: Commands,
) {
    let palette = theme.palette();
    for (handle, color) in [
        (&props.red, palette.red_limb),
        (&props.blue, palette.blue_limb),
        (&props.stair, palette.stair),
        (&props.stair_other, palette.stair_other),
    ] {
        if let Some(mut material) = materials.get_mut(handle) {
            material.base_color = color;
        }
    }
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

/// Builds the stairs of a lane that is new.
fn build_stairs(
    lanes: Query<(Entity, &Lane), Added<Lane>>,
    props: Res<Props>,
    mut commands: Commands,
) {
    for (entity, lane) in &lanes {
        commands.entity(entity).with_children(|parent| {
            let boxes = lane.trial().stairs.boxes();
            for (index, StairBox { min_m, max_m }) in boxes.into_iter().enumerate() {
                let (min, max) = (Vec3::from(min_m), Vec3::from(max_m));
                let material = if index % 2 == 0 { &props.stair } else { &props.stair_other };
                parent.spawn((
                    Mesh3d(props.cube.clone()),
                    MeshMaterial3d(material.clone()),
                    box_transform((min + max) / 2.0, max - min),
                ));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shadows_reach_beyond_what_is_looked_at_and_change_in_steps() {
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
