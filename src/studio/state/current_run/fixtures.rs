//! Runs and champions for tests.

use super::*;
use crate::studio::commands::{Command, RunCommand};
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::ui::notifications::Notices;
use snakes_core::evolve::{RunPlan, Rung, StrategyKind};
use snakes_core::genome::ControllerKind;
use snakes_core::save::{SavesFolder, shipped_champion, store_csv};
use snakes_core::score::evaluate;
use snakes_lab::run::{Experiment, LocalPool, RunControl};

/// Returns the built-in champion, as the file with this number.
pub fn climber(file: usize) -> StagedChampion {
    StagedChampion::from_file(&shipped_champion().expect("well formed"), file, "climber")
}

/// Creates a run of 6 snakes for 0.5 s each, to be saved in this folder.
pub fn small_run(saves: &SavesFolder, seed: u64, generations: u32) -> RunSource {
    let mut settings = Settings::default();
    settings.evolution.population = 6;
    settings.evolution.generations = generations;
    settings.trial.duration_s = 0.5;
    RunSource::in_saves(saves, RunPlan::new("test", seed, settings), ExistingRun::Keep)
}

/// Prepares a run with the report's settings, without starting it.
pub fn prepared_run() -> CurrentRun {
    run_of(RunPlan::new("report", 1, Settings::default()))
}

/// Creates a small MAP-Elites run with two finished generations.
pub fn explored_run() -> CurrentRun {
    evolved_run(StrategyKind::MapElites, ControllerKind::Gait, |_| {})
}

/// Creates a run of NEAT with two finished generations of several species.
pub fn species_run() -> CurrentRun {
    let threshold = |settings: &mut Settings| settings.evolution.neat.species_threshold = 0.25;
    evolved_run(StrategyKind::Neat, ControllerKind::Grown, threshold)
}

/// Creates a run of MAP-Elites over bodies with two finished generations.
pub fn bodies_run() -> CurrentRun {
    let vary = |settings: &mut Settings| settings.genome.bodies.vary = true;
    evolved_run(StrategyKind::BodyMapElites, ControllerKind::Gait, vary)
}

/// Evolves the next generation of an experiment.
pub fn next_generation(experiment: &mut Experiment) -> GenerationReport {
    let pool = LocalPool::new(1).expect("threads");
    experiment.run_generation(&pool, &RunControl::default()).expect("not cancelled")
}

/// Creates a run with two finished generations of 20 snakes for 1 s.
fn evolved_run(
    strategy: StrategyKind,
    controller: ControllerKind,
    edit: impl FnOnce(&mut Settings),
) -> CurrentRun {
    let mut settings = Settings::default();
    settings.evolution.strategy = strategy;
    settings.genome.controller = controller;
    edit(&mut settings);
    settings.evolution.population = 20;
    settings.trial.duration_s = 1.0;
    let plan = RunPlan::new("test", 2, settings);
    let mut experiment = Experiment::new(plan.clone());
    let mut run = run_of(plan);
    for _ in 0..2 {
        let report = next_generation(&mut experiment);
        run.explore(Box::new(Exploration::of(&experiment)));
        run.note_milestone(&report);
        run.reports.push(report);
    }
    run
}

/// Creates the run of `explored_run` with a third generation, whose best snake has landed.
pub fn landed_run() -> CurrentRun {
    let mut run = explored_run();
    let mut report = run.reports.last().expect("two generations").clone();
    report.record.generation += 1;
    report.champion = Some(shipped_champion().expect("well formed").champion);
    report.record.on_landing = 1;
    run.note_milestone(&report);
    run.reports.push(report);
    run
}

/// Evolves a run for this number of generations, and saves them in its folder.
pub fn evolve(run: RunSource, generations: u32) {
    let mut run = run.open("a test").expect("opened");
    for _ in 0..generations {
        let report = next_generation(&mut run.experiment);
        run.recorder.record_generation(&run.experiment, &report).expect("kept");
    }
}

/// Creates the run of `explored_run`, compared with another run of two generations in this folder. The log of the other
/// run can be damaged.
pub fn compared_run(saves: &Path, is_damaged: bool) -> CurrentRun {
    let mut settings = Settings::default();
    settings.evolution.population = 4;
    settings.trial.duration_s = 0.5;
    let plan = RunPlan::new("other", 7, settings);
    let source = RunSource::in_saves(&SavesFolder::find(Some(saves)), plan, ExistingRun::Keep);
    let folder = source.folder.clone();
    evolve(source, 2);
    if is_damaged {
        let nonsense = [vec!["no log".to_owned()]];
        store_csv(&folder.join("log.jsonl"), &nonsense).expect("written");
    }
    let mut run = explored_run();
    run.others.toggle(&folder).expect("a thread");
    while run.others.compared.iter().any(|compared| compared.read.is_none()) {
        run.others.take_in();
    }
    run
}

#[test]
fn a_run_is_added_to_the_comparison_and_removed_again() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = compared_run(saves.path(), false);
    let version = run.version();
    let folder = run.others.compared[0].folder.clone();
    for name in ["a", "b"] {
        run.others.toggle(&saves.path().join(name)).expect("a thread");
    }
    let refusal = run.others.toggle(&saves.path().join("c")).expect_err("full");
    assert!(refusal.contains("room for 3"), "{refusal}");
    run.others.toggle(&folder).expect("taken away");
    assert_eq!(run.others.compared.len(), 2);
    assert_ne!(run.version(), version);
}

fn run_of(plan: RunPlan) -> CurrentRun {
    let folder = std::env::temp_dir().join("snakes-and-stairs-panel-test");
    let saves = SavesFolder::find(Some(&folder));
    run_in(&saves, RunSource::in_saves(&saves, plan, ExistingRun::Keep))
}

/// Prepares a run in the studio that saves in this folder, without starting it.
pub fn run_in(saves: &SavesFolder, run: RunSource) -> CurrentRun {
    CurrentRun::new(&Options::of_test(run, saves.clone()))
}

#[test]
fn a_reset_that_discards_finished_generations_says_so_and_offers_to_resume_them() {
    let mut run = explored_run();
    let folder = run.source.folder.clone();
    let mut notices = Notices::default();
    run.apply(&RunCommand::Reset, &mut notices).expect("allowed");
    let news = "test, seed 2 begins anew: \"Start evolution\" replaces its 2 finished generations.";
    assert_eq!(notices.last(), Some(news));
    let resume = Command::Run(RunCommand::Continue(folder));
    assert_eq!(notices.last_offers(), [("Resume it instead".to_owned(), resume)]);
    // A second reset discards nothing, so it causes no further message.
    run.apply(&RunCommand::Reset, &mut notices).expect("allowed");
    assert_eq!(notices.len(), 1);
}

#[test]
fn elites_and_front_members_are_evaluated_as_they_were_found() {
    for run in [explored_run(), bodies_run()] {
        let archive = run.exploration().and_then(|of| of.archive.as_ref()).expect("MAP-Elites");
        for (cell, elite) in archive.elites() {
            let champion = run.elite(cell).expect("there");
            assert_eq!(champion.evaluation.fitness, elite.fitness);
            if let Some(genome) = run.genome_of(elite.id()) {
                assert_eq!(champion.genome, *genome);
            }
        }
    }
    let run = explored_run();
    let exploration = run.exploration().expect("explored");
    for member in exploration.front.members() {
        let place = IndividualId { generation: member.generation, individual: member.individual };
        let champion = run.front_member(place).expect("there");
        assert_eq!(evaluate(&champion.genome, &champion.trial), member.evaluation);
    }
    assert_eq!(run.front_member(IndividualId { generation: 9, individual: 9 }), None);
    assert_eq!(run.elite(u32::MAX), None);
}

#[test]
fn snakes_of_a_ladders_generation_stand_on_the_stairs_of_its_rung() {
    let mut run = explored_run();
    run.reports[0].record.rung = Some(Rung { rise_m: 0.15, successes: 1 });
    let rise_m = |generation| run.trial_in(generation).stairs.step_rise_m(0);
    assert_eq!([1, 2].map(rise_m), [0.15, 0.5]);
}
