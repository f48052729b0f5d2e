//! `snakes export` with a film as its output.

use std::path::{Path, PathBuf};

use super::args::{ExportArgs, FPS, FilmArgs, GIF_MB, SPEED, number_if, size};
use super::error::CliError;
use super::replay::{champions_to_draw, longest_s};
use crate::studio::film::{FilmOrder, FilmPart, check_film_size, film};
use snakes_core::check::Invalid;
use snakes_core::save::{LoadedChampion, load_run};
use snakes_lab::export::film::{GIF_FPS, MOST_MB, frame_folder_of};
use snakes_lab::export::{ExportFormat, ExportProgress};

/// Maximum width and height of frames that common graphics drivers draw and players show, in pixels.
const LARGEST_PIXELS: u32 = 4096;
/// Minimum width and height of frames, in pixels.
const LEAST_PIXELS: (u32, u32) = (64, 64);

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
    let (fps, default_fps) = if is_gif { (GIF_FPS, 20) } else { (FPS, 30) };
    let fps = number_if("--fps", &flags.fps, fps)?;
    let speed = number_if("--speed", &flags.speed, SPEED)?;
    let most_mb = number_if("--most-mb", &flags.most_mb, GIF_MB)?;
    let is_fixed = flags.size.is_some() && flags.fps.is_some();
    if most_mb.is_some() && (is_fixed || !is_gif) {
        let with = match is_gif {
            true => "both --size and --fps".to_owned(),
            false => format!(".{}", format.info().ending),
        };
        let problem = format!("--most-mb has no effect with {with} (see snakes export --help)");
        return Err(CliError::Usage(problem));
    }
    let parts = parts(wanted, format)?;
    let [start_s, end_s] =
        moments(flags, longest_s(parts.iter().flat_map(|part| &part.champions)))?;
    let order = FilmOrder {
        parts,
        start_s: start_s.unwrap_or(0.0),
        end_s,
        speed: speed.unwrap_or(1.0),
        fps: fps.unwrap_or(default_fps),
        size,
        most_bytes: (most_mb.unwrap_or(MOST_MB) * 1.0e6) as u64,
        may_be_smaller: is_gif && flags.size.is_none(),
        may_be_slower: is_gif && flags.fps.is_none(),
        ends_with_climb: is_gif && flags.end.is_none(),
        look: flags.look()?,
        has_captions: !flags.no_captions,
    };
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

/// Returns the first and the last moment of a film, if they are given: the film begins before it ends, within the longest trial.
fn moments(flags: &FilmArgs, longest_s: f64) -> Result<[Option<f64>; 2], Invalid> {
    let start_s = number_if("--start", &flags.start, 0.0..=longest_s)?;
    let from_s = start_s.unwrap_or(0.0);
    let end_s = |text: &String| {
        let end_s = text.parse::<f64>().ok().filter(|end_s| *end_s > from_s && *end_s <= longest_s);
        let allowed = || format!("more than {from_s}, at which the film starts, up to {longest_s}");
        end_s.ok_or_else(|| Invalid::new("--end", format!("{text:?}"), allowed()))
    };
    Ok([start_s, flags.end.as_ref().map(end_s).transpose()?])
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::{Parsed, Task, parse};

    /// Returns the film that flags describe, or the error.
    fn film(ending: &str, flags: &str) -> Result<FilmOrder, String> {
        let climber = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/climber.ron");
        let words = format!("snakes export {climber} -o a.{ending} {flags}");
        let Ok(Parsed::Run(_, task)) = parse(words.split_whitespace().map(Into::into)) else {
            return Err(format!("{words} is no command"));
        };
        let Task::Export(wanted) = *task else { return Err(format!("{words} is no export")) };
        let path = Path::new("a").with_extension(ending);
        let format = ExportFormat::of_path("--output", &path).map_err(|error| error.to_string())?;
        ordered(&wanted, format, &path).map(|film| film.order).map_err(|error| error.to_string())
    }

    #[test]
    fn f14_the_errors_and_the_help_of_a_flag_name_the_numbers_that_it_takes() {
        for (flag, ending) in [
            ("--fps", "mp4"),
            ("--fps", "gif"),
            ("--speed", "mp4"),
            ("--start", "mp4"),
            ("--end", "mp4"),
        ] {
            let refusal =
                |value: &str| film(ending, &format!("{flag} {value}")).expect_err("refused");
            let told = refusal("many");
            let (_, range) = told.split_once("allowed: ").expect("what is allowed");
            let range = range.trim_start_matches("a whole number from ");
            let (least, most) = range.split_once(" to ").expect("a range");
            assert!(film(ending, &format!("{flag} {most}")).is_ok(), "{flag} {most}");
            // A film that ends where it begins has no moment.
            assert_eq!(
                film(ending, &format!("{flag} {least}")).is_ok(),
                flag != "--end",
                "{flag} {least}"
            );
            for beyond in [format!("-{most}"), format!("{most}0")] {
                assert!(refusal(&beyond).ends_with(range), "{}", refusal(&beyond));
            }
            if flag == "--fps" {
                assert!(
                    ["0.5", "1e1"].iter().all(|text| refusal(text) == told.replace("many", text))
                );
            }
        }
        let Ok(Parsed::Print(help)) = parse(["snakes", "export", "--help"].map(Into::into)) else {
            unreachable!("there is help")
        };
        let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
        let (least, most) = FPS.into_inner();
        let of_gif = GIF_FPS.into_inner().1;
        assert!(help.contains(&format!("{least} to {most}, for .gif up to {of_gif}")), "{help}");
        let (least, most) = SPEED.into_inner();
        assert!(help.contains(&format!("{least} to {most} [default: 1]")), "{help}");
    }
}
