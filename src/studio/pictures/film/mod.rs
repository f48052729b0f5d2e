//! Films of champions, rendered without a window at exact simulated times. No clock influences a frame: the same
//! champions and options give the same frames on every machine, however slowly it draws.
//!
//! [`plan`] determines the time that each frame shows, and [`camera_path`] the camera. [`shooting`] draws the frames,
//! and [`gif_file`], [`video`] and [`frame_folder`] write them.

mod camera_path;
mod error;
mod film_file;
mod frame_folder;
mod gif_file;
mod order;
mod plan;
mod shooting;
mod video;

use std::path::Path;

use crate::studio::stage::evenly;
use snakes_core::check::{Invalid, within};
use snakes_lab::export::{ExportFormat, ExportProgress};

pub use error::FilmError;
pub(crate) use frame_folder::frame_folder_of;
pub(crate) use gif_file::GIF_FPS;
pub use order::{FilmOrder, FilmPart};

use film_file::FilmFile;
use frame_folder::FrameFolder;
use gif_file::{BegunGif, GifPalette, SAMPLES};
use plan::planned;
use shooting::shoot;
use video::Video;

/// Maximum number of frames of a film: almost an hour at 30 frames per second.
const MOST_FRAMES: usize = 100_000;

/// Checks that films in this format can have this size, in pixels.
///
/// # Errors
/// The format does not support the size.
pub(crate) fn check_film_size(format: ExportFormat, size: (u32, u32)) -> Result<(), Invalid> {
    if format == ExportFormat::Mp4 { video::check_size(size) } else { Ok(()) }
}

/// Draws a film and writes it.
///
/// # Errors
/// A champion cannot be simulated, no graphics driver or no ffmpeg is available, the file cannot be written, or the
/// user cancelled. Then no file or folder with the film's name is left behind.
pub fn film(
    order: &FilmOrder,
    format: ExportFormat,
    path: &Path,
    progress: &ExportProgress,
) -> Result<(), FilmError> {
    let plan = planned(order)?;
    within("number of frames", plan.len(), 1..=MOST_FRAMES)?;
    let (size, fps) = (order.size, order.fps);
    // The file is created first, so that a file that cannot be written is reported before the first frame is drawn.
    let mut file: Option<Box<dyn FilmFile>> = match format {
        ExportFormat::Mp4 => Some(Box::new(Video::begin(path, size, fps)?)),
        ExportFormat::Png => Some(Box::new(FrameFolder::begin(path, plan.len())?)),
        _ => None,
    };
    let mut gif = file.is_none().then(|| BegunGif::begin(path, size, fps)).transpose()?;
    let all = plan.len();
    shoot(order, &plan, |shooting| {
        if let Some(gif) = gif.take() {
            let mut samples = Vec::new();
            let chosen: Vec<usize> = evenly(all, SAMPLES, SAMPLES).collect();
            shooting.play(&chosen, |_, frame| {
                samples.push(frame);
                Ok(progress.reach(0.0)?)
            })?;
            file = Some(Box::new(gif.with_palette(GifPalette::of(&samples))?));
        }
        let Some(file) = &mut file else { return Ok(()) };
        let every: Vec<usize> = (0..all).collect();
        shooting.play(&every, |index, frame| {
            progress.reach(index as f64 / all as f64)?;
            let added = file.add(&frame);
            // If the interrupt key has cancelled the film, it may also have ended ffmpeg; the failure of ffmpeg is then not reported.
            progress.reach((index + 1) as f64 / all as f64)?;
            added
        })
    })?;
    file.map_or(Ok(()), FilmFile::finish)
}
