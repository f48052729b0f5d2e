//! `snakes exam --trials`: the share of perturbed trials in which a champion reaches each step.

use std::path::{Path, PathBuf};

use serde_json::json;

use super::args::{Args, PerturbationArgs, number_if};
use super::endings::{add_endings, endings_table};
use super::error::CliError;
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print, print_json, print_line};
use super::replay::{equals_record, name_of};
use snakes_core::save::{SaveError, load_champion};
use snakes_core::score::PerturbationRange;
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::run::progress_bar::{bar_of, with_bar};
use snakes_lab::run::robust::{Robustness, robustness};
use snakes_lab::statistics::Share;

/// Simulates champions in perturbed trials, and prints the share of trials that reaches each step.
pub fn robust(args: &Args, files: &[PathBuf], wanted: &PerturbationArgs) -> Result<(), CliError> {
    let trials = number_if("--trials", &wanted.trials, 1..=1_000_000)?.unwrap_or_default();
    let seed = number_if("--seed", &wanted.seed, 0..=u64::MAX)?.unwrap_or(1);
    let range = wanted.range()?;
    for file in files {
        let champion = load_champion(file)?.champion;
        champion.check_shift("--off-start", range.start_m).map_err(SaveError::invalid(file))?;
    }
    // On a server, the name of the first file identifies the command.
    let first = files.first().map_or(Path::new(""), PathBuf::as_path);
    let evaluator = evaluator(args, "exam", first)?;
    let control = cancel_on_interrupt()?;
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
        let mut line = json!({"type": "endings", "file": name, "trials": found.trials});
        add_endings(&mut line, &found.endings);
        return print_json(&line);
    }
    let PerturbationRange { friction, rise, density, start_m, turn_deg, .. } = range;
    print_line(&format!(
        "{name}: {} trials from seed {seed}: friction ±{:.0} %, rise ±{:.0} %, density ±{:.0} %, start ±{start_m} m, \
         turn ±{turn_deg}°",
        found.trials,
        friction * 100.0,
        rise * 100.0,
        density * 100.0,
    ))?;
    let (disqualified, head) = (found.disqualified, "at least");
    let mut text =
        format!("{disqualified} disqualified\n\n{head:>14}  {:>6}  95 % interval\n", "share");
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
    print(&format!("{text}\n{}", endings_table(&[(name_of(file), "trials", &found.endings)])))
}

fn shares(found: &Robustness) -> impl Iterator<Item = (u32, Share)> + '_ {
    (1..).zip(&found.reached).map(|(step, &count)| (step, Share::of(count, found.trials)))
}
