//! Pictures of champions as the studio draws them, without a window: the report's Figures 5 to 10.
//!
//! Each shows where a champion's rollout ends, and, fainter, where it was on the way.

use bevy::prelude::*;

use super::exhibit::Exhibit;
use super::lane::Lane;
use super::look::Theme;
use super::offscreen::Offscreen;
use super::{StudioError, camera, scene};
use crate::save::{LoadedChampion, Picture};
use crate::score::Evaluation;

/// How many faint snakes show the way to the end; the first is the start.
const MOMENTS: u32 = 4;

/// Draws the end of each champion's rollout, and says what it reached this time. `each` is told the number
/// of every picture that is done.
///
/// # Errors
/// There is no graphics driver.
pub fn draw(
    champions: &[LoadedChampion],
    (width, height): (u32, u32),
    mut each: impl FnMut(usize),
) -> Result<Vec<(Picture, Evaluation)>, StudioError> {
    Offscreen::draw((width, height), Theme::Light, |studio| {
        let mut pictures = Vec::new();
        for (index, champion) in champions.iter().enumerate() {
            let evaluation = put_in_place(studio, champion);
            pictures.push((studio.picture()?, evaluation));
            each(index);
        }
        Ok(pictures)
    })
}

/// Replaces what is in front of the camera by a champion at the end of its rollout. Returns what it reached.
fn put_in_place(studio: &mut Offscreen, loaded: &LoadedChampion) -> Evaluation {
    let champion = &loaded.champion;
    let world = studio.app.world_mut();
    let earlier: Vec<Entity> = world.query_filtered::<Entity, With<Lane>>().iter(world).collect();
    earlier.into_iter().for_each(|lane| world.entity_mut(lane).despawn());

    let mut lane = Lane::new(Exhibit::saved(loaded, 0, "champion"), 0);
    let moments = lane.skip_to_end(MOMENTS);
    let evaluation = lane.evaluation();
    let ends_at_m = lane.drawn_poses().map(|pose| pose.translation.y).fold(f32::MIN, f32::max);
    let agent = champion.trial.agent.clone();
    let starts_at_m = champion.trial.start_y_m - agent.length_m() / 2.0;
    let stairs_show_m = champion.trial.stairs.riser_y_m(4);
    let place = camera::overlooking(starts_at_m, ends_at_m.max(stairs_show_m) + 1.0);
    studio.look_from(place);

    let world = studio.app.world_mut();
    let (cube, faint) = faint_props(world);
    world.spawn((lane, Transform::default(), Visibility::default())).with_children(|parent| {
        for poses in moments {
            for (limb, pose) in poses.into_iter().enumerate() {
                let size = Vec3::from(agent.limb_size_m(limb));
                parent.spawn((
                    Mesh3d(cube.clone()),
                    MeshMaterial3d(faint[limb % 2].clone()),
                    scene::box_transform(pose.translation, size).with_rotation(pose.rotation),
                    bevy::light::NotShadowCaster,
                ));
            }
        }
    });
    evaluation
}

/// The cube, and the two colours of the snake as glass.
fn faint_props(world: &mut World) -> (Handle<Mesh>, [Handle<StandardMaterial>; 2]) {
    const OPACITY: f32 = 0.22;
    let palette = Theme::Light.palette();
    let cube = world.resource::<scene::Props>().cube.clone();
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    let faint = [palette.red_limb, palette.blue_limb].map(|color| {
        materials.add(StandardMaterial {
            base_color: color.with_alpha(OPACITY),
            alpha_mode: AlphaMode::Blend,
            ..default()
        })
    });
    (cube, faint)
}
