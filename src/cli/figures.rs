//! `snakes figures`: a picture of each generation's champion, and one of a signal.

use std::path::Path;

use indicatif::ProgressBar;

use super::args::Args;
use super::{CliError, print};
use crate::plot;
use crate::save::{LoadedChampion, Picture, load_run, store_picture};
use crate::studio::figures;

/// Size of the pictures, in pixels.
const SIZE: (u32, u32) = (1280, 720);

/// Draws the champions of a run's folder: the report's Figures 5 to 10, and one signal as its Figure 4.
pub fn draw(args: &Args, run: &Path) -> Result<(), CliError> {
    let champions: Vec<_> =
        load_run(run)?.into_iter().map(|LoadedChampion { champion, .. }| champion).collect();
    let folder = args.results_folder();
    folder.prepare()?;
    let mut said = String::from("saved to\n");
    let mut keep = |name: String, picture: &Picture| -> Result<(), CliError> {
        let path = folder.path().join(name);
        store_picture(&path, picture)?;
        said += &format!("  {}\n", path.display());
        Ok(())
    };
    if let Some(last) = champions.last() {
        let title = format!(
            "Bend torque of the first joint, champion of generation {}",
            last.origin.generation
        );
        keep("signal.png".to_owned(), &plot::signal(last, &title)?)?;
    }
    let bar = ProgressBar::new(champions.len() as u64);
    let pictures = figures::draw(&champions, SIZE, |_| bar.inc(1));
    bar.finish_and_clear();
    for (champion, mut picture) in champions.iter().zip(pictures?) {
        let origin = &champion.origin;
        let generation = origin.generation;
        let text = format!(
            "Generation {generation}: {}   ({}, seed {})",
            champion.reached(),
            origin.preset,
            origin.seed
        );
        plot::caption(&mut picture, &text)?;
        keep(format!("generation-{generation}.png"), &picture)?;
    }
    print(&said)
}
