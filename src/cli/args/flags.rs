//! The definitions of all commands and their flags, whose comments are the program's help.
//!
//! Flags that several commands have are groups. A command flattens the groups that have an effect in it, so it refuses all others
//! by itself, and its help shows its own flags only.

use std::path::PathBuf;

use clap::{Args as Group, Parser, Subcommand};
use clap_complete::Shell;

use super::export::ExportArgs;
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
#[command(name = "snakes", version, args_conflicts_with_subcommands = true)]
pub struct CommandLine {
    /// Work in the terminal, as `snakes run` does: no window opens, and no display is needed
    #[arg(long)]
    pub no_render: bool,
    /// What is run.
    #[command(flatten)]
    pub run: RunFlags,
    /// Where it is evaluated.
    #[command(flatten)]
    pub workers: WorkerFlags,
    /// Its output.
    #[command(flatten)]
    pub output: OutputFlags,
    /// The window.
    #[command(flatten)]
    pub window: WindowFlags,
    /// The command; without one, a run evolves.
    #[command(subcommand)]
    pub command: Option<CliCommand>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum CliCommand {
    /// Evolve in the terminal: a line for each generation, and the champion as a file
    Run {
        /// What is run.
        #[command(flatten)]
        run: RunFlags,
        /// Where it is evaluated.
        #[command(flatten)]
        workers: WorkerFlags,
        /// Its output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Replay saved champions exactly, several side by side; with --no-render, check them against their records
    Replay {
        /// Saved champions
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Check in the terminal: no window opens, and no display is needed
        #[arg(long)]
        no_render: bool,
        /// What is run behind the champions.
        #[command(flatten)]
        run: RunFlags,
        /// Where that is evaluated.
        #[command(flatten)]
        workers: WorkerFlags,
        /// The output of the check.
        #[command(flatten)]
        output: OutputFlags,
        /// The window.
        #[command(flatten)]
        window: WindowFlags,
    },
    /// Examine champions: varied trials, other step rates, other stairs, a higher step, shoves, or trials that vary as you say
    Exam {
        /// Saved champions
        #[arg(required = true)]
        files: Vec<PathBuf>,
        #[arg(long, value_name = "NAME", help = exam_suite_help())]
        suite: Vec<String>,
        /// Write the results into the files
        #[arg(long)]
        write: bool,
        /// Trials that vary as the user says.
        #[command(flatten)]
        perturbed: PerturbationArgs,
        /// Where they are simulated.
        #[command(flatten)]
        workers: WorkerFlags,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Compare methods over several seeds: built-in studies, or your own as a file; without a name, list them
    Study {
        /// The study.
        #[command(flatten)]
        study: StudyArgs,
        /// Changed settings.
        #[command(flatten)]
        settings: SettingFlags,
        /// The first seed.
        #[command(flatten)]
        seed: SeedFlag,
        /// Make the runs of the selected arms again
        #[arg(long)]
        restart: bool,
        /// Where runs are evaluated.
        #[command(flatten)]
        workers: WorkerFlags,
        /// The folder of the results.
        #[command(flatten)]
        out: OutFlag,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Write saved champions as pictures, films, pages, tables, scenes and models, or a run as figures
    Export {
        /// What is exported.
        #[command(flatten)]
        export: ExportArgs,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// List the presets, every setting, or the blocks of a body
    Show {
        /// What is shown.
        #[command(subcommand)]
        what: ShownList,
    },
    /// Check that this machine computes the same bits as the reference machine
    Verify {
        /// Threads.
        #[command(flatten)]
        threads: ThreadFlags,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Measure the speed of the simulation on this machine
    Bench {
        /// Saved champion, simulated in its own world [default: newborns of a preset]
        #[arg(conflicts_with_all = ["preset", "population", "generations", "duration", "fitness", "stairs", "set"])]
        file: Option<PathBuf>,
        /// The world of newborns.
        #[command(flatten)]
        settings: SettingFlags,
        /// Threads.
        #[command(flatten)]
        threads: ThreadFlags,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Compute for runs on other computers, until stopped
    Worker {
        /// Number of threads that compute [default: all cores]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        threads: Option<String>,
        /// The server.
        #[command(flatten)]
        server: ServerFlags,
    },
    /// List the workers and runs on a server, and what waits there
    Machines {
        /// Remove what waits for this run
        #[arg(long, value_name = "RUN")]
        purge: Option<String>,
        /// The server.
        #[command(flatten)]
        server: ServerFlags,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Print completions for a shell: bash, elvish, fish, powershell or zsh
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page of this program, or write the pages of all commands
    Man {
        /// Folder for the manual pages of all commands [default: none, and the program's page is printed]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// What `snakes show` shows.
#[derive(Debug, Subcommand)]
pub enum ShownList {
    /// The built-in presets
    Presets {
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Every setting with its value, in the form that --set takes
    Settings {
        /// Print Markdown tables with descriptions, as in docs/settings.md
        #[arg(long, conflicts_with = "json")]
        markdown: bool,
        /// Changed settings.
        #[command(flatten)]
        settings: SettingFlags,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// The blocks and joints of a champion's body: sizes, masses, limits, torques
    Body {
        /// Saved champion
        file: PathBuf,
        /// The output.
        #[command(flatten)]
        output: OutputFlags,
    },
}

/// The form of what is printed.
#[derive(Debug, Default, Group)]
pub struct OutputFlags {
    /// Print JSON, one object per line
    #[arg(long)]
    pub json: bool,
}

/// A preset, with changes.
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

/// A seed.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = RUN)]
pub struct SeedFlag {
    /// Seed of the first run; the same seed gives the same bits [default: 1; of a study its own; in the window the first without a
    /// run]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<String>,
}

/// A folder for results.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = FILES)]
pub struct OutFlag {
    /// Folder for the files that are written: champions, tables, pictures
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// A run: new, continued, or from a champion.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = RUN)]
pub struct RunFlags {
    /// Its settings.
    #[command(flatten)]
    pub settings: SettingFlags,
    /// Its seed.
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
    /// Its folder.
    #[command(flatten)]
    pub out: OutFlag,
    /// Folder of saved champions and runs [default: ./saves if it exists, else the platform's data folder]
    #[arg(long, value_name = "DIR", conflicts_with = "out", help_heading = FILES)]
    pub saves: Option<PathBuf>,
}

/// Threads of this computer.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = RUN)]
pub struct ThreadFlags {
    /// Worker threads [default: all cores; with a window, all but one]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub threads: Option<String>,
    // There is nothing to choose while there is only one.
    #[arg(long, value_name = "NAME", help = evaluator_help(), hide = EVALUATORS.len() == 1)]
    pub evaluator: Option<String>,
}

/// Threads of this computer, or workers on others.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = MACHINES)]
pub struct WorkerFlags {
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadFlags,
    /// Compute on the workers of this NATS server, such as nats://192.168.1.5:4222, with the same results as here (start
    /// workers with `snakes worker`)
    #[arg(long, value_name = "URL", conflicts_with_all = ["threads", "evaluator"])]
    pub nats: Option<String>,
    /// How to connect to it.
    #[command(flatten)]
    pub credentials: CredentialFlags,
    /// Begin when this number of workers is there [default: 1; 0 with --local-threads]
    #[arg(long, value_name = "N", allow_negative_numbers = true, requires = "nats")]
    pub expect_workers: Option<String>,
    /// Compute on this number of threads of this computer, too [default: 0]
    #[arg(long, value_name = "N", allow_negative_numbers = true, requires = "nats")]
    pub local_threads: Option<String>,
}

/// A server.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = MACHINES)]
pub struct ServerFlags {
    /// Address of the NATS server, such as nats://192.168.1.5:4222
    #[arg(long, value_name = "URL", required = true)]
    pub nats: Option<String>,
    /// How to connect to it.
    #[command(flatten)]
    pub credentials: CredentialFlags,
}

/// What a server asks for.
#[derive(Debug, Default, Group)]
#[command(next_help_heading = MACHINES)]
pub struct CredentialFlags {
    /// File with the credentials for the server: what `nsc` writes (.creds), or the seed of an NKey
    #[arg(long, value_name = "FILE", requires = "nats")]
    pub creds: Option<PathBuf>,
    /// File with the certificate of the authority that signed the server's
    #[arg(long, value_name = "FILE", requires = "nats")]
    pub tls_ca: Option<PathBuf>,
}

/// The window.
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
