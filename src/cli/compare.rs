//! `snakes compare`: several methods under equal budgets, as a table, CSV, RON and a picture.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use super::args::{Args, CompareArgs};
use super::error::{CliError, of_flag};
use super::evaluators::{evaluator, trusted};
use super::output::{cancel_on_interrupt, print};
use snakes_core::check::{Invalid, within};
use snakes_core::evolve::{RunPlan, Settings, StrategyKind};
use snakes_core::genome::ControllerKind;
use snakes_core::save::{
    Comparison, MAX_COMPARED_RUNS, load_comparison, run_name, settings_fingerprint,
    store_comparison, store_csv, store_picture,
};
use snakes_core::schema::Choices;
use snakes_lab::plot;
use snakes_lab::run::compare::{ComparisonTables, PlannedRun, run_all};
use snakes_lab::run::headless::say;
use snakes_lab::run::progress_bar::bar_of;

/// The kinds that a flag's list names, in their usual order and each once.
pub(super) fn kinds<K: Choices + PartialEq>(flag: &str, text: &str) -> Result<Vec<K>, Invalid> {
    if text == "all" {
        return Ok(K::OPTIONS.to_vec());
    }
    let named = |word: &str| {
        K::named(flag, word.trim())
            .map_err(|error| Invalid { allowed: format!("all, {}", error.allowed), ..error })
    };
    let named: Vec<K> = text.split(',').map(named).collect::<Result<_, _>>()?;
    Ok(K::OPTIONS.iter().copied().filter(|kind| named.contains(kind)).collect())
}

/// So many seeds from the first on.
pub(super) fn seeds_from(first: u64, count: u64) -> Result<RangeInclusive<u64>, Invalid> {
    within("--seeds", count, 1..=10_000)?;
    let last = first.checked_add(count - 1).ok_or_else(|| {
        Invalid::new("--seed", first, "a first seed that leaves room for the others after it")
    })?;
    Ok(first..=last)
}

/// Refuses changes of settings that a comparison sets itself.
fn check_compared(preset: &Settings, settings: &Settings) -> Result<(), Invalid> {
    let refused = |field, value: &dyn Display, allowed| Err(Invalid::new(field, value, allowed));
    if settings.evolution.strategy != preset.evolution.strategy {
        let allowed = "the preset's; --strategies selects strategies";
        return refused("evolution.strategy", &settings.evolution.strategy, allowed);
    }
    if settings.genome.controller != preset.genome.controller {
        let allowed = "the preset's; --controllers selects controllers";
        return refused("genome.controller", &settings.genome.controller, allowed);
    }
    if settings.evolution.generations != preset.evolution.generations {
        let allowed = "the preset's; --evaluations sets the budget";
        return refused("evolution.generations", &settings.evolution.generations, allowed);
    }
    if settings.trial.repeats.champion_trials != preset.trial.repeats.champion_trials {
        let allowed =
            "the preset's; a comparison takes the best fitness and makes no trials for the choice";
        return refused(
            "repeats.champion_trials",
            &settings.trial.repeats.champion_trials,
            allowed,
        );
    }
    Ok(())
}

/// Performs the runs that the result's file does not have yet, and prints the result.
pub fn compare(args: &Args, compared: &CompareArgs) -> Result<(), CliError> {
    let (preset, mut settings) = args.settings()?;
    check_compared(&args.preset()?.settings, &settings)?;
    // The budget counts every simulation, and the table has the best fitness.
    settings.trial.repeats.champion_trials = 0;
    let mut strategies: Vec<StrategyKind> = kinds("--strategies", &compared.strategies)?;
    if compared.strategies == "all" {
        // Those that vary bodies are compared with the others where they are named.
        let varies = settings.genome.bodies.vary;
        strategies
            .retain(|kind| kind.info().varies_bodies == varies && !kind.info().evolves_stairs);
    }
    let controllers: Vec<ControllerKind> = kinds("--controllers", &compared.controllers)?;
    let first_seed = args.seed()?;
    let seeds = seeds_from(first_seed, compared.seeds)?;
    let mut plans = Vec::new();
    for &strategy in &strategies {
        let fitting = controllers.iter().filter(|kind| strategy.improves(**kind));
        let fitting: Vec<ControllerKind> = fitting.copied().collect();
        if fitting.is_empty() {
            let names: Vec<&str> = strategy.controllers().map(ControllerKind::name).collect();
            let allowed = format!("all, or a list with one of {} for {strategy}", names.join(", "));
            return Err(Invalid::new("--controllers", &compared.controllers, allowed).into());
        }
        for controller in fitting {
            for seed in seeds.clone() {
                let planned = PlannedRun { strategy, controller, seed };
                let plan = planned.plan(&preset, &settings, compared.evaluations);
                plans.push(plan.map_err(|invalid| match invalid.field.as_str() {
                    "evaluations" => of_flag("--evaluations")(invalid),
                    _ => invalid,
                })?);
            }
        }
    }
    within("runs", plans.len(), 1..=MAX_COMPARED_RUNS)?;
    let folder = args.results_folder();
    folder.prepare()?;
    let base = RunPlan::new(&preset, 0, settings.clone());
    let name =
        format!("compare-{}-{}", run_name(&base).replace("-seed0", ""), compared.evaluations);
    let named = |kind: &str| folder.path().join(format!("{name}.{kind}"));
    let (ron, csv, png) = (named("ron"), named("csv"), named("png"));
    let fitness = settings.trial.fitness;
    let fingerprint = settings_fingerprint(&base);
    let mut comparison = Comparison::new(&preset, fingerprint, compared.evaluations, fitness);
    if ron.exists() && !args.restart {
        let earlier = load_comparison(&ron)?;
        if earlier.settings != comparison.settings || earlier.evaluations != compared.evaluations {
            let allowed =
                format!("{}, the fingerprint of the preset's settings", comparison.settings);
            let source = Invalid::new("settings", earlier.settings, allowed);
            return Err(snakes_core::save::SaveError::Invalid { path: ron, source }.into());
        }
        comparison = earlier;
    }
    if let Some(note) = note_on_single_generations(&plans) {
        say(&note);
    }
    let all = plans.len();
    plans.retain(|plan| !is_done(&comparison, plan));
    say(&format!(
        "preset {preset}: {} of {} runs left, {} evaluations each",
        plans.len(),
        all,
        compared.evaluations
    ));
    let bar = bar_of(u64::from(compared.evaluations) * plans.len() as u64, "evaluations");
    let control = cancel_on_interrupt();
    let spent = |evaluations: u32| bar.inc(evaluations.into());
    let evaluator = evaluator(args, "compare", &ron)?;
    let result = run_all(&plans, &*evaluator, &control, spent, |run| {
        comparison.add(run);
        // After each run, so that a kill loses none that is finished.
        Ok(store_comparison(&ron, &comparison)?)
    });
    bar.finish_and_clear();
    trusted(&*evaluator, result.map_err(|error| error.keeping(&ron)))?;
    store_comparison(&ron, &comparison)?;
    store_csv(&csv, &comparison.records())?;
    store_picture(&png, &plot::comparison(&comparison)?)?;
    show(args, &comparison, [ron, csv, png])
}

/// A note on the strategies whose budget is a single generation: nothing has been learned then, so that their rows of
/// the table are equal. `None` if there are none.
fn note_on_single_generations(plans: &[RunPlan]) -> Option<String> {
    let of_plan = |plan: &RunPlan| {
        let evolution = &plan.settings.evolution;
        (evolution.generations == 1).then_some(evolution.strategy)
    };
    let is_one = |kind: &&StrategyKind| plans.iter().filter_map(of_plan).any(|of| of == **kind);
    let names: Vec<&str> =
        StrategyKind::OPTIONS.iter().filter(is_one).map(|kind| kind.name()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "note: {}: these evaluations are a single generation, before anything is learned; raise \
             --evaluations or lower --population to compare methods",
            names.join(", ")
        )
    })
}

/// Whether the comparison has this run already.
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
    use snakes_core::evolve::with_fields;

    #[test]
    fn a_list_of_names_is_read_and_an_unknown_one_refused() {
        let read = |text| kinds::<StrategyKind>("--strategies", text);
        assert_eq!(read("all").expect("all"), StrategyKind::OPTIONS);
        let some = read("map_elites, cma-es,cma_es").expect("known");
        assert_eq!(some, [StrategyKind::CmaEs, StrategyKind::MapElites]);
        let error = read("ga,annealing").expect_err("refused").to_string();
        assert!(
            error.starts_with("--strategies is \"annealing\"; allowed: all, halving, ga"),
            "{error}"
        );
    }

    #[test]
    fn strategies_with_a_single_generation_are_named() {
        let settings = Settings::default();
        let population = settings.evolution.population;
        let plan = |strategy, evaluations| {
            let controller = ControllerKind::Gait;
            let planned = PlannedRun { strategy, controller, seed: 1 };
            planned.plan("test", &settings, evaluations).expect("allowed")
        };
        let few = [StrategyKind::Halving, StrategyKind::Ga, StrategyKind::Random]
            .map(|strategy| plan(strategy, population));
        let note = note_on_single_generations(&few).expect("two of them");
        assert!(note.starts_with("note: ga, random: these evaluations are a single"), "{note}");
        let enough = plan(StrategyKind::Ga, population * 2);
        assert_eq!(note_on_single_generations(&[enough]), None);
    }

    #[test]
    fn a_setting_that_a_comparison_sets_itself_is_refused() {
        let preset = Settings::default();
        for (field, value) in [
            ("evolution.strategy", "cma_es"),
            ("genome.controller", "gait"),
            ("evolution.generations", "7"),
        ] {
            let changed = with_fields(&preset, [(field, value)]).expect("allowed");
            let refusal = check_compared(&preset, &changed).expect_err("refused").to_string();
            assert!(refusal.starts_with(field) && refusal.contains("; --"), "{refusal}");
        }
        let friction = with_fields(&preset, [("surface.friction", "0.5")]).expect("allowed");
        assert!(check_compared(&preset, &friction).is_ok());
    }
}
