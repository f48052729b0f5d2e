//! Renders pictures of champions without a window, like Figures 5 to 10 of the report.
//!
//! Each picture shows the final pose of a champion's rollout and, translucent, earlier poses.

use bevy::prelude::*;

use super::offscreen::Offscreen;
use crate::studio::error::StudioError;
use crate::studio::scene;
use crate::studio::scene::camera;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::placed;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::ui::theme::Theme;
use snakes_core::save::{LoadedChampion, Picture};
use snakes_core::score::Evaluation;

/// Number of translucent earlier poses; the first is the initial pose.
const MOMENTS: u32 = 4;

/// Draws the final pose of each champion's rollout, and returns the pictures and results. Calls `each` with the index
/// of every finished picture.
///
/// # Errors
/// No graphics driver is available.
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

/// Replaces the scene by a champion at the end of its rollout. Returns the champion's result.
fn put_in_place(studio: &mut Offscreen, loaded: &LoadedChampion) -> Evaluation {
    let champion = &loaded.champion;
    studio.clear_stage();
    let mut lane = Lane::new(StagedChampion::from_file(loaded, 0, "champion"), 0);
    let moments = lane.skip_to_end(MOMENTS);
    let evaluation = lane.evaluation();
    let ends_at_m = lane.drawn_poses().map(|pose| pose.translation.y).fold(f32::MIN, f32::max);
    let body = lane.body.clone();
    let starts_at_m = champion.trial.start_y_m - body.length_m() / 2.0;
    let stairs_show_m = champion.trial.stairs.riser_y_m(4);
    let place = camera::overview_transform(starts_at_m, ends_at_m.max(stairs_show_m) + 1.0);
    studio.place_camera(place);

    let world = studio.app.world_mut();
    let (cube, faint) = faint_props(world);
    world.spawn(placed(lane)).with_children(|parent| {
        for poses in moments {
            for (pose, plan) in poses.into_iter().zip(&body.parts) {
                let scale = Vec3::from(plan.size_m());
                parent.spawn((
                    Mesh3d(cube.clone()),
                    MeshMaterial3d(faint[plan.limb % 2].clone()),
                    Transform { translation: pose.translation, rotation: pose.rotation, scale },
                    bevy::light::NotShadowCaster,
                ));
            }
        }
    });
    evaluation
}

/// Returns the unit cube, and translucent materials in red and blue.
fn faint_props(world: &mut World) -> (Handle<Mesh>, [Handle<StandardMaterial>; 2]) {
    const OPACITY: f32 = 0.22;
    let palette = Theme::Light.palette();
    let cube = world.resource::<scene::props::Props>().cube.clone();
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
