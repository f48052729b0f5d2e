//! The command line: flags in, one of the program's modes out, an exit code at the end.
//!
//! Exit codes: 0 done, 1 failed, 2 used wrongly. Every error is one line on standard error.

mod args;
mod compare;
mod error;
#[cfg(feature = "studio")]
mod figures;
mod render;
mod robust;
mod table1;
mod verify;

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use indicatif::ProgressBar;

use args::{Args, Command};
pub use error::CliError;

use crate::check::Invalid;
use crate::evolve::fields;
use crate::run::bench::{BenchReport, bench};
use crate::run::headless::say;
use crate::run::{Control, headless};
use crate::save::shipped_presets;
#[cfg(feature = "studio")]
use crate::save::{LoadedChampion, load_champion};

/// Runs the program with the given arguments, the program's name first.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let result = args::parse(arguments).and_then(|parsed| match parsed {
        args::Parsed::Run(args) => dispatch(*args),
        args::Parsed::Print(text) => print(&text),
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let line = error.to_string().replace(char::is_control, " ");
            say(&format!("error: {line}"));
            ExitCode::from(error.exit_code())
        }
    }
}

fn dispatch(args: Args) -> Result<(), CliError> {
    match &args.command {
        Some(Command::Presets) => print_presets(args.json),
        Some(Command::Settings) => print_settings(&args),
        Some(Command::Bench) => print_bench(&args),
        Some(Command::Verify) => verify::verify(&args),
        Some(Command::Robust { file, trials, range }) => {
            robust::robust(&args, file, *trials, &range.into())
        }
        Some(Command::Compare(what)) => compare::compare(&args, what),
        Some(Command::Table1 { seeds, first_seed }) => {
            table1::table1(&args, table1::seeds(*first_seed, *seeds)?)
        }
        Some(Command::Calibrate { tries, seeds, first_seed }) => {
            table1::calibrate(&args, *tries, table1::seeds(*first_seed, *seeds)?)
        }
        #[cfg(feature = "studio")]
        Some(Command::Figures { run }) => figures::draw(&args, run),
        #[cfg(not(feature = "studio"))]
        Some(Command::Figures { .. }) => Err(CliError::NoStudio),
        #[cfg(feature = "studio")]
        Some(Command::Render(what)) => render::draw(&args, what),
        #[cfg(not(feature = "studio"))]
        Some(Command::Render(_)) => Err(CliError::NoStudio),
        Some(Command::Replay { files }) if args.no_render => {
            let replay = |file: &PathBuf| {
                if files.len() > 1 && !args.json {
                    // Whose numbers these are; an error below it is about the same file.
                    print(&format!("{}\n", file.display()))?;
                }
                Ok(headless::replay(file, args.json, &mut io::stdout().lock())?)
            };
            // All are looked at; the first that fails is the error.
            let done: Vec<Result<(), CliError>> = files.iter().map(replay).collect();
            done.into_iter().collect()
        }
        None if args.no_render => evolve(&args),
        None | Some(Command::Replay { .. }) => open_studio(&args),
    }
}

/// The headless experiment.
fn evolve(args: &Args) -> Result<(), CliError> {
    let source = args.run_source()?;
    let threads = args.threads()?;
    let control = cancel_on_interrupt();
    let mut out = io::stdout();
    Ok(headless::evolve(source, threads, args.json, &control, &mut out)?)
}

/// A control that the interrupt key cancels.
fn cancel_on_interrupt() -> Arc<Control> {
    let control = Arc::new(Control::default());
    let cancelled = Arc::clone(&control);
    // Without a handler the key ends the program at once; what is saved by then is whole.
    let _ = ctrlc::set_handler(move || cancelled.cancel());
    control
}

/// Saved champions, each with the name of its file.
#[cfg(feature = "studio")]
fn named_champions(files: &[PathBuf]) -> Result<Vec<(String, LoadedChampion)>, CliError> {
    let load = |file: &PathBuf| {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((name, load_champion(file)?))
    };
    files.iter().map(load).collect()
}

#[cfg(feature = "studio")]
fn open_studio(args: &Args) -> Result<(), CliError> {
    use crate::studio;
    let files = match &args.command {
        Some(Command::Replay { files }) => &files[..],
        _ => &[],
    };
    let comparison = args.comparison.as_deref().map(crate::save::load_comparison).transpose();
    let options = studio::Options {
        run: args.run_source()?,
        threads: args.studio_threads()?,
        saves: args.saves_folder(),
        champions: named_champions(files)?,
        comparison: comparison.map_err(headless::HeadlessError::from)?,
        window_size: args.window_size()?,
        theme: args.theme()?,
        preferences: args.preferences(),
        places: args.places.clone(),
        exit_after_frames: args.exit_after_frames()?,
    };
    Ok(studio::run(options)?)
}

#[cfg(not(feature = "studio"))]
fn open_studio(_: &Args) -> Result<(), CliError> {
    Err(CliError::NoStudio)
}

fn print_presets(json: bool) -> Result<(), CliError> {
    let presets = shipped_presets().map_err(headless::HeadlessError::from)?;
    let mut text = String::new();
    for preset in presets {
        if json {
            text +=
                &format!("{}\n", serde_json::json!({"name": preset.name, "about": preset.about}));
        } else {
            text += &format!("{:<14}{}\n", preset.name, preset.about);
        }
    }
    print(&text)
}

fn print_settings(args: &Args) -> Result<(), CliError> {
    let (preset, settings) = args.settings()?;
    let fields = fields(&settings);
    if args.json {
        let line = serde_json::json!({"preset": preset, "settings": settings});
        return print(&format!("{line}\n"));
    }
    let width = fields.iter().map(|(path, _)| path.len()).max().unwrap_or(0);
    let lines = fields.iter().map(|(path, value)| format!("{path:<width$} = {value}\n"));
    print(&lines.collect::<String>())
}

fn print_bench(args: &Args) -> Result<(), CliError> {
    let settings = args.preset()?.settings;
    let bar = ProgressBar::new(100);
    let report = bench(&settings, args.threads()?, BENCH_DURATION, |share| {
        bar.set_position((share * 100.0) as u64);
    });
    bar.finish_and_clear();
    let report = report.map_err(headless::HeadlessError::from)?;
    if args.json {
        let line = serde_json::to_string(&report).map_err(io::Error::other);
        return print(&format!("{}\n", line.map_err(headless::HeadlessError::from)?));
    }
    print(&bench_table(&report))
}

/// "A few seconds": twenty-odd rounds of all contestants.
const BENCH_DURATION: Duration = Duration::from_secs(6);

fn bench_table(report: &BenchReport) -> String {
    format!(
        "threads                  {}\n\
         steps_per_s              {:.0}\n\
         sim_s_per_s              {:.1}  ({:.1} per thread)\n\
         one thread               {:.1} sim_s_per_s\n\
         bare rapier, one thread  {:.1} sim_s_per_s\n\
         ratio to bare rapier     {:.3}\n\
         scaling over one thread  {:.3}\n",
        report.threads,
        report.steps_per_s,
        report.sim_s_per_s,
        report.sim_s_per_s_per_thread,
        report.one_thread_sim_s_per_s,
        report.bare_rapier_sim_s_per_s,
        report.ratio_to_bare_rapier,
        report.scaling,
    )
}

/// Writes to standard output. A reader that has had enough (`snakes presets | head -1`) is no error.
fn print(text: &str) -> Result<(), CliError> {
    match io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other.map_err(headless::HeadlessError::from)?),
    }
}

impl From<Invalid> for CliError {
    fn from(invalid: Invalid) -> Self {
        Self::Usage(invalid.to_string())
    }
}
