//! `snakes table1` and `snakes calibrate`.

use std::ops::RangeInclusive;

use super::args::Args;
use super::{CliError, cancel_on_interrupt, print};
use crate::check::{Invalid, within};
use crate::evolve::{RunPlan, Settings};
use crate::plot;
use crate::run::calibrate::{Calibration, Candidate, knobs, try_candidate};
use crate::run::headless::{HeadlessError, say, with_progress};
use crate::run::table1::{SeedResult, Table1, run_seed};
use crate::run::{Cancelled, pool};
use crate::save::{Preset, run_name, store_csv, store_picture, store_preset};
use crate::score::Fitness;

/// Runs the protocol with several seeds, prints the report's table beside ours, writes CSV and PNG.
pub fn table1(args: &Args, seeds: RangeInclusive<u64>) -> Result<(), CliError> {
    let (preset, settings) = args.settings()?;
    check_fitness(&settings)?;
    let folder = args.results_folder();
    folder.prepare()?;
    let pool = pool(args.threads()?).map_err(HeadlessError::from)?;
    let control = cancel_on_interrupt();
    let plan = |seed| RunPlan::new(&preset, seed, settings.clone());
    let run = run_name(&plan(*seeds.start()));
    let named = |kind: &str| folder.path().join(format!("table1-{run}-to-{}.{kind}", seeds.end()));
    let (csv, png) = (named("csv"), named("png"));
    say(&format!(
        "preset {preset}, seeds {} to {}: generations {}, population {}",
        seeds.start(),
        seeds.end(),
        settings.evolution.generations,
        settings.evolution.population
    ));
    let mut table = Table1 { seeds: Vec::new() };
    for seed in seeds.clone() {
        let result = run_seed(plan(seed), |run| with_progress(run, &pool, &control, |_, _, _| ()));
        let kept = (!table.seeds.is_empty()).then(|| csv.clone());
        let result = result.map_err(|Cancelled| HeadlessError::Cancelled { kept })?;
        if args.json {
            print(&format!("{}\n", json_of(&result)))?;
        } else {
            say(&format!("seed {seed:>3}: {}", means_of(&result)));
        }
        table.seeds.push(result);
        store_csv(&csv, &table.records())?;
    }
    let text = table.text(|mean| settings.trial.meaning(mean));
    let title = format!("Table 1 of the report, and ours (preset {preset})");
    store_picture(&png, &plot::table1(&table, &title)?)?;
    if args.json {
        let line = serde_json::json!({
            "done": true,
            "seeds": table.seeds.len(),
            "rising": table.rising(),
            "reaching": table.reaching(),
            "both": table.both(),
            "csv": csv,
            "png": png,
        });
        return print(&format!("{line}\n"));
    }
    print(&format!("{text}\nsaved to  {}\n          {}\n", csv.display(), png.display()))
}

/// Searches for the settings that the report left free.
pub fn calibrate(args: &Args, tries: u32, seeds: RangeInclusive<u64>) -> Result<(), CliError> {
    let (name, settings) = args.settings()?;
    check_fitness(&settings)?;
    within("tries", tries, 1..=1_000_000)?;
    let folder = args.results_folder();
    folder.prepare()?;
    let pool = pool(args.threads()?).map_err(HeadlessError::from)?;
    let control = cancel_on_interrupt();
    say(&format!(
        "from preset {name}, {tries} tries, seeds {} to {}; Ctrl-C keeps the best so far",
        seeds.start(),
        seeds.end()
    ));
    for knob in knobs() {
        say(&format!("  {:<34} {} to {}", knob.field, knob.least, knob.most));
    }
    let run = run_name(&RunPlan::new(&name, args.seed()?, settings.clone()));
    let path = folder.path().join(format!("calibrated-from-{run}.ron"));
    let mut search = Calibration::new(settings, args.seed()?);
    for number in 1..=tries {
        let point = search.next_point()?;
        let hopeless = search.hopeless_below();
        let candidate = try_candidate(point, seeds.clone(), hopeless, |run| {
            with_progress(run, &pool, &control, |_, _, _| ())
        });
        let kept = search.best().map(|_| path.clone());
        let candidate = candidate.map_err(|Cancelled| HeadlessError::Cancelled { kept })?;
        print(&line_of(number, &candidate))?;
        if search.take_in(candidate) == Some(0)
            && let Some(best) = search.best()
        {
            store_preset(&path, &preset_of(best, *seeds.end()))?;
        }
    }
    let best = search.best().map_or(f64::NAN, |best| best.score);
    print(&format!("\nbest score {best:.2}; its settings are a preset: {}\n", path.display()))
}

fn preset_of(candidate: &Candidate, last_seed: u64) -> Preset {
    Preset {
        name: "calibrated".to_owned(),
        about: format!(
            "Found by `snakes calibrate`: score {:.2} over {} seeds. Test it with other seeds: \
             snakes table1 --preset FILE --first-seed {}.",
            candidate.score,
            candidate.seeds.len(),
            last_seed.saturating_add(1)
        ),
        settings: candidate.settings.clone(),
    }
}

/// A candidate in a line: score, knobs, the means of its seeds.
fn line_of(number: u32, candidate: &Candidate) -> String {
    let values: Vec<String> = candidate.values.iter().map(f32::to_string).collect();
    let seeds: Vec<String> = candidate.seeds.iter().map(means_of).collect();
    format!(
        "{number:>4} {:>7.2}  ({})  [{}]\n",
        candidate.score,
        values.join(", "),
        seeds.join("] [")
    )
}

fn means_of(seed: &SeedResult) -> String {
    let means = seed.means.iter().map(|mean| match mean {
        Some(mean) => format!("{mean:.2}"),
        None => "-".to_owned(),
    });
    means.collect::<Vec<String>>().join(" ")
}

fn json_of(seed: &SeedResult) -> serde_json::Value {
    serde_json::json!({
        "seed": seed.seed,
        "means": seed.means,
        "disqualified": seed.disqualified,
        "run_hash": format!("{:016x}", seed.run_hash),
    })
}

/// The report's table is about one fitness; a mean of anything else beside it would mislead.
fn check_fitness(settings: &Settings) -> Result<(), Invalid> {
    let fitness = settings.trial.fitness;
    if fitness == Fitness::Centre {
        return Ok(());
    }
    Err(Invalid::new("trial.fitness", fitness, "centre, as in the report's table"))
}

/// Seeds from `first` on, `count` of them.
pub fn seeds(first: u64, count: u64) -> Result<RangeInclusive<u64>, Invalid> {
    within("seeds", count, 1..=10_000)?;
    within("first-seed", first, 0..=u64::MAX - count)?;
    Ok(first..=first + count - 1)
}
