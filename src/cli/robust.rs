//! `snakes robust`: the share of perturbed trials in which a champion reaches each step.

use std::path::Path;

use indicatif::ProgressBar;

use super::args::Args;
use super::error::{CliError, of_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use super::replay::equals_record;
use snakes_core::check::{Invalid, within};
use snakes_core::save::load_champion;
use snakes_core::schema;
use snakes_core::score::PerturbationRange;
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::run::progress_bar::with_bar;
use snakes_lab::run::robust::{Robustness, robustness};
use snakes_lab::statistics::Share;

/// Runs a champion through perturbed trials and prints the shares.
pub fn robust(
    args: &Args,
    file: &Path,
    trials: u32,
    range: &PerturbationRange,
) -> Result<(), CliError> {
    within("--trials", trials, 1..=1_000_000)?;
    schema::check(range).map_err(of_its_flag)?;
    let loaded = load_champion(file)?;
    let matches = equals_record(file, &loaded)?;
    let champion = loaded.champion;
    let evaluator = evaluator(args, "robust", file)?;
    let (control, seed) = (cancel_on_interrupt(), args.seed()?);
    let bar = ProgressBar::new(trials.into());
    let measure = || robustness(&champion, range, trials, seed, &*evaluator, &control);
    let found = with_bar(&bar, &control, measure);
    let found = found.map_err(|_| HeadlessError::Cancelled { kept: None });
    let found = trusted(&*evaluator, found)?;
    if args.json {
        for (step, share) in shares(&found) {
            let Share { seen, least, most } = share;
            let line =
                serde_json::json!({"step": step, "share": seen, "least": least, "most": most});
            print(&format!("{line}\n"))?;
        }
        let line = serde_json::json!({
            "done": true,
            "trials": found.trials,
            "disqualified": found.disqualified,
            "matches": matches,
        });
        return print(&format!("{line}\n"));
    }
    let PerturbationRange { friction, rise, density, start_m, turn_deg, .. } = range;
    let mut text = format!(
        "{} trials from seed {seed}: friction ±{:.0} %, rise ±{:.0} %, density ±{:.0} %, start ±{start_m} m, \
         turn ±{turn_deg}°\n{} disqualified\n\n{:>14}  {:>6}  95 % interval\n",
        found.trials,
        friction * 100.0,
        rise * 100.0,
        density * 100.0,
        found.disqualified,
        "at least",
        "share",
    );
    for (step, Share { seen, least, most }) in shares(&found) {
        let name = if step == 1 { "1 step".to_owned() } else { format!("{step} steps") };
        let percent = |share: f64| share * 100.0;
        text += &format!(
            "{name:>14}  {:>4.0} %  {:.1} to {:.1} %\n",
            percent(seen),
            percent(least),
            percent(most)
        );
    }
    print(&text)
}

/// An error about a range of perturbations, with the name of its flag.
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
