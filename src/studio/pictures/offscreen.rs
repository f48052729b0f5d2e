//! Renders the studio's scene to a picture, without a window.

use std::sync::{Mutex, PoisonError};

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

use super::screenshot::picture_of;
use crate::save::Picture;
use crate::studio::error::StudioError;
use crate::studio::failure::panic_guard;
use crate::studio::scene::{self, camera};
use crate::studio::schedule::FrameSet;
use crate::studio::ui::theme::Theme;

/// An app with the studio's scene, without a window and without a main loop.
pub(crate) struct Offscreen {
    /// The app. The caller adds the content of the scene.
    pub app: App,
    target: Handle<Image>,
}

/// The picture that the renderer returned.
#[derive(Resource, Default)]
struct FinishedPicture(Mutex<Option<Picture>>);

/// Frames until uploads have finished and a picture is complete.
const FRAMES: u32 = 4;
/// Maximum number of frames to wait for a picture.
const MAX_FRAMES: u32 = 200;

impl Offscreen {
    /// Runs `work`, which fills the scene and takes pictures of `size` pixels.
    ///
    /// # Errors
    /// No graphics driver is available, or `work` failed.
    pub fn draw<T>(
        size: (u32, u32),
        theme: Theme,
        work: impl FnOnce(&mut Self) -> Result<T, StudioError>,
    ) -> Result<T, StudioError> {
        let mut done = None;
        let drawn = panic_guard::guarded(&Default::default(), || {
            done = Some(work(&mut Self::new(size, theme)));
            AppExit::Success
        });
        match (drawn, done) {
            (Err(StudioError::NoWindow(reason)), _) => Err(StudioError::NoPicture(reason)),
            (Err(other), _) => Err(other),
            (Ok(_), Some(done)) => done,
            (Ok(_), None) => Err(StudioError::NoPicture("the renderer drew nothing".to_owned())),
        }
    }

    fn new((width, height): (u32, u32), theme: Theme) -> Self {
        let mut app = App::new();
        app.insert_resource(theme)
            .add_plugins(
                DefaultPlugins
                    .set(WindowPlugin {
                        primary_window: None,
                        exit_condition: ExitCondition::DontExit,
                        ..default()
                    })
                    // Wait until all pipelines are compiled.
                    .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
                    .set(LogPlugin { level: Level::ERROR, ..default() })
                    .disable::<WinitPlugin>()
                    .disable::<PipelinedRenderingPlugin>(),
            )
            .configure_sets(
                Update,
                (FrameSet::TakeIn, FrameSet::Apply, FrameSet::Advance, FrameSet::Draw).chain(),
            )
            .init_resource::<FinishedPicture>()
            .add_plugins(scene::drawing);
        while app.plugins_state() == bevy::app::PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        let texture = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(texture);
        // Anti-alias on every machine, because there are only a few pictures.
        let eye = camera::camera_components(Msaa::Sample4, theme.palette());
        app.world_mut().spawn((eye, RenderTarget::Image(target.clone().into())));
        app.update();
        Self { app, target }
    }

    /// Places the camera.
    pub fn place_camera(&mut self, place: Transform) {
        let world = self.app.world_mut();
        let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
        cameras.iter_mut(world).for_each(|mut camera| *camera = place);
    }

    /// Draws some frames and returns the last one.
    ///
    /// # Errors
    /// The renderer returned no picture.
    pub fn picture(&mut self) -> Result<Picture, StudioError> {
        (0..FRAMES).for_each(|_| self.app.update());
        self.app.world_mut().spawn(Screenshot::image(self.target.clone())).observe(
            |captured: On<ScreenshotCaptured>, finished: Res<FinishedPicture>| {
                *finished.0.lock().unwrap_or_else(PoisonError::into_inner) =
                    picture_of(&captured.image);
            },
        );
        let picture = (0..MAX_FRAMES).find_map(|_| {
            self.app.update();
            let finished = self.app.world().resource::<FinishedPicture>();
            finished.0.lock().unwrap_or_else(PoisonError::into_inner).take()
        });
        picture.ok_or_else(|| StudioError::NoPicture("the renderer returned no picture".to_owned()))
    }

    /// Pixel positions of world points, from the top left of the picture; `None` behind the camera. Take the picture
    /// first.
    pub fn pixels_of(&mut self, points: impl IntoIterator<Item = Vec3>) -> Vec<Option<Vec2>> {
        let world = self.app.world_mut();
        let mut cameras = world.query::<(&Camera, &GlobalTransform)>();
        let camera = cameras.iter(world).next();
        let place =
            |point| camera.and_then(|(camera, at)| camera.world_to_viewport(at, point).ok());
        points.into_iter().map(place).collect()
    }
}
