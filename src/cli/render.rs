//! `snakes render`: a picture of a moment, without a window.

use std::path::PathBuf;

/// What `snakes render` is told.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// The saved champions; several stand side by side
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// The moment, in simulated seconds [default: the end]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    at: Option<String>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1920x1080")]
    size: String,
    /// From where: follow, side or top
    #[arg(long, value_name = "NAME", default_value = "follow")]
    camera: String,
    /// What to draw over it: contacts, torques, trail, line; separated by commas
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    show: Vec<String>,
    /// The file to write [default: the first champion's name with .png]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[cfg(feature = "studio")]
mod draw {
    use std::path::PathBuf;

    use super::RenderArgs;
    use crate::check::{Invalid, within};
    use crate::cli::args::{Args, size};
    use crate::cli::{CliError, named_champions, print};
    use crate::plot;
    use crate::save::{LoadedChampion, store_picture};
    use crate::studio::render::{Scene, render};
    use crate::studio::{MOST_LANES, Overlay, Shot};

    /// Larger pictures are more than some graphics drivers can draw.
    const LARGEST_PIXELS: u32 = 8192;

    /// Draws what was asked for, and says where it is.
    pub fn draw(args: &Args, what: &RenderArgs) -> Result<(), CliError> {
        within("champions", what.files.len(), 1..=MOST_LANES)?;
        let champions = named_champions(&what.files)?;
        let length_s = |loaded: &LoadedChampion| {
            let trial = &loaded.champion.trial;
            f64::from(trial.steps()) / f64::from(trial.physics.steps_per_s)
        };
        let longest_s = champions.iter().map(|(_, loaded)| length_s(loaded)).fold(0.0, f64::max);
        let at_s = what.at.as_deref().map(|text| moment(text, longest_s)).transpose()?;
        let scene = Scene {
            at_s,
            size: size("size", &what.size, (64, 64), LARGEST_PIXELS)?,
            camera: Shot::named(&what.camera)?,
            theme: args.theme()?.unwrap_or_default(),
            overlays: what
                .show
                .iter()
                .map(|name| Overlay::named(name))
                .collect::<Result<_, Invalid>>()?,
            champions,
        };
        let named_after_first = || PathBuf::from(format!("{}.png", scene.champions[0].0));
        let path = what.output.clone().unwrap_or_else(named_after_first);
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            let allowed = "a name that ends in .png";
            return Err(Invalid::new(
                "output",
                format!("{:?}", path.display().to_string()),
                allowed,
            )
            .into());
        }
        let (mut picture, tags) = render(&scene)?;
        let tags: Vec<(&str, (f32, f32))> =
            tags.iter().map(|tag| (tag.text.as_str(), tag.at)).collect();
        plot::tags(&mut picture, &tags)?;
        store_picture(&path, &picture)?;
        print(&format!("saved to {}\n", path.display()))
    }

    fn moment(text: &str, longest_s: f64) -> Result<f64, Invalid> {
        let wrong = |_| Invalid::new("at", format!("{text:?}"), "a number");
        let at_s: f64 = text.parse().map_err(wrong)?;
        within("at", at_s, 0.0..=longest_s)?;
        Ok(at_s)
    }
}

#[cfg(feature = "studio")]
pub use draw::draw;
