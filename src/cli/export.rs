//! `snakes export`: saved champions in the formats of other programs.

use std::cell::Cell;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::json;

use super::args::{Args, ExportArgs};
use super::error::CliError;
#[cfg(feature = "studio")]
use super::film;
use super::output::{cancel_on_interrupt, print_json, print_line};
use super::replay::equals_record;
use snakes_core::check::Invalid;
use snakes_lab::export::{ExportFormat, ExportOrder, ExportProgress, ExportSource};
use snakes_lab::run::headless::{HeadlessError, say};
use snakes_lab::run::progress_bar::{bar_of, beneath_bar};
use snakes_lab::run::{BackgroundTask, RunControl, WorkersError};

/// Number of positions of the progress bar.
const PER_MILLE: f64 = 1000.0;

/// Exports champions to the file of --output, and prints its path.
pub fn export(args: &Args, wanted: &ExportArgs) -> Result<(), CliError> {
    let Some(output) = wanted.output.as_deref().filter(|_| !wanted.figures) else {
        return figures(args, wanted);
    };
    let format = ExportFormat::of_path("--output", output)?;
    refuse_other_flags(wanted, format)?;
    #[cfg(feature = "studio")]
    if let Some(at) = &wanted.film.at {
        refuse_json(args, "--at")?;
        crate::studio::correct_variables(|_| ());
        return super::render::draw(wanted, at, output);
    }
    #[cfg(feature = "studio")]
    if format.is_film() {
        let film = film::ordered(wanted, format, output)?;
        return with_progress(args, wanted, |progress| film.carry_out(progress));
    }
    let mut order = ExportOrder::new(ExportSource::read(&wanted.files)?, output.to_owned())?;
    for champion in &mut order.source.champions {
        if !equals_record(&champion.file, &champion.loaded)? {
            champion.take_result_of_this_engine();
            let (name, result) = (&champion.name, champion.loaded.champion.reached());
            say(&format!("{name} is exported with the result that it has here: {result}"));
        }
    }
    with_progress(args, wanted, |progress| {
        order.carry_out(progress)?;
        Ok(output.to_owned())
    })
}

/// Draws the figures of a run into a folder.
fn figures(args: &Args, wanted: &ExportArgs) -> Result<(), CliError> {
    refuse_json(args, "--figures")?;
    if let Some(flag) = &wanted.film_flag {
        return Err(CliError::Usage(format!("{flag} has no effect with --figures")));
    }
    let [run] = wanted.files.as_slice() else {
        let problem = "--figures needs one file, the folder of a run".to_owned();
        return Err(CliError::Usage(problem));
    };
    #[cfg(feature = "studio")]
    {
        crate::studio::correct_variables(|_| ());
        super::figures::draw(run, wanted.output.as_deref())
    }
    #[cfg(not(feature = "studio"))]
    {
        let _ = run;
        Err(CliError::NoStudio)
    }
}

fn refuse_json(args: &Args, flag: &str) -> Result<(), CliError> {
    let problem = || CliError::Usage(format!("--json has no effect with {flag}"));
    if args.json { Err(problem()) } else { Ok(()) }
}

/// Refuses flags without an effect in this format.
fn refuse_other_flags(wanted: &ExportArgs, format: ExportFormat) -> Result<(), CliError> {
    let ending = format.info().ending;
    if wanted.film.at.is_some() && format != ExportFormat::Png {
        let allowed = "a name that ends in .png";
        return Err(Invalid::new("--output", format!("\".{ending}\""), allowed).into());
    }
    let given = wanted.film_flag.as_ref().filter(|_| !format.is_film());
    given.map_or(Ok(()), |flag| {
        let problem = format!("{flag} has no effect with .{ending} (see snakes export --help)");
        Err(CliError::Usage(problem))
    })
}

/// Does `work` while its progress is shown, and prints the path that it returns.
fn with_progress(
    args: &Args,
    wanted: &ExportArgs,
    work: impl FnOnce(&ExportProgress) -> Result<PathBuf, CliError>,
) -> Result<(), CliError> {
    let control = cancel_on_interrupt()?;
    if wanted.until_input_ends {
        let watched = cancel_at_end_of_input(&control).map_err(WorkersError::from);
        watched.map_err(HeadlessError::from)?;
    }
    let saved = if args.json {
        let told = Cell::new(None);
        let show = |share: f64| {
            let per_mille = (share * PER_MILLE) as u32;
            if told.replace(Some(per_mille)) != Some(per_mille) {
                let progress = f64::from(per_mille) / PER_MILLE;
                // An export continues even if the reader of its progress is gone.
                let _ = print_json(&json!({"type": "progress", "progress": progress}));
            }
        };
        let tell = |bytes: u64| {
            let _ = print_json(&json!({"type": "expected", "bytes": bytes}));
        };
        work(&ExportProgress::new(&show, &control).telling(&tell))?
    } else {
        let bar = bar_of(PER_MILLE as u64, "‰");
        let show = |share: f64| bar.set_position((share * PER_MILLE) as u64);
        let tell = |bytes: u64| say(&format!("about {:.1} MB", bytes as f64 / 1.0e6));
        beneath_bar(&bar, || work(&ExportProgress::new(&show, &control).telling(&tell)))?
    };
    let path = saved.display();
    if args.json {
        return print_json(&json!({"type": "done", "saved": path.to_string()}));
    }
    print_line(&format!("saved to {path}"))
}

/// Cancels at the end of standard input, so that a program that started this one can end it, even by its own end.
fn cancel_at_end_of_input(control: &Arc<RunControl>) -> io::Result<()> {
    let control = Arc::clone(control);
    let wait = move || {
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        control.cancel();
    };
    BackgroundTask::start(wait).map(drop)
}
