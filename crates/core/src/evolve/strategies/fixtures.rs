//! Plans, generations and the test of resuming that the tests of several strategies share.

use std::ops::Range;

use crate::evolve::candidate::Candidate;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{Settings, StrategyKind};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::ControllerKind;
use crate::score::Evaluation;

/// Returns the plan of a run with gaits, after further changes of its settings.
pub fn plan(strategy: StrategyKind, change: impl FnOnce(&mut Settings)) -> RunPlan {
    let mut settings = Settings::default();
    settings.evolution.strategy = strategy;
    settings.genome.bodies.vary = strategy.info().varies_bodies;
    settings.genome.controller = ControllerKind::Gait;
    change(&mut settings);
    settings.check().expect("they go together");
    RunPlan::new("test", 1, settings)
}

/// Advances a strategy by a generation whose candidates have this fitness.
pub fn advance(strategy: &mut impl Strategy, fitness: impl Fn(&Candidate) -> f32) {
    let asked = strategy.ask();
    assert_eq!(asked.len(), strategy.population());
    let evaluations: Vec<Evaluation> =
        asked.iter().map(|of| Evaluation::of_fitness(fitness(of))).collect();
    strategy.tell(&asked, &evaluations);
}

/// Asserts that a run goes on with the same bits if it is resumed after any of the generations `finished`. `see` gets each resumed search.
pub fn assert_resumes<S: Strategy>(
    mut expected: S,
    plan: &RunPlan,
    finished: Range<u32>,
    advance: fn(&mut S),
    mut see: impl FnMut(&S),
) {
    let mut before: Option<S> = None;
    for finished in finished {
        let text = ron::to_string(&expected.state()).expect("written");
        let state: StrategyState = ron::from_str(&text).expect("read");
        let resumed = S::resume(plan, finished, &state).expect("its own state");
        see(&resumed);
        assert!(resumed.state() == expected.state());
        if let Some(mut before) = before.replace(resumed) {
            advance(&mut before);
            assert!(before.state() == expected.state());
        }
        advance(&mut expected);
    }
}
