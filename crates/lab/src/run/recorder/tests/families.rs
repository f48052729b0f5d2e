//! Every family of controllers and learners is reproducible, and continues after a stop at any moment.

use std::sync::atomic::{AtomicU32, Ordering};

use rand::RngExt;

use super::*;
use snakes_core::rng::{Purpose, stream};

/// A controller of each family that senses or learns, with a strategy that improves it.
const FAMILIES: [(ControllerKind, StrategyKind); 12] = [
    (ControllerKind::Reflex, StrategyKind::CmaEs),
    (ControllerKind::Modular, StrategyKind::CmaEs),
    (ControllerKind::Central, StrategyKind::Ga),
    (ControllerKind::Ctrnn, StrategyKind::CmaEs),
    (ControllerKind::Rules, StrategyKind::Ga),
    (ControllerKind::LimbNeurons, StrategyKind::Ga),
    (ControllerKind::Grown, StrategyKind::Neat),
    (ControllerKind::Decisions, StrategyKind::QLearning),
    (ControllerKind::Decisions, StrategyKind::Xcs),
    (ControllerKind::JointDecisions, StrategyKind::Xcs),
    (ControllerKind::Decisions, StrategyKind::Zcs),
    (ControllerKind::Gait, StrategyKind::CmaEs),
];

fn plan_of((controller, strategy): (ControllerKind, StrategyKind)) -> RunPlan {
    let mut plan = plan();
    plan.settings.genome.controller = controller;
    plan.settings.evolution.strategy = strategy;
    plan.settings.evolution.generations = 4;
    plan.settings.trial.start_y_m = -3.0;
    plan.settings.trial.duration_s = 1.0;
    plan
}

#[test]
fn every_family_has_the_same_run_hash_on_one_two_and_four_threads() {
    for family in FAMILIES {
        let hash = |threads| finish(Experiment::new(plan_of(family)), threads).run_hash();
        let one = hash(1);
        assert_eq!([hash(2), hash(4)], [one; 2], "{family:?}");
    }
}

#[test]
fn every_family_continues_bit_for_bit_after_a_stop_within_a_generation() {
    for (number, family) in (0..).zip(FAMILIES) {
        let plan = plan_of(family);
        let expected = uninterrupted(&plan).run_hash();
        let mut rng = stream(5, 0, number, Purpose::Birth);
        for _ in 0..20 {
            let stop_after = rng.random_range(1..32_u32);
            let saves = tempfile::tempdir().expect("a folder");
            let source = || source_of(&plan, saves.path());
            let mut first = source().open("a test").expect("opened");
            let (evaluator, control) = (LocalPool::new(1).expect("threads"), RunControl::default());
            let evaluated = AtomicU32::new(0);
            while !first.experiment.is_over() {
                let recorder = &first.recorder;
                let note = |generation, individual, evaluation: &Evaluation| {
                    recorder.record_evaluation(generation, individual, evaluation);
                    if evaluated.fetch_add(1, Ordering::SeqCst) + 1 == stop_after {
                        control.cancel();
                    }
                };
                let run = &mut first.experiment;
                let Ok(report) = run.run_generation_recording(&evaluator, &control, note) else {
                    break;
                };
                first.recorder.record_generation(&first.experiment, &report).expect("kept");
            }
            drop(first);
            let mut again = source().open("a test").expect("opened");
            evolve(&mut again, 100);
            assert_eq!(again.experiment.run_hash(), expected, "{family:?} after {stop_after}");
        }
    }
}

#[test]
fn a_run_of_rules_stopped_within_a_generation_takes_over_the_same_waves() {
    let mut plan = plan();
    plan.settings.evolution.strategy = StrategyKind::Ga;
    plan.settings.evolution.ga.wave_takeover = 1.0;
    plan.settings.genome.controller = ControllerKind::Rules;
    plan.settings.trial.duration_s = 1.0;
    plan.settings.trial.start_y_m = -2.0;
    assert_continues_after_any_stop(&plan);
    let expected = uninterrupted(&plan);
    for known in [1, 4, 8] {
        let saves = tempfile::tempdir().expect("a folder");
        let mut run = source_of(&plan, saves.path()).open("a test").expect("opened");
        evolve(&mut run, 2);
        // The uses of waves in the third generation come from the evaluations that were saved before the stop.
        let (evaluator, control) = (LocalPool::new(1).expect("threads"), RunControl::default());
        let recorder = &run.recorder;
        let note = |generation, individual, evaluation: &Evaluation| {
            if individual < known {
                recorder.record_evaluation(generation, individual, evaluation);
            }
        };
        let report = run.experiment.run_generation_recording(&evaluator, &control, note);
        report.expect("not cancelled");
        drop(run);
        let mut again = source_of(&plan, saves.path()).open("a test").expect("opened");
        assert_eq!(again.reports.len(), 2);
        evolve(&mut again, 6);
        assert_eq!(again.experiment.run_hash(), expected.run_hash(), "{known} known");
        assert_eq!(again.experiment.knowledge(), expected.knowledge());
    }
    plan.settings.evolution.ga.wave_takeover = 0.0;
    assert_ne!(uninterrupted(&plan).run_hash(), expected.run_hash());
}
