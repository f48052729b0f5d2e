//! `snakes export RUN --figures`: a picture of each generation's champion, and a plot of a torque signal.

use std::path::Path;

use super::error::CliError;
use super::output::print_line;
use crate::studio::figures;
use snakes_core::evolve::Champion;
use snakes_core::save::{
    LoadedChampion, Picture, SavesFolder, load_run, store_picture, within_run,
};
use snakes_lab::plot;
use snakes_lab::run::progress_bar::{bar_of, beneath_bar};

/// Width and height of the pictures, in pixels.
const SIZE: (u32, u32) = (1280, 720);

/// Draws the champions in a run's folder (the report's Figures 5 to 10) and one torque signal (its Figure 4). The files are written
/// to the folder `named`, or else to the run's folder `figures`.
pub fn draw(run: &Path, named: Option<&Path>) -> Result<(), CliError> {
    let (numbers, champions): (Vec<u32>, Vec<LoadedChampion>) = load_run(run)?.into_iter().unzip();
    let folder = match named {
        Some(named) => named.to_owned(),
        None => within_run(run, "figures")?,
    };
    SavesFolder::find(Some(&folder)).prepare()?;
    let mut saved = Vec::new();
    let mut keep = |name: String, picture: &Picture| -> Result<(), CliError> {
        let path = if named.is_some() { folder.join(name) } else { within_run(&folder, &name)? };
        store_picture(&path, picture)?;
        saved.push(path);
        Ok(())
    };
    if let (Some(last), Some(number)) = (champions.last(), numbers.last()) {
        let title = format!("Bend torque of the first joint, champion of generation {number}");
        keep("signal.png".to_owned(), &plot::signal(&last.champion, &title)?)?;
    }
    let bar = bar_of(champions.len() as u64, "pictures");
    let pictures = beneath_bar(&bar, || figures::draw(&champions, SIZE, |_| bar.inc(1)));
    for ((number, loaded), (mut picture, evaluation)) in
        numbers.iter().zip(&champions).zip(pictures?)
    {
        let champion = &loaded.champion;
        let origin = &champion.origin;
        let note = match (loaded.is_of_this_engine(), &loaded.recording) {
            (false, Some(_)) => format!("   as recorded by engine {}", loaded.engine),
            _ if evaluation.agrees_with(&champion.evaluation) => String::new(),
            _ => "   REPLAY DIFFERS FROM THE RECORD".to_owned(),
        };
        let shown = Champion { evaluation, ..champion.clone() };
        let text = format!(
            "Generation {number}: {}   ({}, seed {}){note}",
            shown.reached(),
            origin.preset,
            origin.seed
        );
        plot::caption(&mut picture, &text)?;
        keep(format!("generation-{number}.png"), &picture)?;
    }
    print_line("saved to")?;
    saved.iter().try_for_each(|path| print_line(&format!("  {}", path.display())))
}
