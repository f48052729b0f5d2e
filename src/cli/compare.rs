//! `snakes compare`: several methods under equal budgets, as a table, CSV, RON and a picture.

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use super::args::Args;
use super::{CliError, cancel_on_interrupt, print};
use crate::check::{Invalid, within};
use crate::evolve::{RunPlan, StrategyKind};
use crate::genome::ControllerKind;
use crate::plot;
use crate::run::compare::{Contestant, run_all};
use crate::run::headless::{HeadlessError, say};
use crate::save::{
    Comparison, MOST_RUNS, load_comparison, run_name, settings_fingerprint, store_comparison,
    store_csv, store_picture,
};

/// What is compared.
#[derive(Debug, clap::Args)]
pub struct CompareArgs {
    /// Strategies: all, or some of halving, ga, cma-es, map-elites, novelty, random
    #[arg(long, value_name = "A,B", default_value = "all")]
    strategies: String,
    /// Controllers: all, or some of signal, wave, gait
    #[arg(long, value_name = "X,Y", default_value = "all")]
    controllers: String,
    /// How many seeds, from --seed on
    #[arg(long, value_name = "N", default_value_t = 10)]
    seeds: u64,
    /// Evaluations that each run may spend
    #[arg(long, value_name = "M", default_value_t = 3000)]
    evaluations: u32,
}

/// The kinds that a list names.
fn kinds<K: Copy + PartialEq, const N: usize>(
    flag: &str,
    text: &str,
    all: [K; N],
    name: fn(K) -> &'static str,
) -> Result<Vec<K>, Invalid> {
    if text == "all" {
        return Ok(all.to_vec());
    }
    let named = |word: &str| {
        let word = word.trim().replace('-', "_");
        all.into_iter().find(|kind| name(*kind) == word).ok_or_else(|| {
            let names: Vec<&str> = all.iter().map(|kind| name(*kind)).collect();
            Invalid::new(flag, format!("{word:?}"), format!("all, {}", names.join(", ")))
        })
    };
    let named: Vec<K> = text.split(',').map(named).collect::<Result<_, _>>()?;
    // In their own order, and each once.
    Ok(all.into_iter().filter(|kind| named.contains(kind)).collect())
}

/// Runs everything that is not yet in the result's file, and shows the result.
pub fn compare(args: &Args, what: &CompareArgs) -> Result<(), CliError> {
    let (preset, settings) = args.settings()?;
    let strategies = kinds("strategies", &what.strategies, StrategyKind::ALL, StrategyKind::name)?;
    let controllers =
        kinds("controllers", &what.controllers, ControllerKind::ALL, ControllerKind::name)?;
    within("seeds", what.seeds, 1..=10_000)?;
    let first_seed = args.seed()?;
    let last_seed = first_seed.checked_add(what.seeds - 1).ok_or_else(|| {
        Invalid::new("seed", first_seed, "a first seed that leaves room for the others")
    })?;
    let mut plans = Vec::new();
    for &strategy in &strategies {
        for &controller in &controllers {
            for seed in first_seed..=last_seed {
                let contestant = Contestant { strategy, controller, seed };
                plans.push(contestant.plan(&preset, &settings, what.evaluations)?);
            }
        }
    }
    within("runs", plans.len(), 1..=MOST_RUNS)?;
    let folder = args.results_folder();
    folder.prepare()?;
    let base = RunPlan::new(&preset, 0, settings.clone());
    let name = format!("compare-{}-{}", run_name(&base).replace("-seed0", ""), what.evaluations);
    let named = |kind: &str| folder.path().join(format!("{name}.{kind}"));
    let (ron, csv, png) = (named("ron"), named("csv"), named("png"));
    let fitness = settings.trial.fitness;
    let fingerprint = settings_fingerprint(&base);
    let mut comparison = Comparison::new(&preset, fingerprint, what.evaluations, fitness);
    if ron.exists() && !args.restart {
        let earlier = load_comparison(&ron)?;
        if earlier.settings != comparison.settings || earlier.evaluations != what.evaluations {
            let allowed = format!("{}, as the preset has them", comparison.settings);
            let source = Invalid::new("settings", earlier.settings, allowed);
            return Err(crate::save::SaveError::Invalid { path: ron, source }.into());
        }
        comparison = earlier;
    }
    plans.retain(|plan| !is_done(&comparison, plan));
    say(&format!(
        "preset {preset}: {} of {} runs to do, {} evaluations each",
        plans.len(),
        strategies.len() * controllers.len() * what.seeds as usize,
        what.evaluations
    ));
    let bar = ProgressBar::new(u64::from(what.evaluations) * plans.len() as u64);
    // The template is a constant; if it were wrong, the default bar would do.
    if let Ok(style) =
        ProgressStyle::with_template("{wide_bar} {pos}/{len} evaluations  {eta} left")
    {
        bar.set_style(style);
    }
    let control = cancel_on_interrupt();
    let spent = |evaluations: u32| bar.inc(evaluations.into());
    let result = run_all(&plans, args.threads()?, &control, spent, |run| {
        comparison.add(run);
        // Nothing that was computed is lost.
        Ok(store_comparison(&ron, &comparison)?)
    });
    bar.finish_and_clear();
    result.map_err(|error| match error {
        HeadlessError::Cancelled { .. } => {
            HeadlessError::Cancelled { kept: ron.exists().then(|| ron.clone()) }
        }
        other => other,
    })?;
    store_comparison(&ron, &comparison)?;
    store_csv(&csv, &comparison.records())?;
    store_picture(&png, &plot::comparison(&comparison)?)?;
    show(args, &comparison, [ron, csv, png])
}

fn is_done(comparison: &Comparison, plan: &RunPlan) -> bool {
    comparison.runs.iter().any(|run| {
        run.seed == plan.seed
            && run.strategy == plan.settings.evolution.strategy
            && run.controller == plan.settings.genome.controller
    })
}

fn show(args: &Args, comparison: &Comparison, files: [PathBuf; 3]) -> Result<(), CliError> {
    if args.json {
        let line = serde_json::json!({
            "done": true,
            "runs": comparison.runs.len(),
            "files": files,
        });
        return print(&format!("{line}\n"));
    }
    let [ron, csv, png] = files.map(|file| file.display().to_string());
    print(&format!("{}\nsaved to  {ron}\n          {csv}\n          {png}\n", comparison.text()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_of_names_is_read_and_an_unknown_one_refused() {
        let read = |text| kinds("strategies", text, StrategyKind::ALL, StrategyKind::name);
        assert_eq!(read("all").expect("all").len(), 6);
        let some = read("map_elites, cma-es,cma_es").expect("known");
        assert_eq!(some, [StrategyKind::CmaEs, StrategyKind::MapElites]);
        let error = read("ga,annealing").expect_err("refused").to_string();
        assert!(
            error.starts_with("strategies is \"annealing\"; allowed: all, halving, ga"),
            "{error}"
        );
    }
}
