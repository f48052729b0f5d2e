//! The content and style of a film.

use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::overlay::Overlay;
use crate::studio::ui::theme::Theme;
use snakes_core::save::LoadedChampion;

/// The content and style of a film.
#[derive(Debug, Clone)]
pub struct FilmOrder {
    /// Its parts, one after the other.
    pub parts: Vec<FilmPart>,
    /// First moment of each part, in simulated seconds.
    pub start_s: f64,
    /// Last moment of each part, in simulated seconds, or `None` for the end.
    pub end_s: Option<f64>,
    /// Simulated seconds per second of the film.
    pub speed: f64,
    /// Frames per second.
    pub fps: u32,
    /// Size in pixels.
    pub size: (u32, u32),
    /// Camera mode: follow, side or top.
    pub camera: CameraMode,
    /// Theme.
    pub theme: Theme,
    /// Overlays.
    pub overlays: Vec<Overlay>,
    /// Whether names, results and the time are written onto the frames.
    pub has_captions: bool,
}

/// A part of a film: champions side by side, from their start.
#[derive(Debug, Clone)]
pub struct FilmPart {
    /// Its title and the smaller line below that, which stand over its beginning.
    pub title: Option<(String, String)>,
    /// The named champions, one per lane.
    pub champions: Vec<(String, LoadedChampion)>,
}
