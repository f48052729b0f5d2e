//! The content and style of a film.

use crate::studio::state::shares::StageLook;
use snakes_core::save::LoadedChampion;

/// The content and style of a film.
#[derive(Debug, Clone)]
pub struct FilmOrder {
    /// Parts of the film, one after the other.
    pub parts: Vec<FilmPart>,
    /// Simulated time at which each part begins, in seconds.
    pub start_s: f64,
    /// Simulated time at which each part ends, in seconds, or `None` for the end of the rollout.
    pub end_s: Option<f64>,
    /// Playback speed, in simulated seconds per second of the film.
    pub speed: f64,
    /// Frames per second.
    pub fps: u32,
    /// Width and height, in pixels.
    pub size: (u32, u32),
    /// Maximum size of the file of a GIF that may be smaller or slower, in bytes.
    pub most_bytes: u64,
    /// Whether a GIF may have fewer pixels, so that its file is small.
    pub may_be_smaller: bool,
    /// Whether a GIF may have fewer frames per second, so that its file is small.
    pub may_be_slower: bool,
    /// Whether each part ends shortly after the last snake has landed or was furthest, instead of at `end_s`.
    pub ends_with_climb: bool,
    /// Camera mode, theme and overlays.
    pub look: StageLook,
    /// Whether names, results and the time are written onto the frames.
    pub has_captions: bool,
}

/// A part of a film: champions side by side, from their start.
#[derive(Debug, Clone)]
pub struct FilmPart {
    /// Title of the part and the smaller line below the title, shown at the beginning of the part.
    pub title: Option<(String, String)>,
    /// Champions with their names, one per lane.
    pub champions: Vec<(String, LoadedChampion)>,
}
