//! Films of champions, rendered without a window at exact simulated times. No clock influences a frame: the same
//! champions and options give the same frames on every machine, however slowly it draws.
//!
//! [`plan`] determines the time that each frame shows, and [`camera_path`] the camera. [`shooting`] draws the frames.

mod camera_path;
mod error;
mod order;
mod plan;
mod shooting;

use std::collections::BTreeSet;
use std::path::Path;

use crate::studio::stage::evenly;
use snakes_core::check::{Invalid, within};
use snakes_lab::export::film::{
    BegunGif, FilmFile, FrameFolder, GifChoice, GifChoices, GifFile, GifPalette, PAIRS, Video,
    check_video_size, most_estimated,
};
use snakes_lab::export::{ExportFormat, ExportProgress};

pub use error::FilmError;
pub use order::{FilmOrder, FilmPart};

use plan::{FilmFrame, planned};
use shooting::shoot;

/// Maximum number of frames of a film: almost an hour at 30 frames per second.
const MOST_FRAMES: usize = 100_000;

/// Checks that films in this format can have this size, in pixels.
///
/// # Errors
/// The format does not support the size.
pub(crate) fn check_film_size(format: ExportFormat, size: (u32, u32)) -> Result<(), Invalid> {
    if format == ExportFormat::Mp4 { check_video_size(size) } else { Ok(()) }
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
        shooting.play(0..all, |index, frame| {
            progress.reach(index as f64 / all as f64)?;
            let added = file.add(&frame).map_err(FilmError::from);
            // If the interrupt key has cancelled the film, it may also have ended ffmpeg; the failure of ffmpeg is then not reported.
            progress.reach((index + 1) as f64 / all as f64)?;
            added
        })
    })?;
    Ok(file.finish()?)
}

fn checked_plan(order: &FilmOrder) -> Result<Vec<FilmFrame>, FilmError> {
    let plan = planned(order)?;
    within("number of frames", plan.len(), 1..=MOST_FRAMES)?;
    Ok(plan)
}

/// Draws a film and writes it as GIF, in the best size and frame rate for which the file is small enough.
fn gif(order: &FilmOrder, path: &Path, progress: &ExportProgress) -> Result<(), FilmError> {
    let duration_s = checked_plan(order)?.len() as f64 / f64::from(order.fps);
    let ordered = GifChoice { size: order.size, fps: order.fps };
    let allowed = (order.may_be_smaller, order.may_be_slower);
    let mut choices = GifChoices::new(ordered, (duration_s, order.most_bytes), allowed);
    while let Some((chosen, most)) = choices.take() {
        let order = FilmOrder { size: chosen.size, fps: chosen.fps, ..order.clone() };
        match gif_within(most, &order, path, progress) {
            Err(FilmError::TooLarge(bytes)) => choices.learn(chosen, bytes),
            ended => return ended,
        }
    }
    Ok(())
}

/// Draws a film and writes it as GIF of at most `most` bytes.
fn gif_within(
    most: Option<u64>,
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
        let (mut samples, drawn) = (Vec::new(), (chosen.len() + all) as f64);
        shooting.play(chosen.into_iter().filter(|index| *index < all), |index, frame| {
            samples.push((index, frame));
            Ok(progress.reach(samples.len() as f64 / drawn)?)
        })?;
        let palette = GifPalette::of(&samples);
        let expected = palette.expected_bytes(&samples, all);
        if most.is_some_and(|most| expected > most_estimated(most)) {
            return Err(FilmError::TooLarge(expected));
        }
        progress.expect(expected);
        let Some(begun) = begun.take() else { return Ok(()) };
        let file = file.insert(begun.with_palette(palette)?);
        shooting.play(0..all, |index, frame| {
            file.add(&frame)?;
            if most.is_some_and(|most| file.bytes() > most) {
                return Err(FilmError::TooLarge(file.bytes() * all as u64 / (index as u64 + 1)));
            }
            Ok(progress.reach((samples.len() + index + 1) as f64 / drawn)?)
        })
    })?;
    Ok(file.map_or(Ok(()), GifFile::finish)?)
}
