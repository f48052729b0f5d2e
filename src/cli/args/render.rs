//! The flags of `snakes render`.

use std::path::PathBuf;

/// The flags of `snakes render`.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// Saved champions; several stand side by side
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// The moment to draw, in simulated seconds [default: the end]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub at: Option<String>,
    /// Size of the picture, in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1920x1080")]
    pub size: String,
    /// Camera: follow, side or top
    #[arg(long, value_name = "NAME", default_value = "follow")]
    pub camera: String,
    /// Overlays, separated by commas: contacts, torques, trail, line
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub show: Vec<String>,
    /// The file to write [default: the first champion's name with .png]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}
