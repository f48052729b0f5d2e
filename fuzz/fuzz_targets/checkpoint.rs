//! What a strategy had learned.
#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use snakes_and_stairs::evolve::{Halving, RunPlan, Settings, Strategy, StrategyState};
use snakes_and_stairs::save::{fingerprint, parse_checkpoint};

static PLAN: LazyLock<(RunPlan, String)> = LazyLock::new(|| {
    let mut settings = Settings::default();
    settings.evolution.population = 3;
    let plan = RunPlan::new("x", 1, settings);
    let fingerprint = fingerprint(&plan);
    (plan, fingerprint)
});

fuzz_target!(|text: &str| match parse_checkpoint(
    Path::new("x"),
    &text.replace("PLAN", &PLAN.1),
    &PLAN.0
) {
    Ok((generation, _, StrategyState::Halving { parents })) => {
        // What is accepted can be gone on with.
        let children = Halving::resumed(&PLAN.0, generation % 100, parents).ask();
        assert_eq!(children.len(), 3);
        for child in children {
            assert_eq!(PLAN.0.settings.trial.check_genome(&child), Ok(()));
        }
    }
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
});
