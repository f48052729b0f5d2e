//! `snakes robust`: in how many perturbed trials a champion reaches each step.

use std::path::Path;

use indicatif::ProgressBar;

use super::args::Args;
use super::{CliError, cancel_on_interrupt, print};
use crate::check::within;
use crate::run::headless::{HeadlessError, watched};
use crate::run::pool;
use crate::run::robust::{Robustness, Share, robustness};
use crate::save::load_champion;
use crate::score::PerturbationRange;

/// How far perturbed trials are off.
#[derive(Debug, clap::Args)]
pub struct OffBy {
    /// Share by which friction is larger or smaller
    #[arg(long, value_name = "SHARE", default_value_t = PerturbationRange::default().friction)]
    off_friction: f32,
    /// Share by which the steps are higher or lower
    #[arg(long, value_name = "SHARE", default_value_t = PerturbationRange::default().rise)]
    off_rise: f32,
    /// Share by which the limbs are heavier or lighter
    #[arg(long, value_name = "SHARE", default_value_t = PerturbationRange::default().density)]
    off_density: f32,
    /// Distance of the start, along and across, in metres
    #[arg(long, value_name = "M", default_value_t = PerturbationRange::default().start_m)]
    off_start: f32,
    /// Turn of the snake at the start, in degrees
    #[arg(long, value_name = "DEG", default_value_t = PerturbationRange::default().turn_deg)]
    off_turn: f32,
}

impl From<&OffBy> for PerturbationRange {
    fn from(off: &OffBy) -> Self {
        Self {
            friction: off.off_friction,
            rise: off.off_rise,
            density: off.off_density,
            start_m: off.off_start,
            turn_deg: off.off_turn,
        }
    }
}

/// Runs a champion through perturbed trials and prints the shares.
pub fn robust(
    args: &Args,
    file: &Path,
    trials: u32,
    range: &PerturbationRange,
) -> Result<(), CliError> {
    within("trials", trials, 1..=1_000_000)?;
    range.check()?;
    let champion = load_champion(file)?.champion;
    let pool = pool(args.threads()?).map_err(HeadlessError::from)?;
    let (control, seed) = (cancel_on_interrupt(), args.seed()?);
    let bar = ProgressBar::new(trials.into());
    let found =
        watched(&bar, &control, || robustness(&champion, range, trials, seed, &pool, &control));
    let found = found.map_err(|_| HeadlessError::Cancelled { kept: None })?;
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
        });
        return print(&format!("{line}\n"));
    }
    let PerturbationRange { friction, rise, density, start_m, turn_deg } = range;
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

fn shares(found: &Robustness) -> impl Iterator<Item = (u32, Share)> + '_ {
    (1..).zip(&found.reached).map(|(step, &count)| (step, Share::of(count, found.trials)))
}
