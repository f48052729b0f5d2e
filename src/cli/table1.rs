//! `snakes table1`: the report's protocol with several seeds, beside the report's Table 1.

use super::args::Args;
use super::error::CliError;
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use snakes_core::check::{Invalid, within};
use snakes_core::evolve::{RunPlan, Settings};
use snakes_core::save::{run_name, store_csv, store_picture};
use snakes_core::score::Fitness;
use snakes_lab::plot;
use snakes_lab::run::Cancelled;
use snakes_lab::run::headless::{HeadlessError, say};
use snakes_lab::run::progress_bar::run_generation_with_bar;
use snakes_lab::run::table1::{SeedResult, Table1, run_seed};

/// Runs the protocol with `count` seeds from `first_seed` on; prints both tables, and writes CSV and PNG.
pub fn table1(args: &Args, first_seed: u64, count: u64) -> Result<(), CliError> {
    within("--seeds", count, 1..=10_000)?;
    within("--first-seed", first_seed, 0..=u64::MAX - count)?;
    let seeds = first_seed..=first_seed + count - 1;
    let (preset, settings) = args.settings_of_run()?;
    check_fitness(&settings).map_err(|invalid| args.of_its_flag(invalid))?;
    let folder = args.results_folder();
    folder.prepare()?;
    let evaluator = evaluator(args, "table1", folder.path())?;
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
        let result = run_seed(plan(seed), |run| {
            run_generation_with_bar(run, &*evaluator, &control, |_, _, _| ())
        });
        let kept = (!table.seeds.is_empty()).then(|| csv.clone());
        let result = result.map_err(|Cancelled| HeadlessError::Cancelled { kept });
        let result = trusted(&*evaluator, result)?;
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

/// The report's table is about one fitness; the mean of another one beside it would mislead.
fn check_fitness(settings: &Settings) -> Result<(), Invalid> {
    let fitness = settings.trial.fitness;
    if fitness == Fitness::Centre {
        return Ok(());
    }
    Err(Invalid::new("trial.fitness", fitness, "centre, as in the report's table"))
}
