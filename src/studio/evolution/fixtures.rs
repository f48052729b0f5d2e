//! Runs for tests of panels.

use super::*;
use crate::evolve::{RunPlan, StrategyKind};
use crate::genome::ControllerKind;
use crate::run::{Control, Experiment, pool};
use crate::save::SavesFolder;
use crate::studio::Options;

/// A run of the report's settings that has not begun.
pub fn prepared_run() -> Evolution {
    run_of(RunPlan::new("report", 1, Settings::default()))
}

/// A small run of MAP-Elites that has explored for two generations.
pub fn explored_run() -> Evolution {
    let mut settings = Settings::default();
    settings.evolution.strategy = StrategyKind::MapElites;
    settings.evolution.population = 20;
    settings.genome.controller = ControllerKind::Gait;
    settings.trial.duration_s = 1.0;
    let plan = RunPlan::new("test", 1, settings);
    let mut experiment = Experiment::new(plan.clone());
    let pool = pool(1).expect("a pool");
    for _ in 0..2 {
        experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
    }
    let mut run = run_of(plan);
    run.explore(Box::new(Exploration::of(&experiment)));
    run
}

fn run_of(plan: RunPlan) -> Evolution {
    let folder = std::env::temp_dir().join("snakes-and-stairs-panel-test");
    let saves = SavesFolder::find(Some(&folder));
    let run = RunSource::in_saves(&saves, plan, Earlier::Keep);
    let options = Options::of_test(run, saves);
    Evolution::new(Engine::new(&options).expect("threads"))
}

#[test]
fn an_elite_and_one_of_the_front_are_those_that_were_found() {
    let run = explored_run();
    let exploration = run.exploration().expect("explored");
    let archive = exploration.archive.as_ref().expect("MAP-Elites keeps one");
    for (cell, elite) in archive.elites() {
        let champion = run.elite(cell).expect("there");
        assert_eq!(champion.evaluation.fitness, elite.fitness);
        assert_eq!(archive.cell(&champion.evaluation, champion.trial.start_y_m), Some(cell));
    }
    for member in exploration.front.members() {
        let champion = run.front_member(member.generation, member.individual).expect("there");
        assert_eq!(evaluate(&champion.genome, &champion.trial), member.evaluation);
    }
    assert_eq!(run.front_member(9, 9), None);
    assert_eq!(run.elite(u32::MAX), None);
}
