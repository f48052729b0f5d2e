//! The definitions of all commands and their flags. Their comments are the program's help.
//!
//! A command flattens the groups of flags that have an effect in it. It therefore refuses all other flags, and its help shows only
//! its own flags.

use std::path::PathBuf;

use clap::{Parser, Subcommand};
use clap_complete::Shell;

use super::export::ExportArgs;
use super::groups::{
    OutFlag, OutputFlags, RunFlags, SeedFlag, ServerFlags, SettingFlags, ThreadFlags, WindowFlags,
    WorkerFlags,
};
use super::robust::ExamArgs;
use super::study::StudyArgs;

/// A five-block snake evolves until it climbs a staircase.
///
/// Without arguments a window opens: a champion climbs, and a new run evolves in the background.
#[derive(Debug, Parser)]
#[command(name = "snakes", version, args_conflicts_with_subcommands = true)]
pub struct CommandLine {
    /// Work in the terminal, as `snakes run` does: no window opens, and no display is needed
    #[arg(long)]
    pub no_render: bool,
    /// Flags of the run.
    #[command(flatten)]
    pub run: RunFlags,
    /// Flags of the workers that evaluate the run.
    #[command(flatten)]
    pub workers: WorkerFlags,
    /// Flags of the run's output.
    #[command(flatten)]
    pub output: OutputFlags,
    /// Flags of the window.
    #[command(flatten)]
    pub window: WindowFlags,
    /// Command; `None` evolves a run.
    #[command(subcommand)]
    pub command: Option<CliCommand>,
}

/// The commands of the program.
#[derive(Debug, Subcommand)]
pub enum CliCommand {
    /// Evolve in the terminal: a line for each generation, and the champion as a file
    Run {
        /// Flags of the run.
        #[command(flatten)]
        run: RunFlags,
        /// Flags of the workers that evaluate the run.
        #[command(flatten)]
        workers: WorkerFlags,
        /// Flags of the run's output.
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
        /// Flags of the run that evolves behind the champions.
        #[command(flatten)]
        run: RunFlags,
        /// Flags of the workers that evaluate the run.
        #[command(flatten)]
        workers: WorkerFlags,
        /// Flags of the check's output.
        #[command(flatten)]
        output: OutputFlags,
        /// Flags of the window.
        #[command(flatten)]
        window: WindowFlags,
    },
    /// Examine champions: varied trials, other step rates, other stairs, a higher step, shoves, or trials that vary as you say
    Exam {
        /// Flags of the champions and their trials.
        #[command(flatten)]
        exam: ExamArgs,
        /// Flags of the workers that simulate the trials.
        #[command(flatten)]
        workers: WorkerFlags,
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Compare methods over several seeds: built-in studies, or your own as a file; without a name, list them
    Study {
        /// Flags of the study.
        #[command(flatten)]
        study: StudyArgs,
        /// Flags of changed settings.
        #[command(flatten)]
        settings: SettingFlags,
        /// Flag of the first seed.
        #[command(flatten)]
        seed: SeedFlag,
        /// Make the runs of the selected arms again
        #[arg(long)]
        restart: bool,
        /// Flags of the workers that evaluate runs.
        #[command(flatten)]
        workers: WorkerFlags,
        /// Flag of the folder of the results.
        #[command(flatten)]
        out: OutFlag,
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Write saved champions as pictures, films, pages, tables, scenes and models, or a run as figures
    Export {
        /// Flags of the files to export and their formats.
        #[command(flatten)]
        export: ExportArgs,
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// List the presets, every setting, or the blocks of a body
    Show {
        /// The list to show.
        #[command(subcommand)]
        what: ShownList,
    },
    /// Check that this machine computes the same bits as the reference machine
    Verify {
        /// Flags of the threads.
        #[command(flatten)]
        threads: ThreadFlags,
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Measure the speed of the simulation on this machine
    Bench {
        /// Saved champion, simulated in its own world [default: newborns of a preset]
        #[arg(conflicts_with_all = ["preset", "population", "generations", "duration", "fitness", "stairs", "set"])]
        file: Option<PathBuf>,
        /// Flags of the world in which newborns are simulated.
        #[command(flatten)]
        settings: SettingFlags,
        /// Flags of the threads.
        #[command(flatten)]
        threads: ThreadFlags,
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Compute for runs on other computers, until stopped
    Worker {
        /// Number of threads that compute [default: all cores]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        threads: Option<String>,
        /// Flags of the server.
        #[command(flatten)]
        server: ServerFlags,
    },
    /// List the workers and runs on a server, and what waits there
    Machines {
        /// Remove what waits for this run
        #[arg(long, value_name = "RUN")]
        purge: Option<String>,
        /// Flags of the server.
        #[command(flatten)]
        server: ServerFlags,
        /// Flags of the output.
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

/// The lists that `snakes show` prints.
#[derive(Debug, Subcommand)]
pub enum ShownList {
    /// The built-in presets
    Presets {
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// Every setting with its value, in the form that --set takes
    Settings {
        /// Print Markdown tables with descriptions, as in docs/settings.md
        #[arg(long, conflicts_with = "json")]
        markdown: bool,
        /// Flags of changed settings.
        #[command(flatten)]
        settings: SettingFlags,
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
    /// The blocks and joints of a champion's body: sizes, masses, limits, torques
    Body {
        /// Saved champion
        file: PathBuf,
        /// Flags of the output.
        #[command(flatten)]
        output: OutputFlags,
    },
}
