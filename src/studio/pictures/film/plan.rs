//! Plans the frames of a film: the simulated time, the camera and the title of each.

use bevy::prelude::*;

use super::camera_path::camera_path;
use super::error::FilmError;
use super::order::{FilmOrder, FilmPart};
use crate::studio::error::StudioError;
use crate::studio::pictures::render;
use crate::studio::stage::end_s;
use crate::studio::stage::lane::Lane;
use snakes_core::check::within;
use snakes_lab::plot::FilmTitle;

/// Time for which a part with a title stands still at its beginning and at its end, in seconds of the film.
const HOLD_S: f64 = 1.2;
/// Time for which a film that shows only the climb goes on after it, in simulated seconds.
const AFTER_CLIMB_S: f64 = 1.5;
/// Time for which a title is shown, in seconds of the film.
const TITLE_S: f64 = 2.8;
/// Time in which a title fades out at the end of its display, in seconds of the film.
const FADE_S: f64 = 0.5;

/// A planned frame of a film.
#[derive(Debug, Clone)]
pub struct FilmFrame {
    /// Index of the frame's part of the film.
    pub part: usize,
    /// Time that the frame shows, in simulated seconds.
    pub time_s: f64,
    /// Transform of the camera.
    pub camera: Transform,
    /// Title over the frame, if any.
    pub title: Option<FilmTitle>,
}

/// Simulates all parts once, and plans all frames in their order.
///
/// # Errors
/// A champion cannot be simulated, or the start of the film is after its end.
pub fn planned(order: &FilmOrder) -> Result<Vec<FilmFrame>, FilmError> {
    let mut frames = Vec::new();
    for (index, part) in order.parts.iter().enumerate() {
        frames.extend(frames_of(order, index, part)?);
    }
    Ok(frames)
}

fn frames_of(
    order: &FilmOrder,
    index: usize,
    part: &FilmPart,
) -> Result<Vec<FilmFrame>, FilmError> {
    let mut lanes = lanes_of(part)?;
    let ends_s = end_s(&lanes);
    within("--start", order.start_s, 0.0..=ends_s)?;
    let climbed_s = lanes.iter().map(Lane::climbed_s).fold(0.0, f64::max) + AFTER_CLIMB_S;
    let wanted_s = if order.ends_with_climb { Some(climbed_s) } else { order.end_s };
    let until_s = wanted_s.filter(|end_s| *end_s > order.start_s).unwrap_or(ends_s).min(ends_s);
    let fps = f64::from(order.fps);
    let count = libm::round((until_s - order.start_s) * fps / order.speed).max(1.0) as usize;
    let held = if part.title.is_some() { libm::round(HOLD_S * fps) as usize } else { 0 };
    let times_s = (0..held + count + held).map(|frame| {
        let played = frame.saturating_sub(held).min(count);
        let time_s = order.start_s + played as f64 * order.speed / fps;
        // While a part stands still at its end, it shows exactly its last time.
        if played == count { until_s } else { time_s }
    });
    let times_s: Vec<f64> = times_s.collect();
    let points = times_s.iter().map(|time_s| {
        lanes.iter_mut().for_each(|lane| lane.skip_to(*time_s));
        render::in_view(&lanes)
    });
    let points: Vec<Vec<Vec3>> = points.collect();
    let aspect = order.size.0 as f32 / order.size.1.max(1) as f32;
    let cameras = camera_path(&points, order.look.camera, lanes.len(), (aspect, order.fps));
    let frames = times_s.into_iter().zip(cameras).enumerate();
    let planned = frames.map(|(frame, (time_s, camera))| {
        let shown_s = frame as f64 / fps;
        let opacity = ((TITLE_S - shown_s) / FADE_S).clamp(0.0, 1.0);
        let title = part.title.as_ref().filter(|_| opacity > 0.0);
        let title = title.map(|(text, below)| FilmTitle {
            text: text.clone(),
            below: below.clone(),
            opacity,
        });
        FilmFrame { part: index, time_s, camera, title }
    });
    Ok(planned.collect())
}

/// Builds the lanes of a part at their start, with finished lookaheads.
pub fn lanes_of(part: &FilmPart) -> Result<Vec<Lane>, StudioError> {
    let mut lanes = render::lanes_of(&part.champions)?;
    lanes.iter_mut().for_each(Lane::finish_lookahead);
    Ok(lanes)
}
