//! Pictures: of the window as it is, or of the stage alone, as large as it is in the window.

use bevy::camera::RenderTarget;
use bevy::image::Image;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};

use super::Frame;
use super::camera::{StageCamera, eye};
use super::engine::Engine;
use super::look::Theme;
use super::notice::Notices;
use crate::save::{Picture, store_picture};

/// Asks for a picture.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Photograph {
    /// Of the stage, without panels.
    Stage,
    /// Of the whole window.
    Window,
}

/// A camera beside the one of the window, with a picture of its own.
#[derive(Component)]
struct Darkroom {
    picture: Handle<Image>,
    /// Frames until the picture is there.
    frames: u32,
}

/// What a new camera sees is complete after so many frames: pipelines for its picture are compiled first.
const FRAMES: u32 = 4;

pub(super) fn plugin(app: &mut App) {
    app.add_message::<Photograph>()
        .add_systems(Update, (take, develop).chain().in_set(Frame::Draw));
}

/// Takes a picture of the window at once; for one of the stage a second camera is put beside the first.
fn take(
    mut asked: MessageReader<Photograph>,
    camera: Single<(&Camera, &Transform, &Msaa), With<StageCamera>>,
    mut images: ResMut<Assets<Image>>,
    theme: Res<Theme>,
    mut commands: Commands,
) {
    let (camera, place, msaa) = *camera;
    for photograph in asked.read() {
        match photograph {
            Photograph::Window => {
                commands.spawn(Screenshot::primary_window()).observe(keep);
            }
            Photograph::Stage => {
                let size = camera.physical_viewport_size().unwrap_or(UVec2::new(1280, 720));
                let format = TextureFormat::Rgba8UnormSrgb;
                let picture = images.add(Image::new_target_texture(size.x, size.y, format, None));
                commands.spawn((
                    Darkroom { picture: picture.clone(), frames: FRAMES },
                    eye(*msaa, theme.palette()),
                    RenderTarget::Image(picture.into()),
                    *place,
                ));
            }
        }
    }
}

/// Brings the picture of the second camera back, and puts the camera away.
fn develop(mut darkrooms: Query<(Entity, &mut Darkroom)>, mut commands: Commands) {
    for (entity, mut darkroom) in &mut darkrooms {
        darkroom.frames = darkroom.frames.saturating_sub(1);
        match darkroom.frames {
            1 => {
                let screenshot = Screenshot::image(darkroom.picture.clone());
                commands.spawn(screenshot).observe(keep);
            }
            0 => commands.entity(entity).despawn(),
            _ => {}
        }
    }
}

/// Saves a picture and says where.
fn keep(captured: On<ScreenshotCaptured>, engine: Res<Engine>, mut notices: ResMut<Notices>) {
    let Some(picture) = picture_of(&captured.image) else {
        return notices.problem("The renderer brought no picture back.".to_owned());
    };
    let folder = engine.saves.pictures();
    let kept = folder.prepare().and_then(|()| {
        let path = folder.free_name("snakes-and-stairs", "png");
        store_picture(&path, &picture).map(|()| path)
    });
    match kept {
        Ok(path) => notices.news(format!("Picture saved to {}", path.display())),
        Err(error) => notices.problem(error.to_string()),
    }
}

/// The colours of an image without its opacity.
pub(super) fn picture_of(image: &Image) -> Option<Picture> {
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
