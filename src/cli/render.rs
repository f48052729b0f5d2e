//! `snakes export FILES -o PICTURE.png --at SECONDS`: a picture of one moment, without a window.

use std::path::Path;

use super::args::{ExportArgs, number, size};
use super::error::CliError;
use super::output::print_line;
use super::replay::{champions_to_draw, longest_s};
use crate::studio::MAX_LANES;
use crate::studio::render::{RenderedScene, render};
use snakes_core::check::{Invalid, within};
use snakes_core::save::store_picture;
use snakes_lab::plot;

/// Default size of a picture, in pixels.
const SIZE: &str = "1920x1080";
/// Maximum width and height of a picture that every common graphics driver can draw, in pixels.
const LARGEST_PIXELS: u32 = 8192;

/// Draws the picture, and prints the path of its file.
pub fn draw(wanted: &ExportArgs, at: &str, path: &Path) -> Result<(), CliError> {
    within("champions", wanted.files.len(), 1..=MAX_LANES)?;
    let champions = champions_to_draw(&wanted.files)?;
    // `None` stands for the last moment.
    let at_s = if at == "end" { None } else { Some(moment(at, longest_s(&champions))?) };
    let film = &wanted.film;
    let scene = RenderedScene {
        at_s,
        size: size("--size", film.size.as_deref().unwrap_or(SIZE), (64, 64), LARGEST_PIXELS)?,
        look: film.look()?,
        champions,
    };
    let (mut picture, tags) = render(&scene)?;
    plot::tags(&mut picture, &tags)?;
    store_picture(path, &picture)?;
    print_line(&format!("saved to {}", path.display()))
}

fn moment(text: &str, longest_s: f64) -> Result<f64, Invalid> {
    number("--at", text, 0.0..=longest_s)
        .map_err(|invalid| Invalid { allowed: invalid.allowed + ", or end", ..invalid })
}
