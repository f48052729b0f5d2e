//! The definitions of all flags and subcommands, whose comments are the program's help.

use std::path::PathBuf;

use clap::Parser;
use clap_complete::Shell;

use super::export::ExportArgs;
use super::render::RenderArgs;
use super::robust::PerturbationArgs;
use super::study::StudyArgs;
use snakes_core::save::built_in_stairs_names;
use snakes_core::schema::Choices;
use snakes_core::score::{ExamSuite, Fitness};
use snakes_lab::run::evaluators::EVALUATORS;
use snakes_lab::run::mujoco::{MUJOCO, MUJOCO_SENTENCE};

/// A five-block snake evolves until it climbs a staircase.
///
/// Without arguments a window opens: a champion climbs, and a new run evolves in the background.
#[derive(Debug, Parser)]
#[command(name = "snakes", version, subcommand_precedence_over_arg = true)]
pub struct Args {
    /// Work in the terminal: no window opens, and no display is needed
    #[arg(long, global = true)]
    pub no_render: bool,
    /// Print JSON, one object per line
    #[arg(long, global = true)]
    pub json: bool,
    /// Name of a preset (see `snakes presets`), or path of your own preset file
    #[arg(long, global = true, value_name = "NAME", help_heading = RUN)]
    pub(super) preset: Option<String>,
    /// Seed of the run; the same seed gives the same bits [default: 1; of a study, its own first seed; in the window, the first seed without a run]
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, help_heading = RUN)]
    pub(super) seed: Option<String>,
    /// Snakes per generation
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, help_heading = RUN)]
    pub(super) population: Option<String>,
    /// Number of generations
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, help_heading = RUN)]
    pub(super) generations: Option<String>,
    /// Length of each trial, in simulated seconds
    #[arg(long, global = true, value_name = "S", allow_negative_numbers = true, help_heading = RUN)]
    pub(super) duration: Option<String>,
    #[arg(long, global = true, value_name = "NAME", help_heading = RUN, help = fitness_help())]
    pub(super) fitness: Option<String>,
    #[arg(long, global = true, value_name = "NAME", help_heading = RUN, help = stairs_help())]
    pub(super) stairs: Option<String>,
    /// Change a single setting, such as surface.friction=0.8 (see `snakes settings`); angles are in radians; may be
    /// repeated
    #[arg(long, global = true, value_name = "FIELD=VALUE", help_heading = RUN)]
    pub(super) set: Vec<String>,
    /// Continue the run in this folder, or the only run in this folder of runs, after its last finished generation
    #[arg(
        long,
        global = true,
        value_name = "DIR",
        help_heading = RUN,
        conflicts_with_all = [
            "preset", "seed", "population", "generations", "duration", "fitness", "stairs", "set", "out", "restart", "from",
        ]
    )]
    pub(super) resume: Option<PathBuf>,
    /// Start a run from a saved champion: the first generation descends from it, in its own world unless --preset or
    /// --set say otherwise
    #[arg(long, value_name = "FILE", conflicts_with = "resume", help_heading = RUN)]
    pub(super) from: Option<PathBuf>,
    /// Start over, even if this run has saved generations; without this, an unfinished run continues and a finished
    /// one is shown
    #[arg(long, global = true, help_heading = RUN)]
    pub restart: bool,
    /// Worker threads [default: all cores; with a window, all but one]
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, help_heading = RUN)]
    pub(super) threads: Option<String>,
    // There is nothing to choose while there is only one.
    #[arg(
        long,
        global = true,
        value_name = "NAME",
        help_heading = RUN,
        help = evaluator_help(),
        hide = EVALUATORS.len() == 1
    )]
    pub(super) evaluator: Option<String>,
    /// Compute on the workers of this NATS server, such as nats://192.168.1.5:4222, with the same results as here (start
    /// workers with `snakes worker`)
    #[arg(long, global = true, value_name = "URL", help_heading = MACHINES)]
    pub nats: Option<String>,
    /// File with the credentials for the server: what `nsc` writes (.creds), or the seed of an NKey
    #[arg(long, global = true, value_name = "FILE", help_heading = MACHINES)]
    pub creds: Option<PathBuf>,
    /// File with the certificate of the authority that signed the server's
    #[arg(long, global = true, value_name = "FILE", help_heading = MACHINES)]
    pub tls_ca: Option<PathBuf>,
    /// Begin when this number of workers is there [default: 1; 0 with --local-threads]
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, help_heading = MACHINES)]
    pub(super) expect_workers: Option<String>,
    /// Compute on this number of threads of this computer, too [default: 0]
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, help_heading = MACHINES)]
    pub(super) local_threads: Option<String>,
    /// Folder for the files that this run writes: champions, tables, pictures
    #[arg(long, global = true, value_name = "DIR", help_heading = FILES)]
    pub(super) out: Option<PathBuf>,
    /// Folder of saved champions and runs [default: ./saves if it exists, else the platform's data folder]
    #[arg(long, global = true, value_name = "DIR", conflicts_with = "out", help_heading = FILES)]
    pub(super) saves: Option<PathBuf>,
    /// Open the window with the runs of a study, the .ron file that `snakes study` writes
    #[arg(long, global = true, value_name = "FILE", help_heading = WINDOW)]
    pub comparison: Option<PathBuf>,
    /// Size of the window, in physical pixels
    #[arg(long, global = true, value_name = "WIDTHxHEIGHT", help_heading = WINDOW)]
    pub(super) window_size: Option<String>,
    /// Colour theme: light or dark [default: the last one used; light at first]
    #[arg(long, global = true, value_name = "NAME", help_heading = WINDOW)]
    pub(super) theme: Option<String>,
    /// Present on the full screen: champions in turn, with a large caption; any key but a clicker's returns to the window
    #[arg(long, global = true, help_heading = WINDOW)]
    pub present: bool,
    /// Show problems with the files in the window instead of ending, for starts without a terminal (a double click)
    #[arg(long, global = true, hide_short_help = true, help_heading = WINDOW)]
    pub desktop: bool,
    /// File for window preferences, or "none" [default: a file in the platform's settings folder]
    #[arg(long, global = true, value_name = "FILE", help_heading = WINDOW)]
    pub(super) preferences: Option<PathBuf>,
    /// Write the role, position and label of every widget to this file in every frame, for automated tests
    #[arg(long, global = true, value_name = "FILE", hide_short_help = true, help_heading = WINDOW)]
    pub places: Option<PathBuf>,
    /// Close the window after this number of frames, and print the median, 95th-percentile and maximum frame times
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, help_heading = WINDOW)]
    pub(super) exit_after_frames: Option<String>,
    /// The subcommand; without one, a run evolves.
    #[command(subcommand)]
    pub command: Option<Subcommand>,
}

const RUN: &str = "Run";
const MACHINES: &str = "Other computers";
const FILES: &str = "Files";
const WINDOW: &str = "Window";

/// The subcommands.
#[derive(Debug, clap::Subcommand)]
pub enum Subcommand {
    /// Replay saved champions exactly, several side by side; with --no-render, check them against their records
    Replay {
        /// Saved champions
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// Measure the speed of the simulation on this machine
    Bench {
        /// Saved champion, simulated in its own world [default: newborns of a preset]
        file: Option<PathBuf>,
    },
    /// Check that this machine computes the same bits as the reference machine
    Verify,
    /// Examine champions: varied trials, other step rates, other stairs, a higher step, shoves
    Exam {
        /// Saved champions
        #[arg(required = true)]
        files: Vec<PathBuf>,
        #[arg(long, value_name = "NAME", help = exam_suite_help())]
        suite: Vec<String>,
        /// Write the results into the files
        #[arg(long)]
        write: bool,
    },
    /// Measure how often a champion reaches each step when friction, stairs, density and start vary at random
    Robust {
        /// Saved champion
        file: PathBuf,
        /// Number of trials
        #[arg(long, value_name = "N", default_value_t = 100)]
        trials: u32,
        /// How much they vary.
        #[command(flatten)]
        range: PerturbationArgs,
    },
    /// Print the blocks and joints of a champion's body: sizes, masses, limits, torques
    Body {
        /// Saved champion
        file: PathBuf,
    },
    /// Compare methods over several seeds: built-in studies, or your own as a file; without a name, list them
    Study(StudyArgs),
    /// Draw the champion of each generation of a run, and one torque signal, as PNG files; opens no window
    Figures {
        /// Folder of the run, as `snakes --no-render` prints it
        run: PathBuf,
    },
    /// Draw one moment of saved champions side by side as a PNG file; opens no window
    Render(RenderArgs),
    /// Write saved champions in the formats of other programs
    Export(ExportArgs),
    /// Compute for runs on other computers, through the server that --nats names, until stopped
    Worker,
    /// List the workers and runs on the server that --nats names, and what waits there
    Machines {
        /// Remove what waits for this run
        #[arg(long, value_name = "RUN")]
        purge: Option<String>,
    },
    /// Print completions for a shell: bash, elvish, fish, powershell or zsh
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page of this program, or write the pages of all commands into the folder that --out names
    Man,
    /// List the presets
    Presets,
    /// List every setting with its value, in the form that --set takes
    Settings {
        /// Print Markdown tables with descriptions, as in docs/settings.md
        #[arg(long)]
        markdown: bool,
    },
}

/// Lists every fitness, so that the help follows the code.
fn fitness_help() -> String {
    format!("The fitness that is maximised: {}", Fitness::names().join(", "))
}

/// Lists the built-in stairs.
fn stairs_help() -> String {
    let names = built_in_stairs_names().join(", ");
    format!("The stairs, instead of those of the preset: {names}, or path of a file of stairs")
}

/// Lists every suite of an exam.
pub(super) fn suite_help() -> String {
    let choices = ExamSuite::choices().into_iter();
    let rows: Vec<String> =
        choices.map(|choice| format!("{}: {}", choice.name, choice.sentence)).collect();
    format!("Suite of the exam; may be repeated [default: all]. {}", rows.join(" "))
}

/// Lists every suite of `snakes exam`.
fn exam_suite_help() -> String {
    format!(
        "{} {MUJOCO}: {MUJOCO_SENTENCE}",
        suite_help().replace("[default: all]", "[default: all but engine and mujoco]")
    )
}

/// Lists every evaluator.
fn evaluator_help() -> String {
    let rows: Vec<String> =
        EVALUATORS.iter().map(|row| format!("{}, {}", row.name, row.words)).collect();
    format!("Where genomes are evaluated: {} [default: {}]", rows.join("; "), EVALUATORS[0].name)
}
