//! Pictures of champions as the studio draws them, without a window: the report's Figures 5 to 10.
//!
//! Each shows where a champion's rollout ends, and, fainter, where it was on the way.

use bevy::camera::RenderTarget;
use bevy::image::Image;
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use std::sync::{Mutex, PoisonError};

use super::exhibit::Exhibit;
use super::lane::Lane;
use super::screenshot::picture_of;
use super::{Frame, StudioError, camera, look, scene, snake, start_up};
use crate::save::{LoadedChampion, Picture};
use crate::score::Evaluation;

/// How many faint snakes show the way to the end; the first is the start.
const MOMENTS: u32 = 4;
/// Frames until a picture is complete: what is new has been uploaded and drawn.
const FRAMES: u32 = 4;
/// After so many frames without a picture something is broken.
const MOST_FRAMES: u32 = 200;

/// The picture that the renderer has brought back.
#[derive(Resource, Default)]
struct Developed(Mutex<Option<Picture>>);

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
    let mut pictures = Vec::new();
    let mut problem = None;
    let result = start_up::guarded(&Default::default(), || {
        let mut app = studio_without_window();
        let target = set_up(&mut app, width, height);
        for (index, champion) in champions.iter().enumerate() {
            let evaluation = put_in_place(&mut app, champion);
            match take_picture(&mut app, &target) {
                Some(picture) => pictures.push((picture, evaluation)),
                None => {
                    problem = Some(StudioError::NoPicture("the renderer brought none back".into()));
                    break;
                }
            }
            each(index);
        }
        AppExit::Success
    });
    match (result, problem) {
        (Err(StudioError::NoWindow(reason)), _) => Err(StudioError::NoPicture(reason)),
        (Err(other), _) => Err(other),
        (Ok(_), Some(problem)) => Err(problem),
        (Ok(_), None) => Ok(pictures),
    }
}

/// The studio's scene and snake in an app that has no window and does nothing by itself.
fn studio_without_window() -> App {
    let mut app = App::new();
    app.add_plugins(
        DefaultPlugins
            .set(WindowPlugin {
                primary_window: None,
                exit_condition: ExitCondition::DontExit,
                ..default()
            })
            // A picture waits until everything can be drawn.
            .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
            .set(LogPlugin { level: Level::ERROR, ..default() })
            .disable::<WinitPlugin>()
            .disable::<PipelinedRenderingPlugin>(),
    )
    .configure_sets(Update, (Frame::TakeIn, Frame::Apply, Frame::Advance, Frame::Draw).chain())
    .init_resource::<Developed>()
    .add_plugins((scene::plugin, snake::plugin));
    while app.plugins_state() == bevy::app::PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
    app
}

/// Puts the camera in front of a texture instead of a window.
fn set_up(app: &mut App, width: u32, height: u32) -> Handle<Image> {
    let texture = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    let target = app.world_mut().resource_mut::<Assets<Image>>().add(texture);
    // Pictures are few, so their edges may be smooth on every machine.
    let palette = app.world().resource::<look::Theme>().palette();
    let eye = camera::eye(Msaa::Sample4, palette);
    app.world_mut().spawn((eye, RenderTarget::Image(target.clone().into())));
    app.update();
    target
}

/// Replaces what is in front of the camera by a champion at the end of its rollout. Returns what it reached.
fn put_in_place(app: &mut App, loaded: &LoadedChampion) -> Evaluation {
    let champion = &loaded.champion;
    let world = app.world_mut();
    let earlier: Vec<Entity> = world.query_filtered::<Entity, With<Lane>>().iter(world).collect();
    earlier.into_iter().for_each(|stage| world.entity_mut(stage).despawn());

    let mut stage = Lane::new(Exhibit::saved(loaded, 0, "champion"), 0);
    let moments = stage.skip_to_end(MOMENTS);
    let evaluation = stage.evaluation();
    let ends_at_m = stage.drawn_poses().map(|pose| pose.translation.y).fold(f32::MIN, f32::max);
    let agent = champion.trial.agent.clone();
    let starts_at_m = champion.trial.start_y_m - agent.length_m() / 2.0;
    let stairs_show_m = champion.trial.stairs.riser_y_m(4);
    let place = camera::overlooking(starts_at_m, ends_at_m.max(stairs_show_m) + 1.0);
    let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
    cameras.iter_mut(world).for_each(|mut camera| *camera = place);

    let (cube, faint) = faint_props(world);
    world.spawn((stage, Transform::default(), Visibility::default())).with_children(|parent| {
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
    let palette = world.resource::<look::Theme>().palette();
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

/// Draws some frames and brings the last one back.
fn take_picture(app: &mut App, target: &Handle<Image>) -> Option<Picture> {
    (0..FRAMES).for_each(|_| app.update());
    app.world_mut().spawn(Screenshot::image(target.clone())).observe(
        |captured: On<ScreenshotCaptured>, developed: Res<Developed>| {
            *developed.0.lock().unwrap_or_else(PoisonError::into_inner) =
                picture_of(&captured.image);
        },
    );
    (0..MOST_FRAMES).find_map(|_| {
        app.update();
        let developed = app.world().resource::<Developed>();
        developed.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    })
}
