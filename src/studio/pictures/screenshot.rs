//! Screenshots of the window, and of the stage alone, larger than it is in the window.

use bevy::camera::RenderTarget;
use bevy::ecs::system::SystemParam;
use bevy::image::Image;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::renderer::RenderAdapterInfo;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::PrimaryWindow;
use wgpu_types::DeviceType;

use crate::studio::commands::ScreenshotArea;
use crate::studio::scene::camera::{StageCamera, camera_components};
use crate::studio::schedule::FrameSet;
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::new_file::offer_picture;
use crate::studio::ui::notifications::Notices;
use crate::studio::ui::theme::Theme;
use crate::studio::ui::viewport::StageArea;
use snakes_core::save::{Picture, encoded_picture};

/// A second camera, which renders the stage to an image for a screenshot.
#[derive(Component)]
struct PendingScreenshot {
    picture: Handle<Image>,
    /// Number of frames until the picture is taken.
    frames: u32,
}

/// Query of the pictures that were requested and are not saved yet.
#[derive(SystemParam)]
pub(crate) struct AwaitedPictures<'w, 's> {
    cameras: Query<'w, 's, (), With<PendingScreenshot>>,
    pictures: Query<'w, 's, (), With<Screenshot>>,
}

impl AwaitedPictures<'_, '_> {
    /// Returns whether all requested pictures are saved.
    pub fn is_empty(&self) -> bool {
        self.cameras.is_empty() && self.pictures.is_empty()
    }
}

/// Number of frames until a new camera's picture is complete. Its pipelines must be compiled first.
const FRAMES: u32 = 4;

pub(crate) fn plugin(app: &mut App) {
    app.add_message::<ScreenshotArea>()
        .add_systems(Update, (take, take_stage_pictures).chain().in_set(FrameSet::Draw));
}

/// Minimum width of a picture of the stage, in pixels. A driver without a graphics card would draw it for half a minute, while the window
/// stands still; its pictures are as large as the stage.
const LEAST_WIDTH: u32 = 1920;

/// Returns the size of a picture of a stage of this size, both in pixels: the smallest multiple with the minimum width of the device.
fn picture_size(stage: Vec2, device: DeviceType) -> UVec2 {
    let stage = stage.max(Vec2::ONE).as_uvec2();
    if device == DeviceType::Cpu { stage } else { stage * LEAST_WIDTH.div_ceil(stage.x) }
}

/// Takes a screenshot of the window at once. For one of the stage, spawns a second camera, unless one is at work: a software driver takes
/// seconds for each frame of each.
fn take(
    mut requests: MessageReader<ScreenshotArea>,
    place: Single<&Transform, With<StageCamera>>,
    window: Single<&Window, With<PrimaryWindow>>,
    (stage, adapter): (Res<StageArea>, Res<RenderAdapterInfo>),
    at_work: Query<(), With<PendingScreenshot>>,
    mut images: ResMut<Assets<Image>>,
    theme: Res<Theme>,
    mut commands: Commands,
) {
    let mut is_free = at_work.is_empty();
    for area in requests.read() {
        match area {
            ScreenshotArea::Window => {
                commands.spawn(Screenshot::primary_window()).observe(keep);
            }
            ScreenshotArea::Stage if !std::mem::take(&mut is_free) => {}
            ScreenshotArea::Stage => {
                let size = stage.in_window().size() * window.scale_factor();
                let size = picture_size(size, adapter.device_type);
                let format = TextureFormat::Rgba8UnormSrgb;
                let picture = images.add(Image::new_target_texture(size.x, size.y, format, None));
                commands.spawn((
                    PendingScreenshot { picture: picture.clone(), frames: FRAMES },
                    camera_components(theme.palette()),
                    RenderTarget::Image(picture.into()),
                    **place,
                ));
            }
        }
    }
}

/// Takes the pictures of second cameras that are ready, and despawns the cameras.
fn take_stage_pictures(
    mut cameras: Query<(Entity, &mut PendingScreenshot)>,
    mut commands: Commands,
) {
    for (entity, mut pending) in &mut cameras {
        pending.frames = pending.frames.saturating_sub(1);
        match pending.frames {
            1 => {
                let screenshot = Screenshot::image(pending.picture.clone());
                commands.spawn(screenshot).observe(keep);
            }
            0 => commands.entity(entity).despawn(),
            _ => {}
        }
    }
}

/// Saves a picture, and shows its path to the user.
fn keep(captured: On<ScreenshotCaptured>, run: Res<CurrentRun>, mut notices: ResMut<Notices>) {
    let Some(picture) = picture_of(&captured.image) else {
        return notices.problem("The renderer returned no picture.".to_owned());
    };
    let add = |bytes: Vec<u8>| {
        let folder = run.context.saves.pictures();
        folder.add_file("snakes-and-stairs", "png", &bytes).map_err(|error| error.to_string())
    };
    match encoded_picture(&picture).map_err(|error| error.to_string()).and_then(add) {
        Ok(path) => {
            let text = format!("Picture saved to {}", path.display());
            offer_picture(&mut notices, text, &path);
        }
        Err(problem) => notices.problem(problem),
    }
}

/// Converts an image to a picture without the alpha channel; `None` if the image has no content.
pub(crate) fn picture_of(image: &Image) -> Option<Picture> {
    let bgr = matches!(
        image.texture_descriptor.format,
        TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb
    );
    let pixels = image.data.as_ref()?.as_chunks::<4>().0;
    let rgb = pixels
        .iter()
        .flat_map(|&[a, b, c, _]| if bgr { [c, b, a] } else { [a, b, c] })
        .collect::<Vec<u8>>();
    let (width, height) = (image.width(), image.height());
    let is_whole = rgb.len() == width as usize * height as usize * 3;
    is_whole.then_some(Picture { width, height, rgb })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a27_a_picture_of_a_small_stage_is_a_multiple_of_at_least_1920_pixels() {
        for (stage, picture) in
            [([895, 503], [2685, 1509]), ([1920, 1080], [1920, 1080]), ([2400, 900], [2400, 900])]
        {
            let stage = UVec2::from(stage);
            let size = |device| picture_size(stage.as_vec2(), device);
            assert_eq!(size(DeviceType::IntegratedGpu), UVec2::from(picture));
            assert_eq!(size(DeviceType::Cpu), stage, "without a graphics card");
        }
    }
}
