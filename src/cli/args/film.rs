//! The flags of `snakes export` that only films have.

/// The flags of films.
#[derive(Debug, clap::Args)]
pub struct FilmArgs {
    /// Size of a film, in pixels [default: 1280x720; for .gif 640x360]
    #[arg(long, value_name = "WIDTHxHEIGHT", help_heading = FILMS)]
    pub size: Option<String>,
    /// Frames per second of a film [default: 30; for .gif 25]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = FILMS)]
    pub fps: Option<String>,
    /// Camera of a film: follow, side or top [default: follow]
    #[arg(long, value_name = "NAME", help_heading = FILMS)]
    pub camera: Option<String>,
    /// Overlays of a film, separated by commas: contacts, torques, trail, line
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = FILMS)]
    pub show: Vec<String>,
    /// Leave out names, results and the time
    #[arg(long, help_heading = FILMS)]
    pub no_captions: bool,
    /// Simulated seconds per second of a film, from 0.1 to 16 [default: 1]
    #[arg(long, value_name = "X", allow_negative_numbers = true, help_heading = FILMS)]
    pub speed: Option<String>,
    /// First moment of a film, in simulated seconds [default: 0]
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = FILMS)]
    pub start: Option<String>,
    /// Last moment of a film, in simulated seconds [default: the end]
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = FILMS)]
    pub end: Option<String>,
    /// Film the champions of a run's first, middle and last generation in turn; FILES is the run's folder
    #[arg(long, help_heading = FILMS)]
    pub story: bool,
}

/// Heading of these flags in the help.
const FILMS: &str = "Films";

impl FilmArgs {
    /// The first of these flags that is given.
    pub fn given(&self) -> Option<&'static str> {
        let flags = [
            ("--size", self.size.is_some()),
            ("--fps", self.fps.is_some()),
            ("--camera", self.camera.is_some()),
            ("--show", !self.show.is_empty()),
            ("--no-captions", self.no_captions),
            ("--speed", self.speed.is_some()),
            ("--start", self.start.is_some()),
            ("--end", self.end.is_some()),
            ("--story", self.story),
        ];
        flags.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name)
    }
}
