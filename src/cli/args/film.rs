//! The flags of `snakes export` that only pictures and films have.

use std::ops::RangeInclusive;

use snakes_lab::export::film::MOST_MB;

#[cfg(feature = "studio")]
use crate::cli::error::{CliError, of_flag};
#[cfg(feature = "studio")]
use crate::studio::{CameraMode, Overlay, StageLook};

/// The flags of pictures and films.
#[derive(Debug, Default, clap::Args)]
pub struct FilmArgs {
    /// Size, in pixels [default: 1280x720; for .gif up to 640x360 (see --most-mb); with --at 1920x1080]
    #[arg(long, value_name = "WIDTHxHEIGHT", help_heading = FILMS)]
    pub size: Option<String>,
    #[arg(long, value_name = "MB", allow_negative_numbers = true, help_heading = FILMS, help = most_mb_help())]
    pub most_mb: Option<String>,
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = FILMS, help = fps_help())]
    pub fps: Option<String>,
    /// Camera: follow, side or top [default: follow]
    #[arg(long, value_name = "NAME", help_heading = FILMS)]
    pub camera: Option<String>,
    /// Overlays, separated by commas: contacts, torques, trail, line
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = FILMS)]
    pub show: Vec<String>,
    /// Leave out names, results and the time
    #[arg(long, help_heading = FILMS)]
    pub no_captions: bool,
    #[arg(long, value_name = "X", allow_negative_numbers = true, help_heading = FILMS, help = speed_help())]
    pub speed: Option<String>,
    /// First moment of a film, in simulated seconds [default: 0]
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = FILMS)]
    pub start: Option<String>,
    /// Last moment of a film, in simulated seconds [default: the end; for .gif shortly after the landing or the furthest point]
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = FILMS)]
    pub end: Option<String>,
    /// Colour theme: light or dark [default: light]
    #[arg(long, value_name = "NAME", help_heading = FILMS)]
    pub theme: Option<String>,
    /// Draw this one moment as a .png file, all champions side by side, in simulated seconds; "end" is the last
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = FILMS, conflicts_with_all = ["fps", "no_captions", "speed", "start", "end", "story", "most_mb"])]
    pub at: Option<String>,
    /// Film the champions of a run's first, middle and last generation in turn; FILES is the run's folder
    #[arg(long, help_heading = FILMS)]
    pub story: bool,
}

/// Heading of the flags of pictures and films in the help.
const FILMS: &str = "Pictures and films";
/// Allowed frames per second, except for GIF.
pub const FPS: RangeInclusive<u32> = 1..=120;
/// Allowed maximum sizes of a GIF, in MB.
pub const GIF_MB: RangeInclusive<f64> = 0.5..=100.0;
/// Allowed speeds, in simulated seconds per second of the film.
pub const SPEED: RangeInclusive<f64> = 0.1..=16.0;

/// Returns the help of `--fps`.
fn fps_help() -> String {
    let (least, most) = FPS.into_inner();
    format!(
        "Frames per second of a film, {least} to {most}, for .gif up to 50 [default: 30; for .gif up to 20 (see --most-mb)]"
    )
}

/// Returns the help of `--most-mb`.
fn most_mb_help() -> String {
    let (least, most) = GIF_MB.into_inner();
    format!(
        "Maximum size of a .gif, in MB, {least} to {most} [default: {MOST_MB}]; one of the smallest pictures may have more"
    )
}

/// Returns the help of `--speed`.
fn speed_help() -> String {
    let (least, most) = SPEED.into_inner();
    format!("Simulated seconds per second of a film, {least} to {most} [default: 1]")
}

impl FilmArgs {
    /// Returns the look. By default the camera follows the snake, the theme is the light one, and there are no overlays.
    #[cfg(feature = "studio")]
    pub fn look(&self) -> Result<StageLook, CliError> {
        let camera = CameraMode::named(self.camera.as_deref().unwrap_or("follow"));
        let theme = self.theme.as_deref().map(str::parse).transpose();
        let overlays = self.show.iter().map(|name| Overlay::named(name));
        Ok(StageLook {
            camera: camera.map_err(of_flag("--camera"))?,
            theme: theme.map_err(of_flag("--theme"))?.unwrap_or_default(),
            overlays: overlays.collect::<Result<_, _>>().map_err(of_flag("--show"))?,
        })
    }
}
