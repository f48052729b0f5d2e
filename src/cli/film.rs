//! `snakes export` with a film as its output.

use std::path::{Path, PathBuf};

use super::args::{ExportArgs, FilmArgs, number, number_or, size};
use super::error::CliError;
use super::replay::{champions_to_draw, longest_s};
use crate::studio::film::{FilmOrder, FilmPart, check_film_size, film, frame_folder_of};
use snakes_core::check::{Invalid, within};
use snakes_core::save::{LoadedChampion, load_run};
use snakes_lab::export::{ExportFormat, ExportProgress};

/// Maximum width and height of frames that common graphics drivers draw and players show, in pixels.
const LARGEST_PIXELS: u32 = 4096;
/// Minimum width and height of frames, in pixels.
const LEAST_PIXELS: (u32, u32) = (64, 64);
/// Allowed frames per second, except for GIF.
const FPS: std::ops::RangeInclusive<u32> = 1..=120;
/// Allowed speeds, in simulated seconds per second of the film.
const SPEED: std::ops::RangeInclusive<f64> = 0.1..=16.0;

/// A film to be drawn, as the flags describe it.
pub struct OrderedFilm {
    order: FilmOrder,
    format: ExportFormat,
    path: PathBuf,
}

/// Returns the film that the flags describe.
pub fn ordered(
    wanted: &ExportArgs,
    format: ExportFormat,
    path: &Path,
) -> Result<OrderedFilm, CliError> {
    let flags = &wanted.film;
    let is_gif = format == ExportFormat::Gif;
    let default = if is_gif { "640x360" } else { "1280x720" };
    let text = flags.size.as_deref().unwrap_or(default);
    let size = size("--size", text, LEAST_PIXELS, LARGEST_PIXELS)?;
    check_film_size(format, size)?;
    let fps = number_or("--fps", &flags.fps, if is_gif { 25 } else { 30 }, "a number")?;
    within("--fps", fps, if is_gif { crate::studio::film::GIF_FPS } else { FPS })?;
    let speed = number_or("--speed", &flags.speed, 1.0, "a number")?;
    within("--speed", speed, SPEED)?;
    let end_s = flags.end.as_deref().map(|text| number("--end", text, "a number"));
    let order = FilmOrder {
        parts: parts(wanted, format)?,
        start_s: number_or("--start", &flags.start, 0.0, "a number")?,
        end_s: end_s.transpose()?,
        speed,
        fps,
        size,
        camera: flags.camera()?,
        theme: flags.theme()?,
        overlays: flags.overlays()?,
        has_captions: !flags.no_captions,
    };
    check_moments(flags, &order)?;
    Ok(OrderedFilm { order, format, path: path.to_owned() })
}

impl OrderedFilm {
    /// Draws and writes the film. Returns the path of its file or, for single pictures, of their folder.
    pub fn carry_out(&self, progress: &ExportProgress) -> Result<PathBuf, CliError> {
        crate::studio::correct_variables(|_| ());
        film(&self.order, self.format, &self.path, progress)?;
        Ok(match self.format {
            ExportFormat::Png => frame_folder_of(&self.path),
            _ => self.path.clone(),
        })
    }
}

/// Checks that the film begins before it ends, within the longest trial.
fn check_moments(flags: &FilmArgs, order: &FilmOrder) -> Result<(), Invalid> {
    let longest_s = longest_s(order.parts.iter().flat_map(|part| &part.champions));
    within("--start", order.start_s, 0.0..=longest_s)?;
    let Some(end_s) = order.end_s else { return Ok(()) };
    within("--end", end_s, order.start_s..=longest_s)?;
    if end_s > order.start_s {
        return Ok(());
    }
    let given = flags.end.as_deref().unwrap_or_default();
    Err(Invalid::new("--end", given, format!("more than --start, {}", order.start_s)))
}

/// Returns the parts of the film: all champions side by side or, as a story, some generations in turn.
fn parts(wanted: &ExportArgs, format: ExportFormat) -> Result<Vec<FilmPart>, CliError> {
    if wanted.film.story {
        return story(wanted);
    }
    if let Some(run) = wanted.files.iter().find(|file| file.is_dir()) {
        let run = run.display();
        let problem =
            format!("{run} is a folder; add --story to film a run, or name champions in it");
        return Err(CliError::Usage(problem));
    }
    format.check_champions(wanted.files.len())?;
    Ok(vec![FilmPart { title: None, champions: champions_to_draw(&wanted.files)? }])
}

/// Returns the first, the middle and the last generation of a run as parts of a film.
fn story(wanted: &ExportArgs) -> Result<Vec<FilmPart>, CliError> {
    let run = match wanted.files.as_slice() {
        [run] if run.is_dir() => run,
        _ => {
            let problem = "--story takes one run's folder (see snakes export --help)";
            return Err(CliError::Usage(problem.to_owned()));
        }
    };
    let champions = load_run(run)?;
    let last = champions.len() - 1;
    let told = [0, last / 2, last];
    let all = champions.last().map_or(0, |(generation, _)| *generation);
    let champions = champions.into_iter().enumerate();
    let champions = champions.filter(|(index, _)| told.contains(index)).map(|(_, of)| of);
    let part = |(generation, loaded): (u32, LoadedChampion)| {
        let title = format!("Generation {generation} of {all}");
        let below = loaded.champion.reached();
        let champions = vec![(format!("Generation {generation}"), loaded)];
        FilmPart { title: Some((title, below)), champions }
    };
    Ok(champions.map(part).collect())
}
