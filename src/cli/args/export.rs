//! The flags of `snakes export`.

use std::path::PathBuf;

use super::film::FilmArgs;
use snakes_lab::export::ExportFormat;

/// The flags of `snakes export`.
#[derive(Debug, clap::Args)]
pub struct ExportArgs {
    /// Saved champions, or the folder of one run, whose champions of all generations are meant
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    #[arg(short, long, value_name = "FILE", help = output_help(), required_unless_present = "figures")]
    pub output: Option<PathBuf>,
    /// Draw the champion of each generation of a run, and one torque signal, as .png files into the folder --output [default: the
    /// folder figures in the run's]
    #[arg(long, conflicts_with = "until_input_ends")]
    pub figures: bool,
    /// Flags of films.
    #[command(flatten)]
    pub film: FilmArgs,
    /// Cancel at the end of standard input, for programs that start this one
    #[arg(long, hide = true)]
    pub until_input_ends: bool,
    /// Name of the first flag of films that is given; `None` without one.
    #[arg(skip)]
    pub film_flag: Option<String>,
}

/// Returns the help of the flag `--output`, which lists every format.
fn output_help() -> String {
    let rows = ExportFormat::ALL.map(|format| {
        let info = format.info();
        format!(".{}: {}", info.ending, info.sentence)
    });
    format!("The file to write; its ending decides the format. {}", rows.join(" "))
}
