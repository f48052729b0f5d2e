//! Renders the studio's scene to a picture, without a window.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use bevy::app::{SubApp, TaskPoolOptions, TaskPoolPlugin, TerminalCtrlCHandlerPlugin};
use bevy::camera::RenderTarget;
use bevy::ecs::schedule::{Schedules, SingleThreadedExecutor};
use bevy::image::Image;
use bevy::log::{DEFAULT_FILTER, Level, LogPlugin};
use bevy::prelude::*;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{PipelineCache, TextureFormat};
use bevy::render::renderer::RenderDevice;
use bevy::render::view::NoIndirectDrawing;
use bevy::render::view::screenshot::{
    Captured, CapturedScreenshots, Screenshot, ScreenshotCaptured,
};
use bevy::render::{RenderApp, RenderPlugin};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use wgpu_types::PollType;

use super::screenshot::picture_of;
use crate::studio::commands::overlay::Overlay;
use crate::studio::error::StudioError;
use crate::studio::failure::panic_guard;
use crate::studio::scene::overlays::Overlays;
use crate::studio::scene::quality::StageQuality;
use crate::studio::scene::{self, camera};
use crate::studio::schedule;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::placed;
use crate::studio::ui::theme::Theme;
use snakes_core::save::Picture;
use snakes_lab::plot::NameTag;

/// The studio's scene in an app without a window and without a main loop.
pub(crate) struct Offscreen {
    /// App that renders the scene. The caller adds the content.
    pub app: App,
    target: Handle<Image>,
    /// Number of pictures that were requested.
    shots: u64,
}

/// Pictures that the renderer returned, by their numbers; `None` for one without content.
#[derive(Resource, Default)]
struct FinishedPictures(BTreeMap<u64, Option<Picture>>);

/// Whether the messages of this process have a log.
static HAS_LOG: AtomicBool = AtomicBool::new(false);
/// Number of frames after which uploads have finished and a picture is complete.
const FRAMES: u32 = 4;
/// Maximum number of frames to wait for pipelines that are still compiling.
const MAX_FRAMES: u32 = 200;
/// Interval at which returned pictures are checked for.
const GLANCE: Duration = Duration::from_millis(20);
/// Maximum time to wait for a picture.
const LONGEST_WAIT: Duration = Duration::from_secs(120);

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
        // Bevy's messages about pictures that had not arrived when the work ended are hidden. A missing picture is
        // reported separately.
        let filter = format!("{DEFAULT_FILTER},bevy_render::view::window::screenshot=off");
        let mut plugins = DefaultPlugins
            .set(WindowPlugin {
                primary_window: None,
                exit_condition: ExitCondition::DontExit,
                ..default()
            })
            // Each frame waits until all pipelines are compiled.
            .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
            .set(TaskPoolPlugin { task_pool_options: TaskPoolOptions::with_num_threads(1) })
            .set(LogPlugin { level: Level::ERROR, filter, ..default() })
            // Its handler of the interrupt key would ask an event loop to end, which does not run here.
            .disable::<TerminalCtrlCHandlerPlugin>()
            .disable::<WinitPlugin>()
            .disable::<PipelinedRenderingPlugin>();
        if HAS_LOG.swap(true, Ordering::Relaxed) {
            // A second film in a smaller size would report that there is a log already.
            plugins = plugins.disable::<LogPlugin>();
        }
        let mut app = App::new();
        app.insert_resource(theme)
            .insert_resource(StageQuality::for_films(width))
            .add_plugins((plugins, schedule::plugin))
            .init_resource::<FinishedPictures>()
            .add_plugins(scene::drawing);
        while app.plugins_state() == bevy::app::PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        run_systems_in_order(app.main_mut());
        app.get_sub_app_mut(RenderApp).into_iter().for_each(run_systems_in_order);
        let texture = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(texture);
        let eye = camera::camera_components(theme.palette());
        // With indirect drawing, the graphics card's threads determine the order of instances, which can affect pixels
        // where surfaces touch. The same scene must always give the same picture.
        app.world_mut().spawn((eye, RenderTarget::Image(target.clone().into()), NoIndirectDrawing));
        app.update();
        Self { app, target, shots: 0 }
    }

    /// Shows these overlays.
    pub fn show_overlays(&mut self, overlays: &[Overlay]) {
        self.app.world_mut().resource_mut::<Overlays>().extend(overlays);
    }

    /// Removes all lanes from the stage.
    pub fn clear_stage(&mut self) {
        let world = self.app.world_mut();
        let earlier: Vec<Entity> =
            world.query_filtered::<Entity, With<Lane>>().iter(world).collect();
        earlier.into_iter().for_each(|lane| world.entity_mut(lane).despawn());
    }

    /// Puts lanes onto the stage, side by side.
    pub fn put_on_stage(&mut self, lanes: Vec<Lane>) {
        for lane in lanes {
            self.app.world_mut().spawn(placed(lane));
        }
    }

    /// Sets the transform of the camera.
    pub fn place_camera(&mut self, place: Transform) {
        let world = self.app.world_mut();
        let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
        cameras.iter_mut(world).for_each(|mut camera| *camera = place);
    }

    /// Draws several frames and returns the last one.
    ///
    /// # Errors
    /// The renderer returned no picture.
    pub fn picture(&mut self) -> Result<Picture, StudioError> {
        self.settle();
        let number = self.shoot();
        self.await_shot(number)
    }

    /// Draws frames until new parts of the scene are complete. Other threads load the shaders, which can take several
    /// frames on a busy machine.
    pub fn settle(&mut self) {
        let mut complete = 0;
        for _ in 0..MAX_FRAMES {
            self.app.update();
            let renderer = self.app.get_sub_app(RenderApp);
            let pipelines = renderer.and_then(|of| of.world().get_resource::<PipelineCache>());
            let waits = pipelines.is_some_and(|of| of.waiting_pipelines().next().is_some());
            complete = if waits { 0 } else { complete + 1 };
            if complete >= FRAMES {
                return;
            }
        }
    }

    /// Draws the scene once, as it is now, and requests its picture, which arrives some frames later. Returns the
    /// number of the picture; the first is 0.
    pub fn shoot(&mut self) -> u64 {
        let number = self.shots;
        self.shots += 1;
        self.app.world_mut().spawn(Screenshot::image(self.target.clone())).observe(
            move |captured: On<ScreenshotCaptured>, mut finished: ResMut<FinishedPictures>| {
                finished.0.insert(number, picture_of(&captured.image));
            },
        );
        self.app.update();
        number
    }

    /// Returns the picture with this number if it has arrived. Each picture can be taken only once.
    ///
    /// # Errors
    /// The renderer returned no picture.
    pub fn taken(&mut self, number: u64) -> Result<Option<Picture>, StudioError> {
        let mut finished = self.app.world_mut().resource_mut::<FinishedPictures>();
        let taken = finished.0.remove(&number);
        taken.map(|picture| picture.ok_or_else(no_picture)).transpose()
    }

    /// Waits for the picture with this number. Draws no frames meanwhile, which would be slow with a software driver.
    ///
    /// # Errors
    /// The renderer returned no picture.
    pub fn await_shot(&mut self, number: u64) -> Result<Picture, StudioError> {
        let begin = Instant::now();
        loop {
            if let Some(picture) = self.taken(number)? {
                return Ok(picture);
            }
            if begin.elapsed() > LONGEST_WAIT {
                return Err(no_picture());
            }
            let world = self.app.world_mut();
            let waited = world.resource::<RenderDevice>().poll(PollType::wait_indefinitely());
            waited.map_err(|error| StudioError::NoPicture(error.to_string()))?;
            // Bevy would pass on finished pictures only once per frame, and the frame would have to be drawn.
            let captured = Arc::clone(&world.resource::<CapturedScreenshots>().0);
            let received = captured.lock().ok().and_then(|from| from.recv_timeout(GLANCE).ok());
            if let Some((entity, image)) = received {
                world.entity_mut(entity).insert(Captured);
                world.trigger(ScreenshotCaptured { entity, image });
            }
        }
    }

    /// Returns a tag for each text, at the projection of its point. Texts behind the camera are left out. The picture
    /// must be taken first.
    pub fn tags_of(&mut self, texts: Vec<(Vec3, String)>) -> Vec<NameTag> {
        let world = self.app.world_mut();
        let mut cameras = world.query::<(&Camera, &GlobalTransform)>();
        let Some((camera, eye)) = cameras.iter(world).next() else { return Vec::new() };
        let tag = |(point, text)| {
            let at = camera.world_to_viewport(eye, point).ok()?;
            Some(NameTag { text, at: (at.x, at.y) })
        };
        texts.into_iter().filter_map(tag).collect()
    }
}

/// Runs the systems of all schedules one after the other. With several threads, the order of the systems and thus of
/// drawing would depend on the load of the machine, which can affect pixels where surfaces touch. The same scene must
/// always give the same picture.
fn run_systems_in_order(app: &mut SubApp) {
    let Some(mut schedules) = app.world_mut().get_resource_mut::<Schedules>() else { return };
    for (_, schedule) in schedules.iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
}

fn no_picture() -> StudioError {
    StudioError::NoPicture("the renderer returned no picture".to_owned())
}
