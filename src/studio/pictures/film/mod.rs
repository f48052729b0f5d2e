//! Films of champions, rendered without a window at exact simulated times. No clock influences a frame: the same
//! champions and options give the same frames on every machine, however slowly it draws.
//!
//! [`plan`] determines the time that each frame shows, and [`camera_path`] the camera. [`shooting`] draws the frames,
//! and [`gif_file`], [`video`] and [`frame_folder`] write them. [`gif_size`] keeps a GIF small.

mod camera_path;
mod error;
mod film_file;
mod frame_folder;
mod gif_file;
mod gif_size;
mod order;
mod plan;
mod shooting;
mod video;

use std::collections::BTreeSet;
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
use gif_file::{BegunGif, GifPalette, PAIRS};
use gif_size::{MOST_BYTES, choices, first_small};
use plan::{FilmFrame, planned};
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
    if format == ExportFormat::Gif {
        return gif(order, path, progress);
    }
    let plan = checked_plan(order)?;
    let (size, fps) = (order.size, order.fps);
    // The file is created first, so that a file that cannot be written is reported before the first frame is drawn.
    let mut file: Box<dyn FilmFile> = match format {
        ExportFormat::Mp4 => Box::new(Video::begin(path, size, fps)?),
        _ => Box::new(FrameFolder::begin(path, plan.len())?),
    };
    let all = plan.len();
    shoot(order, &plan, |shooting| {
        shooting.play(&(0..all).collect::<Vec<_>>(), |index, frame| {
            progress.reach(index as f64 / all as f64)?;
            let added = file.add(&frame);
            // If the interrupt key has cancelled the film, it may also have ended ffmpeg; the failure of ffmpeg is then not reported.
            progress.reach((index + 1) as f64 / all as f64)?;
            added
        })
    })?;
    file.finish()
}

fn checked_plan(order: &FilmOrder) -> Result<Vec<FilmFrame>, FilmError> {
    let plan = planned(order)?;
    within("number of frames", plan.len(), 1..=MOST_FRAMES)?;
    Ok(plan)
}

/// Draws a film and writes it as GIF, in the best size and frame rate for which the file is small enough.
fn gif(order: &FilmOrder, path: &Path, progress: &ExportProgress) -> Result<(), FilmError> {
    let frames = checked_plan(order)?.len();
    let mut choices = choices(order);
    let mut bytes_per_pixel = gif_size::USUAL_BYTES_PER_PIXEL;
    while let Some(chosen) = first_small(&mut choices, order.fps, frames, bytes_per_pixel) {
        let (fps, most) = (order.fps, if choices.is_empty() { u64::MAX } else { MOST_BYTES });
        let order = FilmOrder { size: chosen.size, fps: chosen.fps, ..order.clone() };
        match gif_within(most, &order, path, progress) {
            Err(FilmError::TooLarge(bytes)) => {
                bytes_per_pixel = chosen.bytes_per_pixel(fps, frames, bytes);
            }
            ended => return ended,
        }
    }
    Ok(())
}

/// Draws a film and writes it as GIF of at most `most` bytes.
fn gif_within(
    most: u64,
    order: &FilmOrder,
    path: &Path,
    progress: &ExportProgress,
) -> Result<(), FilmError> {
    let plan = checked_plan(order)?;
    let mut begun = Some(BegunGif::begin(path, order.size, order.fps)?);
    let (all, mut file) = (plan.len(), None);
    shoot(order, &plan, |shooting| {
        let firsts = evenly(all.saturating_sub(1).max(1), PAIRS, PAIRS);
        let chosen: BTreeSet<usize> = firsts.flat_map(|first| [first, first + 1]).collect();
        let chosen: Vec<usize> = chosen.into_iter().filter(|index| *index < all).collect();
        let mut samples = Vec::new();
        shooting.play(&chosen, |index, frame| {
            samples.push((index, frame));
            Ok(progress.reach(0.0)?)
        })?;
        let palette = GifPalette::of(&samples);
        let expected = palette.expected_bytes(&samples, all);
        if most < u64::MAX && expected > gif_size::ESTIMATED_BYTES {
            return Err(FilmError::TooLarge(expected));
        }
        progress.expect(expected);
        let Some(begun) = begun.take() else { return Ok(()) };
        let file = file.insert(Box::new(begun.with_palette(palette)?));
        shooting.play(&(0..all).collect::<Vec<_>>(), |index, frame| {
            file.add(&frame)?;
            if file.bytes() > most {
                return Err(FilmError::TooLarge(file.bytes() * all as u64 / (index as u64 + 1)));
            }
            Ok(progress.reach((index + 1) as f64 / all as f64)?)
        })
    })?;
    file.map_or(Ok(()), FilmFile::finish)
}
