//! Groups of flags that several commands share.

use std::path::PathBuf;

use clap::Args as Group;

use snakes_core::save::built_in_stairs_names;
use snakes_core::schema::Choices;
use snakes_core::score::Fitness;
use snakes_lab::run::evaluators::EVALUATORS;

/// Flag for the form of the output.
#[derive(Debug, Default, Group)]
pub struct OutputFlags {
    /// Print JSON, one object per line
    #[arg(long)]
    pub json: bool,
}

/// Flags of a preset and of changes to its settings.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = RUN)]
pub struct SettingFlags {
    /// Name of a preset (see `snakes show presets`), or path of your own preset file
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
    /// Snakes per generation
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub population: Option<String>,
    /// Number of generations
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub generations: Option<String>,
    /// Length of each trial, in simulated seconds
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub duration: Option<String>,
    #[arg(long, value_name = "NAME", help = fitness_help())]
    pub fitness: Option<String>,
    #[arg(long, value_name = "NAME", help = stairs_help())]
    pub stairs: Option<String>,
    /// Change a single setting, such as surface.friction=0.8 (see `snakes show settings`); angles are in radians; may be
    /// repeated
    #[arg(long, value_name = "FIELD=VALUE")]
    pub set: Vec<String>,
}

/// Flag of a seed.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = RUN)]
pub struct SeedFlag {
    /// Seed of the first run; the same seed gives the same bits [default: 1; of a study its own; in the window the first without a
    /// run]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<String>,
}

/// Flag of a folder for results.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = FILES)]
pub struct OutFlag {
    /// Folder for the files that are written: champions, tables, pictures
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Flags of a run: new, continued, or from a champion.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = RUN)]
pub struct RunFlags {
    /// Flags of the run's settings.
    #[command(flatten)]
    pub settings: SettingFlags,
    /// Flag of the run's seed.
    #[command(flatten)]
    pub seed: SeedFlag,
    /// Continue the run in this folder, or the only run in this folder of runs, after its last finished generation
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = [
            "preset", "seed", "population", "generations", "duration", "fitness", "stairs", "set", "out", "restart", "from",
        ]
    )]
    pub resume: Option<PathBuf>,
    /// Start a run from a saved champion: the first generation descends from it, in its own world unless --preset or
    /// --set say otherwise
    #[arg(long, value_name = "FILE", conflicts_with = "resume")]
    pub from: Option<PathBuf>,
    /// Start over, even if this run has saved generations; without this, an unfinished run continues and a finished
    /// one is shown
    #[arg(long)]
    pub restart: bool,
    /// Flag of the run's folder.
    #[command(flatten)]
    pub out: OutFlag,
    /// Folder of saved champions and runs [default: ./saves if it exists, else the platform's data folder]
    #[arg(long, value_name = "DIR", conflicts_with = "out", help_heading = FILES)]
    pub saves: Option<PathBuf>,
}

/// Flags of threads of this computer.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = RUN)]
pub struct ThreadFlags {
    /// Worker threads [default: all cores; with a window, all but one]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub threads: Option<String>,
    // The flag is hidden from the help while there is only one evaluator to choose.
    #[arg(long, value_name = "NAME", help = evaluator_help(), hide = EVALUATORS.len() == 1)]
    pub evaluator: Option<String>,
}

/// Flags of workers: threads of this computer, or workers on other computers.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = MACHINES)]
pub struct WorkerFlags {
    /// Flags of the threads.
    #[command(flatten)]
    pub threads: ThreadFlags,
    /// Compute on the workers of this NATS server, such as nats://192.168.1.5:4222, with the same results as here (start
    /// workers with `snakes worker`)
    #[arg(long, value_name = "URL", conflicts_with_all = ["threads", "evaluator"])]
    pub nats: Option<String>,
    /// Flags of the credentials for the NATS server.
    #[command(flatten)]
    pub credentials: CredentialFlags,
    /// Begin when this number of workers is there [default: 1; 0 with --local-threads]
    #[arg(long, value_name = "N", allow_negative_numbers = true, requires = "nats")]
    pub expect_workers: Option<String>,
    /// Compute on this number of threads of this computer, too [default: 0]
    #[arg(long, value_name = "N", allow_negative_numbers = true, requires = "nats")]
    pub local_threads: Option<String>,
}

/// Flags of a NATS server.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = MACHINES)]
pub struct ServerFlags {
    /// Address of the NATS server, such as nats://192.168.1.5:4222
    #[arg(long, value_name = "URL", required = true)]
    pub nats: Option<String>,
    /// Flags of the credentials for the NATS server.
    #[command(flatten)]
    pub credentials: CredentialFlags,
}

/// Flags of credentials that a server may demand.
#[derive(Debug, Clone, Default, Group)]
#[command(next_help_heading = MACHINES)]
pub struct CredentialFlags {
    /// File with the credentials for the server: what `nsc` writes (.creds), or the seed of an NKey
    #[arg(long, value_name = "FILE", requires = "nats")]
    pub creds: Option<PathBuf>,
    /// File with the certificate of the authority that signed the server's
    #[arg(long, value_name = "FILE", requires = "nats")]
    pub tls_ca: Option<PathBuf>,
}

/// Flags of the window.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = WINDOW)]
pub struct WindowFlags {
    /// Open the window with the runs of a study, the .ron file that `snakes study` writes
    #[arg(long, value_name = "FILE")]
    pub comparison: Option<PathBuf>,
    /// Size of the window, in physical pixels
    #[arg(long, value_name = "WIDTHxHEIGHT")]
    pub window_size: Option<String>,
    /// Colour theme: light or dark [default: the last one used; light at first]
    #[arg(long, value_name = "NAME")]
    pub theme: Option<String>,
    /// Present on the full screen: champions in turn, with a large caption; any key but a clicker's returns to the window
    #[arg(long)]
    pub present: bool,
    /// Show problems with the files in the window instead of ending, for starts without a terminal (a double click)
    #[arg(long, hide_short_help = true)]
    pub desktop: bool,
    /// File for window preferences, or "none" [default: a file in the platform's settings folder]
    #[arg(long, value_name = "FILE")]
    pub preferences: Option<PathBuf>,
    /// Write the role, position and label of every widget to this file in every frame, for automated tests
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub places: Option<PathBuf>,
    /// Close the window after this number of frames, and print the median, 95th-percentile and maximum frame times
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub exit_after_frames: Option<String>,
}

const RUN: &str = "Run";
const MACHINES: &str = "Other computers";
const FILES: &str = "Files";
const WINDOW: &str = "Window";

/// Returns the help of `--fitness`, which lists every kind of fitness.
fn fitness_help() -> String {
    format!("The fitness that is maximised: {}", Fitness::names().join(", "))
}

/// Returns the help of `--stairs`, which lists the built-in stairs.
fn stairs_help() -> String {
    let names = built_in_stairs_names().join(", ");
    format!("The stairs, instead of those of the preset: {names}, or path of a file of stairs")
}

/// Returns the help of `--evaluator`, which lists every evaluator.
fn evaluator_help() -> String {
    let rows: Vec<String> =
        EVALUATORS.iter().map(|row| format!("{}, {}", row.name, row.words)).collect();
    format!("Where genomes are evaluated: {} [default: {}]", rows.join("; "), EVALUATORS[0].name)
}
