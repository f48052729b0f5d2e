//! `snakes export FILES -o PICTURE.png --at SECONDS`: a picture of one moment, without a window.

use std::path::Path;

use super::args::{ExportArgs, size};
use super::error::{CliError, of_flag};
use super::output::print;
use super::replay::{equals_record, named_champions};
use crate::studio::render::{RenderedScene, render};
use crate::studio::{CameraMode, MAX_LANES, Overlay};
use snakes_core::check::{Invalid, within};
use snakes_core::save::{LoadedChampion, store_picture};
use snakes_lab::plot;

/// The size of a picture unless one is given.
const SIZE: &str = "1920x1080";
/// The largest picture that every common graphics driver can draw.
const LARGEST_PIXELS: u32 = 8192;

/// Draws the picture, and prints the path of its file.
pub fn draw(wanted: &ExportArgs, at: &str, path: &Path) -> Result<(), CliError> {
    within("champions", wanted.files.len(), 1..=MAX_LANES)?;
    let champions = named_champions(&wanted.files)?;
    for (file, (_, loaded)) in wanted.files.iter().zip(&champions) {
        // A champion of another engine is drawn from its recording.
        if loaded.is_of_this_engine() || loaded.recording.is_none() {
            equals_record(file, loaded)?;
        }
    }
    let length_s = |loaded: &LoadedChampion| {
        let trial = &loaded.champion.trial;
        f64::from(trial.steps()) / f64::from(trial.physics.steps_per_s)
    };
    let longest_s = champions.iter().map(|(_, loaded)| length_s(loaded)).fold(0.0, f64::max);
    // No moment stands for the last.
    let at_s = if at == "end" { None } else { Some(moment(at, longest_s)?) };
    let film = &wanted.film;
    let scene = RenderedScene {
        at_s,
        size: size("--size", film.size.as_deref().unwrap_or(SIZE), (64, 64), LARGEST_PIXELS)?,
        camera: CameraMode::named(film.camera.as_deref().unwrap_or("follow"))
            .map_err(of_flag("--camera"))?,
        theme: film.theme()?,
        overlays: film
            .show
            .iter()
            .map(|name| Overlay::named(name))
            .collect::<Result<_, Invalid>>()
            .map_err(of_flag("--show"))?,
        champions,
    };
    let (mut picture, tags) = render(&scene)?;
    plot::tags(&mut picture, &tags)?;
    store_picture(path, &picture)?;
    print(&format!("saved to {}\n", path.display()))
}

fn moment(text: &str, longest_s: f64) -> Result<f64, Invalid> {
    let wrong = |_| Invalid::new("--at", format!("{text:?}"), "a number, or end");
    let at_s: f64 = text.parse().map_err(wrong)?;
    within("--at", at_s, 0.0..=longest_s)?;
    Ok(at_s)
}
