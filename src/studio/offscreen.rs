//! The studio's scene without a window: for pictures.

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

use super::look::Theme;
use super::screenshot::picture_of;
use super::{Frame, StudioError, camera, overlay, scene, snake, start_up};
use crate::save::Picture;

/// The studio's scene in an app that has no window and does nothing by itself.
pub(super) struct Offscreen {
    /// The app, to be furnished.
    pub app: App,
    target: Handle<Image>,
}

/// The picture that the renderer has brought back.
#[derive(Resource, Default)]
struct Developed(Mutex<Option<Picture>>);

/// Frames until a picture is complete: what is new has been uploaded and drawn.
const FRAMES: u32 = 4;
/// After so many frames without a picture something is broken.
const MOST_FRAMES: u32 = 200;

impl Offscreen {
    /// Lets `work` furnish the scene and take pictures of `size` pixels.
    ///
    /// # Errors
    /// There is no graphics driver, or `work` failed.
    pub fn draw<T>(
        size: (u32, u32),
        theme: Theme,
        work: impl FnOnce(&mut Self) -> Result<T, StudioError>,
    ) -> Result<T, StudioError> {
        let mut done = None;
        let drawn = start_up::guarded(&Default::default(), || {
            done = Some(work(&mut Self::new(size, theme)));
            AppExit::Success
        });
        match (drawn, done) {
            (Err(StudioError::NoWindow(reason)), _) => Err(StudioError::NoPicture(reason)),
            (Err(other), _) => Err(other),
            (Ok(_), Some(done)) => done,
            (Ok(_), None) => Err(StudioError::NoPicture("nothing was drawn".to_owned())),
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
                    // A picture waits until everything can be drawn.
                    .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
                    .set(LogPlugin { level: Level::ERROR, ..default() })
                    .disable::<WinitPlugin>()
                    .disable::<PipelinedRenderingPlugin>(),
            )
            .configure_sets(
                Update,
                (Frame::TakeIn, Frame::Apply, Frame::Advance, Frame::Draw).chain(),
            )
            .init_resource::<Developed>()
            .add_plugins((scene::plugin, snake::plugin, overlay::plugin));
        while app.plugins_state() == bevy::app::PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        let texture = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(texture);
        // Pictures are few, so their edges may be smooth on every machine.
        let eye = camera::eye(Msaa::Sample4, theme.palette());
        app.world_mut().spawn((eye, RenderTarget::Image(target.clone().into())));
        app.update();
        Self { app, target }
    }

    /// Puts the camera in its place.
    pub fn look_from(&mut self, place: Transform) {
        let world = self.app.world_mut();
        let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
        cameras.iter_mut(world).for_each(|mut camera| *camera = place);
    }

    /// Draws some frames and brings the last one back.
    ///
    /// # Errors
    /// The renderer brings none back.
    pub fn picture(&mut self) -> Result<Picture, StudioError> {
        (0..FRAMES).for_each(|_| self.app.update());
        self.app.world_mut().spawn(Screenshot::image(self.target.clone())).observe(
            |captured: On<ScreenshotCaptured>, developed: Res<Developed>| {
                *developed.0.lock().unwrap_or_else(PoisonError::into_inner) =
                    picture_of(&captured.image);
            },
        );
        let picture = (0..MOST_FRAMES).find_map(|_| {
            self.app.update();
            let developed = self.app.world().resource::<Developed>();
            developed.0.lock().unwrap_or_else(PoisonError::into_inner).take()
        });
        picture.ok_or_else(|| StudioError::NoPicture("the renderer brought none back".to_owned()))
    }

    /// Where points of the world are in the picture, in pixels from its top left; those behind the camera are left
    /// out. The picture must have been taken.
    pub fn places_of(&mut self, points: impl IntoIterator<Item = Vec3>) -> Vec<Option<Vec2>> {
        let world = self.app.world_mut();
        let mut cameras = world.query::<(&Camera, &GlobalTransform)>();
        let camera = cameras.iter(world).next();
        let place =
            |point| camera.and_then(|(camera, at)| camera.world_to_viewport(at, point).ok());
        points.into_iter().map(place).collect()
    }
}
