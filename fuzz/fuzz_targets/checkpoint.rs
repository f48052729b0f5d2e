//! The state of a search.
#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use snakes_core::evolve::{RunPlan, Settings, StrategyKind, resume};
use snakes_core::genome::ControllerKind;
use snakes_core::score::Fitness;
use snakes_core::save::{fingerprint, parse_checkpoint};

/// A plan for each strategy, and its fingerprint.
static PLANS: LazyLock<Vec<(RunPlan, String)>> = LazyLock::new(|| StrategyKind::ALL.map(plan).to_vec());

fn plan(strategy: StrategyKind) -> (RunPlan, String) {
    let mut settings = Settings::default();
    settings.evolution.strategy = strategy;
    settings.genome.bodies.vary = strategy.info().varies_bodies;
    let of_bodies = [ControllerKind::Gait, ControllerKind::PartNeurons];
    let mut fitting =
        strategy.controllers().filter(|kind| !settings.genome.bodies.vary || of_bodies.contains(kind));
    if let Some(controller) = fitting.next() {
        settings.genome.controller = controller;
    }
    if settings.genome.bodies.vary {
        settings.genome.bodies.limbs_max = 3;
        settings.evolution.islands.candidates = 4;
        settings.evolution.generations = 40;
    }
    if strategy.info().evolves_stairs {
        settings.trial.fitness = Fitness::Share;
        settings.evolution.poet.pair_candidates = 4;
        settings.evolution.mcc.snake_queue = 4;
        settings.evolution.mcc.first_snakes = 4;
        settings.evolution.generations = 100;
    }
    settings.evolution.population = 3;
    settings.trial.duration_s = 0.1;
    let plan = RunPlan::new("x", 1, settings);
    let fingerprint = fingerprint(&plan);
    (plan, fingerprint)
}

fuzz_target!(|text: &str| {
    for (plan, fingerprint) in PLANS.iter() {
        match parse_checkpoint(Path::new("x"), &text.replace("PLAN", fingerprint), plan) {
            Ok((generation, _, knowledge)) => {
                // An accepted state can be resumed.
                let strategy = resume(plan, generation % 100, &knowledge.strategy);
                let children = strategy.expect("it passed the same check").ask();
                for child in children {
                    assert_eq!(plan.settings.trial.check_genome(&child.genome), Ok(()));
                }
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
        }
    }
});
