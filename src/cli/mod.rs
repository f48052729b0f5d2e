//! The command line: parses flags, runs one of the program's modes, and returns an exit code.
//!
//! Exit codes: 0 done, 1 failed, 2 used wrongly. Every error is one line on standard error.

mod args;
mod bench;
mod body;
#[cfg(feature = "cluster")]
mod cluster;
mod endings;
mod error;
mod evaluators;
mod exam;
mod export;
#[cfg(feature = "studio")]
mod figures;
#[cfg(feature = "studio")]
mod film;
mod lists;
mod manual;
mod output;
mod poet_study;
#[cfg(feature = "studio")]
mod render;
mod replay;
mod resume;
mod robust;
mod study;
mod verify;

use std::ffi::OsString;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use args::{Args, Task};
pub use error::CliError;
#[cfg(unix)]
use output::survive_large_files;
use output::{cancel_on_interrupt, print};

use snakes_core::save::run_name;
use snakes_core::world::VectorLevel;
use snakes_lab::run::headless::{self, say};
use snakes_lab::run::report_panics;

/// Environment variable that names the vector instructions of the engine *lanes*, for measurements and tests.
const VECTORS_VARIABLE: &str = "SNAKES_SIMD";

/// Runs the program with these arguments, of which the first is the program's name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    report_panics();
    #[cfg(unix)]
    survive_large_files();
    let parsed = choose_vectors().and_then(|()| args::parse(arguments));
    let result = parsed.and_then(|parsed| match parsed {
        args::Parsed::Run(args, task) => dispatch(*args, &task),
        args::Parsed::Print(text) => print(&text),
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say(&format!("error: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}

/// Chooses the vector instructions that the environment names, if it names any.
fn choose_vectors() -> Result<(), CliError> {
    let Some(name) = std::env::var_os(VECTORS_VARIABLE) else { return Ok(()) };
    let chosen = VectorLevel::choose(&name.to_string_lossy());
    Ok(chosen.map_err(error::of_flag(VECTORS_VARIABLE))?)
}

/// Performs the task. If earlier results turn out to be wrong, because a machine computed other bits after right ones, everything
/// begins again without this machine.
fn dispatch(mut args: Args, task: &Task) -> Result<(), CliError> {
    loop {
        match perform(&args, task) {
            Err(CliError::Tainted(reason)) => {
                say(&format!(
                    "{reason}; everything begins again, since earlier results may be wrong"
                ));
                args.run.restart = true;
            }
            result => return result,
        }
    }
}

fn perform(args: &Args, task: &Task) -> Result<(), CliError> {
    match task {
        Task::Window(files) => open_studio(args, files),
        Task::Run => evolve(args),
        Task::CheckReplay(files) => replay::replay(files, args.json),
        Task::Exam(wanted) if wanted.perturbed.trials.is_some() => {
            robust::robust(args, &wanted.files, &wanted.perturbed)
        }
        Task::Exam(wanted) => exam::exam(args, wanted),
        Task::Study(wanted) => study::study(args, wanted),
        Task::Export(wanted) => export::export(args, wanted),
        Task::Presets => lists::print_presets(args.json),
        Task::Settings { as_markdown } => lists::print_settings(args, *as_markdown),
        Task::Body(file) => body::body(file, args.json),
        Task::Verify => verify::verify(args),
        Task::Bench(file) => bench::print_bench(args, file.as_deref()),
        #[cfg(feature = "cluster")]
        Task::Worker => cluster::worker(args),
        #[cfg(feature = "cluster")]
        Task::Machines { purge } => cluster::list(args, purge.as_deref()),
        #[cfg(not(feature = "cluster"))]
        Task::Worker | Task::Machines { .. } => Err(CliError::NoCluster),
        Task::Completions(shell) => print(&args::completions(*shell)),
        Task::Manual(folder) => manual::manual(folder.as_deref()),
    }
}

/// Evolves a run in the terminal.
fn evolve(args: &Args) -> Result<(), CliError> {
    let source = args.run_source()?;
    let evaluator = evaluators::evaluator(args, &run_name(&source.plan), &source.folder)?;
    let control = cancel_on_interrupt()?;
    let mut out = io::stdout();
    let result = headless::evolve(source, &*evaluator, args.json, &control, &mut out);
    evaluators::trusted(&*evaluator, result)
}

#[cfg(feature = "studio")]
fn open_studio(args: &Args, files: &[PathBuf]) -> Result<(), CliError> {
    use crate::studio;
    // Without an X11 display, only the error that follows is printed.
    let has_display = std::env::var_os("DISPLAY").is_some();
    studio::correct_variables(|note| {
        if has_display {
            say(note)
        }
    });
    let replay::Opened { champions, problems } = replay::opened(files, args.window.desktop)?;
    let comparison =
        args.window.comparison.as_deref().map(snakes_core::save::load_study).transpose();
    let (run, saves) = (args.run_source()?, args.saves_folder());
    // By default each start of the program begins another run and offers the stopped one, unless the user names a run.
    let names_run = args.names_run();
    let options = studio::Options {
        run: if names_run { run } else { run.with_unused_seed(&saves) },
        offers_stopped_run: !names_run,
        names_preset: args.run.settings.preset.is_some(),
        evaluator: args.studio_evaluator()?,
        saves,
        champions,
        problems,
        comparison: comparison.map_err(headless::HeadlessError::from)?,
        window_size: args.window_size()?,
        theme: args.theme()?,
        presents: args.window.present,
        preferences: args.preferences(),
        places: args.window.places.clone(),
        exit_after_frames: args.exit_after_frames()?,
    };
    Ok(studio::run(options)?)
}

#[cfg(not(feature = "studio"))]
fn open_studio(_: &Args, _: &[PathBuf]) -> Result<(), CliError> {
    Err(CliError::NoStudio)
}
