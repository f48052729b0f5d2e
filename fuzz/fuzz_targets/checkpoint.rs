//! What a strategy had learned.
#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use snakes_and_stairs::evolve::{RunPlan, Settings, Strategy, StrategyState, Halving};
use snakes_and_stairs::save::parse_checkpoint;

static SETTINGS: LazyLock<Settings> = LazyLock::new(|| {
    let mut settings = Settings::default();
    settings.evolution.population = 3;
    settings
});

fuzz_target!(|text: &str| match parse_checkpoint(Path::new("x"), text, &SETTINGS) {
    Ok((generation, _, StrategyState::Halving { parents })) => {
        // What is accepted can be gone on with.
        let plan = RunPlan::new("x", 1, SETTINGS.clone());
        let children = Halving::resumed(&plan, generation % 100, parents).ask();
        assert_eq!(children.len(), 3);
        for child in children {
            assert_eq!(SETTINGS.trial.check_genome(&child), Ok(()));
        }
    }
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
});
