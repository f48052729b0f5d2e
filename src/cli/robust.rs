//! `snakes exam --trials`: the share of perturbed trials in which a champion reaches each step.

use std::path::{Path, PathBuf};

use serde_json::json;

use super::args::{Args, PerturbationArgs, WHOLE, number_or};
use super::error::{CliError, of_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print, print_json};
use super::replay::equals_record;
use snakes_core::check::{Invalid, within};
use snakes_core::save::load_champion;
use snakes_core::schema;
use snakes_core::score::PerturbationRange;
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::run::progress_bar::{bar_of, with_bar};
use snakes_lab::run::robust::{Robustness, robustness};
use snakes_lab::statistics::Share;

/// Simulates champions in perturbed trials, and prints the share of trials that reaches each step.
pub fn robust(args: &Args, files: &[PathBuf], wanted: &PerturbationArgs) -> Result<(), CliError> {
    let trials: u64 = number_or("--trials", &wanted.trials, 0, WHOLE)?;
    within("--trials", trials, 1..=1_000_000)?;
    let (trials, seed) = (trials as u32, number_or("--seed", &wanted.seed, 1, WHOLE)?);
    let range = PerturbationRange::from(wanted);
    schema::check(&range).map_err(of_its_flag)?;
    // On a server, the name of the first file identifies the command.
    let first = files.first().map_or(Path::new(""), PathBuf::as_path);
    let evaluator = evaluator(args, "exam", first)?;
    let control = cancel_on_interrupt();
    for file in files {
        let loaded = load_champion(file)?;
        let matches = equals_record(file, &loaded)?;
        let bar = bar_of(trials.into(), "trials");
        let measure = || robustness(&loaded.champion, &range, trials, seed, &*evaluator, &control);
        let found = with_bar(&bar, &control, measure);
        let found = found.map_err(|_| HeadlessError::Cancelled { kept: None });
        let found = trusted(&*evaluator, found)?;
        print_shares(args.json, file, &found, (&range, seed), matches)?;
    }
    if args.json {
        return print_json(&json!({"type": "done", "files": files.len()}));
    }
    Ok(())
}

/// Prints the shares of trials in which a champion reaches each step.
fn print_shares(
    as_json: bool,
    file: &Path,
    found: &Robustness,
    (range, seed): (&PerturbationRange, u64),
    matches: bool,
) -> Result<(), CliError> {
    let name = file.display().to_string();
    if as_json {
        for (step, Share { seen, least, most }) in shares(found) {
            print_json(&json!({
                "type": "step", "file": name, "step": step, "share": seen, "least": least, "most": most,
                "trials": found.trials, "disqualified": found.disqualified, "matches": matches,
            }))?;
        }
        return Ok(());
    }
    let PerturbationRange { friction, rise, density, start_m, turn_deg, .. } = range;
    let mut text = format!(
        "{name}: {} trials from seed {seed}: friction ±{:.0} %, rise ±{:.0} %, density ±{:.0} %, start ±{start_m} m, \
         turn ±{turn_deg}°\n{} disqualified\n\n{:>14}  {:>6}  95 % interval\n",
        found.trials,
        friction * 100.0,
        rise * 100.0,
        density * 100.0,
        found.disqualified,
        "at least",
        "share",
    );
    for (step, Share { seen, least, most }) in shares(found) {
        let steps = if step == 1 { "1 step".to_owned() } else { format!("{step} steps") };
        let percent = |share: f64| share * 100.0;
        text += &format!(
            "{steps:>14}  {:>4.0} %  {:.1} to {:.1} %\n",
            percent(seen),
            percent(least),
            percent(most)
        );
    }
    print(&text)
}

/// Returns an error about a range of perturbations with the name of its flag.
fn of_its_flag(invalid: Invalid) -> Invalid {
    let flag = match invalid.field.rsplit('.').next().unwrap_or_default() {
        "start_m" => "start",
        "turn_deg" => "turn",
        other => other,
    };
    of_flag(&format!("--off-{flag}"))(invalid)
}

fn shares(found: &Robustness) -> impl Iterator<Item = (u32, Share)> + '_ {
    (1..).zip(&found.reached).map(|(step, &count)| (step, Share::of(count, found.trials)))
}
