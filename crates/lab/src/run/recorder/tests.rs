//! A saved run continues bit for bit, whenever it was stopped.

mod families;

use super::*;
use crate::run::experiment::tests::finish;
use crate::run::{LocalPool, RunControl};
use snakes_core::evolve::{Founder, Settings, StrategyKind};
use snakes_core::genome::ControllerKind;
use snakes_core::save::{RunSummary, load_log};
use std::fs;

fn plan() -> RunPlan {
    let mut settings = Settings::default();
    settings.evolution.population = 8;
    settings.evolution.generations = 6;
    settings.trial.duration_s = 0.5;
    RunPlan::new("test", 1, settings)
}

fn source(folder: &Path, earlier: ExistingRun) -> RunSource {
    RunSource::in_saves(&SavesFolder::find(Some(folder)), plan(), earlier)
}

/// Returns the source of a run with this plan, which continues if it is there.
fn source_of(plan: &RunPlan, saves: &Path) -> RunSource {
    RunSource::in_saves(&SavesFolder::find(Some(saves)), plan.clone(), ExistingRun::Keep)
}

/// Evolves a recorded run for `generations` or to its end, whichever comes first.
fn evolve(run: &mut RecordedRun, generations: u32) {
    let evaluator = LocalPool::new(2).expect("threads");
    let control = RunControl::default();
    for _ in 0..generations {
        if run.experiment.is_over() {
            break;
        }
        let recorder = &run.recorder;
        let note = |g, i, evaluation: &Evaluation| recorder.record_evaluation(g, i, evaluation);
        let report = run.experiment.run_generation_recording(&evaluator, &control, note);
        run.recorder
            .record_generation(&run.experiment, &report.expect("not cancelled"))
            .expect("kept");
    }
}

/// Returns a folder of saves, and a run in it that has evolved for `generations`.
fn evolved(generations: u32) -> (tempfile::TempDir, RecordedRun) {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), ExistingRun::Keep).open("a test").expect("opened");
    evolve(&mut run, generations);
    (saves, run)
}

/// Returns two kinds of controllers for strategies that allow them, and all allowed kinds for others.
fn controllers_of(strategy: StrategyKind) -> Vec<ControllerKind> {
    let all: Vec<ControllerKind> = strategy.controllers().collect();
    let usual = [ControllerKind::Signal, ControllerKind::Gait];
    if all.contains(&usual[0]) { usual.to_vec() } else { all }
}

fn uninterrupted(plan: &RunPlan) -> Experiment {
    finish(Experiment::new(plan.clone()), 1)
}

/// Returns the sorted names of all files in a folder, including hidden ones.
fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_run_stopped_after_any_generation_continues_bit_for_bit() {
    for strategy in StrategyKind::ALL {
        for controller in controllers_of(strategy) {
            let mut plan = plan();
            plan.settings.evolution.strategy = strategy;
            plan.settings.genome.controller = controller;
            plan.settings.suit_to_strategy();
            assert_continues_after_any_stop(&plan);
        }
    }
}

#[test]
fn the_species_of_all_generations_are_there_after_a_resume() {
    let mut plan = plan();
    plan.settings.evolution.strategy = StrategyKind::Neat;
    plan.settings.genome.controller = ControllerKind::Grown;
    plan.settings.evolution.neat.species_threshold = 0.5;
    let mut expected = Vec::new();
    let mut experiment = Experiment::new(plan.clone());
    let evaluator = LocalPool::new(1).expect("threads");
    while !experiment.is_over() {
        let report = experiment.run_generation(&evaluator, &RunControl::default());
        expected.push(report.expect("not cancelled").record.species);
    }
    assert!(expected.iter().all(|of| of.iter().map(|species| species.size).sum::<u32>() == 8));
    assert!(expected.iter().any(|of| of.len() > 1), "{expected:?}");
    let saves = tempfile::tempdir().expect("a folder");
    let mut path = None;
    for stop in [3, 6] {
        let mut run = source_of(&plan, saves.path()).open("a test").expect("opened");
        let read: Vec<_> = run.reports.iter().map(|report| report.species.clone()).collect();
        assert_eq!(read, expected[..stop - 3]);
        evolve(&mut run, 3);
        path = Some(run.recorder.folder().to_owned());
    }
    let (_, records) = load_log(&path.expect("a run")).expect("read");
    let recorded: Vec<_> = records.into_iter().map(|record| record.species).collect();
    assert_eq!(recorded, expected);
}

fn assert_continues_after_any_stop(plan: &RunPlan) {
    let expected = uninterrupted(plan);
    for stop in 1..=expected.finished() {
        let saves = tempfile::tempdir().expect("a folder");
        let mut first = source_of(plan, saves.path()).open("a test").expect("opened");
        evolve(&mut first, stop);
        drop(first);
        let mut again = source_of(plan, saves.path()).open("a test").expect("opened");
        assert_eq!(again.reports.len() as u32, stop);
        let places = |experiment: &Experiment| -> Vec<_> {
            let ancestry = experiment.ancestry();
            ancestry.line.iter().map(|ancestor| (ancestor.place, ancestor.fitness)).collect()
        };
        evolve(&mut again, 6);
        let what = format!("{}, stopped after {stop}", plan.settings.evolution.strategy);
        assert_eq!(again.experiment.run_hash(), expected.run_hash(), "{what}");
        assert_eq!(again.experiment.best(), expected.best(), "{what}");
        assert_eq!(again.experiment.knowledge(), expected.knowledge(), "{what}");
        assert_eq!(places(&again.experiment), places(&expected), "{what}");
        let parents = |experiment: &Experiment| {
            experiment.generation().map(|generation| generation.parents.clone())
        };
        if stop < expected.finished() {
            assert_eq!(parents(&again.experiment), parents(&expected), "{what}");
        }
    }
}

#[test]
fn old_checkpoints_are_thinned_out_but_champions_are_kept() {
    let (_saves, run) = evolved(6);
    let files = names_in(run.recorder.folder());
    let of = |prefix: &str| files.iter().filter(|name| name.starts_with(prefix)).count();
    assert_eq!(of("generation-"), 6, "{files:?}");
    let checkpoints: Vec<&String> =
        files.iter().filter(|name| name.starts_with("checkpoint-")).collect();
    let kept = ["1", "2", "4", "5", "6"].map(|number| format!("checkpoint-{number}.ron"));
    assert_eq!(checkpoints, kept.iter().collect::<Vec<_>>());
}

#[test]
fn without_its_latest_checkpoint_a_run_continues_from_an_earlier_one() {
    let (saves, run) = evolved(4);
    let folder = run.recorder.folder().to_owned();
    drop(run);
    for removed in ["checkpoint-4.ron", "checkpoint-3.ron"] {
        fs::remove_file(folder.join(removed)).expect("removed");
    }
    let mut again = source(saves.path(), ExistingRun::Keep).open("a test").expect("opened");
    assert_eq!(again.reports.len(), 2);
    evolve(&mut again, 6);
    assert_eq!(again.experiment.run_hash(), uninterrupted(&plan()).run_hash());
}

#[test]
fn an_earlier_run_is_continued_or_discarded_as_requested() {
    let saves = tempfile::tempdir().expect("a folder");
    let open = |earlier, generations| {
        let mut run = source(saves.path(), earlier).open("a test").expect("opened");
        let found = run.reports.len();
        evolve(&mut run, generations);
        found
    };
    assert_eq!(open(ExistingRun::Keep, 2), 0);
    assert_eq!(open(ExistingRun::Keep, 0), 2, "stopped: it goes on");
    assert_eq!(open(ExistingRun::Discard, 6), 0, "thrown away");
    assert_eq!(open(ExistingRun::Keep, 0), 6, "finished, and left so");
    assert_eq!(open(ExistingRun::Discard, 0), 0, "thrown away again");
}

#[test]
fn a_folder_of_another_run_is_refused() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut source = source(saves.path(), ExistingRun::Keep);
    source.clone().open("a test").expect("opened");
    source.plan.seed = 2;
    let error = source.open("a test").err().expect("refused").to_string();
    assert!(error.contains("holds another run"), "{error}");
}

#[test]
fn a_run_whose_plan_was_edited_is_refused() {
    let (_saves, run) = evolved(2);
    let folder = run.recorder.folder().to_owned();
    drop(run);
    let file = folder.join("run.ron");
    let text = fs::read_to_string(&file).expect("read");
    fs::write(&file, text.replace("seed: 1", "seed: 2")).expect("written");
    let edited = RunSource::in_folder(&folder).expect("well formed").open("a test");
    let error = edited.err().expect("refused").to_string();
    assert!(error.contains("checkpoint-2.ron: plan is") && error.contains("run.ron"), "{error}");
}

#[test]
fn damaged_evaluations_of_the_current_generation_are_ignored() {
    let (saves, run) = evolved(1);
    let folder = run.recorder.folder().to_owned();
    drop(run);
    for damage in [vec![0; 500], b"{}\n{}\n".to_vec(), vec![b'x'; 11 * 1024 * 1024]] {
        fs::write(folder.join("evaluations.jsonl"), damage).expect("written");
        let again = source(saves.path(), ExistingRun::Keep).open("a test").expect("opened");
        assert_eq!(again.reports.len(), 1);
    }
    let mut again = source(saves.path(), ExistingRun::Keep).open("a test").expect("opened");
    evolve(&mut again, 6);
    assert_eq!(again.experiment.run_hash(), uninterrupted(&plan()).run_hash());
}

/// A generation, the setting that changes before it, and the new value.
type PlannedChange = (u32, &'static str, &'static str);

/// Changes of settings in a run of each strategy.
const CHANGES: [(StrategyKind, &[PlannedChange]); 6] = [
    (
        StrategyKind::Halving,
        &[
            (2, "halving.parents", "2"),
            (3, "halving.mutation_range_nm", "200"),
            (5, "halving.mutation_decay", "0.9"),
            (5, "population", "5"),
            (6, "generations", "8"),
        ],
    ),
    (StrategyKind::Ga, &[(2, "ga.elites", "0"), (3, "population", "11"), (4, "generations", "5")]),
    (StrategyKind::CmaEs, &[(3, "generations", "9")]),
    (
        StrategyKind::MapElites,
        &[(2, "map_elites.cma_share", "0.9"), (4, "population", "12"), (4, "generations", "7")],
    ),
    (
        StrategyKind::Novelty,
        &[(2, "novelty.archive_limit", "3"), (4, "novelty.weight", "1"), (5, "ga.elites", "0")],
    ),
    (StrategyKind::Random, &[(1, "population", "5"), (4, "generations", "8")]),
];

fn changing_plan(strategy: StrategyKind) -> RunPlan {
    let mut plan = plan();
    plan.settings.evolution.strategy = strategy;
    plan.settings.genome.controller = ControllerKind::Gait;
    plan
}

/// Changes a setting of a recorded run, given by its full dotted name, to the value in `text`.
fn change(
    run: &mut RecordedRun,
    field: &str,
    text: &str,
) -> Result<Option<SettingChange>, ChangeError> {
    let next = run.experiment.finished() + 1;
    let value = run.experiment.next_plan().change_of_text(next, field, text)?.value;
    run.recorder.change_setting(&mut run.experiment, field, value)
}

/// Evolves a recorded run to its end or to the end of generation `last`, and makes the changes that it does not have yet.
fn evolve_changing(run: &mut RecordedRun, changes: &[PlannedChange], last: u32) {
    while !run.experiment.is_over() && run.experiment.finished() < last {
        let next = run.experiment.finished() + 1;
        for (_, field, value) in changes.iter().filter(|(of, _, _)| *of == next) {
            let field = format!("evolution.{field}");
            let known = run.recorder.changes().iter().any(|known| known.field == field);
            let made = change(run, &field, value).expect("allowed");
            assert_ne!(made.is_some(), known, "made once: {field}");
        }
        evolve(run, 1);
    }
}

#[test]
fn a_setting_changed_there_and_back_has_the_same_effect_after_a_resume() {
    let plan = changing_plan(StrategyKind::Halving);
    let hash = |is_stopped: bool| {
        let saves = tempfile::tempdir().expect("a folder");
        let source = source_of(&plan, saves.path());
        let mut run = source.clone().open("a test").expect("opened");
        evolve(&mut run, 1);
        for parents in ["1", "4"] {
            let field = "evolution.halving.parents";
            change(&mut run, field, parents).expect("allowed");
        }
        if is_stopped {
            drop(run);
            run = source.open("a test").expect("opened");
        }
        evolve(&mut run, u32::MAX);
        run.experiment.run_hash()
    };
    assert_eq!(hash(true), hash(false));
}

#[test]
fn a_changed_run_stopped_after_any_generation_continues_bit_for_bit() {
    for (strategy, changes) in CHANGES {
        let plan = changing_plan(strategy);
        let source = |saves: &Path| source_of(&plan, saves);
        let saves = tempfile::tempdir().expect("a folder");
        let mut whole = source(saves.path()).open("a test").expect("opened");
        evolve_changing(&mut whole, changes, u32::MAX);
        let expected = &whole.experiment;
        assert_ne!(expected.run_hash(), uninterrupted(&plan).run_hash(), "{strategy}");
        let generations = changes.iter().find(|(_, field, _)| *field == "generations");
        if let Some((_, _, generations)) = generations {
            assert!(expected.finished().to_string() == *generations, "{strategy}");
        }
        for stop in 0..expected.finished() {
            let saves = tempfile::tempdir().expect("a folder");
            let mut first = source(saves.path()).open("a test").expect("opened");
            evolve_changing(&mut first, changes, stop);
            drop(first);
            // Stop again right after the changes of the next generation were saved.
            let mut again = source(saves.path()).open("a test").expect("opened");
            assert_eq!(again.reports.len() as u32, stop);
            for (_, field, value) in changes.iter().filter(|(of, _, _)| *of == stop + 1) {
                let field = format!("evolution.{field}");
                change(&mut again, &field, value).expect("allowed");
            }
            drop(again);
            let mut again = source(saves.path()).open("a test").expect("opened");
            evolve_changing(&mut again, changes, u32::MAX);
            let what = format!("{strategy}, stopped after {stop}");
            assert_eq!(again.experiment.run_hash(), expected.run_hash(), "{what}");
            assert_eq!(again.experiment.knowledge(), expected.knowledge(), "{what}");
            assert_eq!(again.recorder.changes(), whole.recorder.changes(), "{what}");
            assert_eq!(again.experiment.next_plan(), expected.next_plan(), "{what}");
        }
    }
}

#[test]
fn a_changed_run_without_its_latest_checkpoints_repeats_its_changes_at_their_generations() {
    for (strategy, changes) in CHANGES {
        let saves = tempfile::tempdir().expect("a folder");
        let source = source_of(&changing_plan(strategy), saves.path());
        let mut run = source.clone().open("a test").expect("opened");
        evolve_changing(&mut run, changes, u32::MAX);
        let (hash, folder) = (run.experiment.run_hash(), run.recorder.folder().to_owned());
        drop(run);
        for number in 2..=9 {
            let _ = fs::remove_file(folder.join(format!("checkpoint-{number}.ron")));
        }
        let mut again = source.open("a test").expect("opened");
        assert_eq!(again.reports.len(), 1);
        let later = changes.iter().any(|(generation, _, _)| *generation > 2);
        let field = "evolution.generations";
        let refused = change(&mut again, field, "30").err();
        assert_eq!(refused.is_some(), later, "{strategy}: nothing before what is ahead");
        if refused.is_some() {
            evolve(&mut again, 30);
            assert_eq!(again.experiment.run_hash(), hash, "{strategy}");
        }
    }
}

#[test]
fn a_finished_run_can_be_made_longer() {
    let (saves, mut run) = evolved(9);
    assert!(run.experiment.is_over());
    let field = "evolution.generations";
    change(&mut run, field, "8").expect("allowed").expect("a change");
    assert!(!run.experiment.is_over());
    drop(run);
    let mut again = source(saves.path(), ExistingRun::Keep).open("a test").expect("opened");
    evolve(&mut again, 9);
    assert_eq!(again.experiment.finished(), 8);
    let mut plan = plan();
    plan.settings.evolution.generations = 8;
    assert_eq!(again.experiment.run_hash(), uninterrupted(&plan).run_hash());
}

#[test]
fn evaluations_from_before_a_change_are_not_reused_after_it() {
    let saves = tempfile::tempdir().expect("a folder");
    let source = source_of(&changing_plan(StrategyKind::Halving), saves.path());
    let (field, notes) = ("evolution.halving.mutation_range_nm", "evaluations.jsonl");
    // One run has the change from the beginning of its second generation.
    let other = tempfile::tempdir().expect("a folder");
    let mut straight = RunSource { folder: other.path().to_owned(), ..source.clone() }
        .open("a test")
        .expect("opened");
    evolve(&mut straight, 1);
    change(&mut straight, field, "700").expect("allowed");
    evolve(&mut straight, 1);
    // Another run has saved evaluations of its second generation from before the change.
    let mut run = source.clone().open("a test").expect("opened");
    evolve(&mut run, 1);
    let mut old = source.clone();
    old.folder = saves.path().join("old");
    fs::create_dir(&old.folder).expect("created");
    for file in names_in(run.recorder.folder()) {
        let from = run.recorder.folder().join(&file);
        fs::copy(from, old.folder.join(&file)).expect("copied");
    }
    let mut old = old.open("a test").expect("opened");
    let noted = std::sync::Mutex::new(Vec::new());
    let note = |g, i, evaluation: &Evaluation| {
        noted.lock().expect("no panic").push((g, i, *evaluation));
    };
    let evaluator = LocalPool::new(1).expect("threads");
    old.experiment
        .run_generation_recording(&evaluator, &RunControl::default(), note)
        .expect("fine");
    for (generation, individual, evaluation) in noted.into_inner().expect("no panic") {
        run.recorder.record_evaluation(generation, individual, &evaluation);
    }
    let folder = run.recorder.folder().to_owned();
    let of_before = fs::read(folder.join(notes)).expect("noted");
    drop(run);
    // The saved evaluations are known after opening. The change drops them, even when their file is restored.
    let mut run = source.clone().open("a test").expect("opened");
    change(&mut run, field, "700").expect("allowed");
    drop(run);
    fs::write(folder.join(notes), of_before).expect("written");
    let mut run = source.open("a test").expect("opened");
    evolve(&mut run, 1);
    assert_eq!(run.experiment.run_hash(), straight.experiment.run_hash());
}

#[test]
fn a_run_whose_changes_were_edited_is_refused() {
    let (saves, mut run) = evolved(1);
    let field = "evolution.halving.parents";
    change(&mut run, field, "2").expect("allowed");
    evolve(&mut run, 2);
    let file = run.recorder.folder().join("changes.jsonl");
    drop(run);
    fs::remove_file(&file).expect("removed");
    let error = source(saves.path(), ExistingRun::Keep).open("a test").err().expect("refused");
    assert!(error.to_string().contains("checkpoint-3.ron: plan is"), "{error}");
    fs::write(&file, "").expect("written");
    // A run that begins again has its first settings.
    let anew = source(saves.path(), ExistingRun::Discard).open("a test").expect("opened");
    assert_eq!((anew.recorder.changes().len(), anew.reports.len()), (0, 0));
    assert!(!file.exists());
}

#[test]
fn a_run_with_a_founder_continues_bit_for_bit_and_differs_from_one_without() {
    let mut rng = snakes_core::rng::stream(9, 1, 0, snakes_core::rng::Purpose::Birth);
    for strategy in StrategyKind::ALL {
        for controller in controllers_of(strategy) {
            let mut plan = plan();
            plan.settings.evolution.strategy = strategy;
            plan.settings.evolution.generations = 3;
            plan.settings.genome.controller = controller;
            plan.settings.suit_to_strategy();
            let without = uninterrupted(&plan).run_hash();
            let shape = plan.settings.trial.genome_shape();
            let genome = plan.settings.genome.random_genome(shape, &mut rng);
            let founded = plan.clone().starting_from(Founder::new("x", genome)).expect("fits");
            assert_ne!(uninterrupted(&founded).run_hash(), without, "{strategy}");
            assert_continues_after_any_stop(&founded);
            let saves = SavesFolder::find(Some(Path::new("x")));
            assert_ne!(saves.of_run(&founded), saves.of_run(&plan), "a folder of its own");
            // The plan is read back unchanged from its folder.
            let folder = tempfile::tempdir().expect("a folder");
            let source = source_of(&founded, folder.path());
            drop(source.clone().open("a test").expect("opened"));
            assert_eq!(RunSource::in_folder(&source.folder).expect("read"), source);
        }
    }
}

#[test]
fn a_crashed_genome_is_saved_so_that_it_can_be_replayed() {
    let (_saves, mut run) = evolved(0);
    let report =
        run.experiment.run_generation(&LocalPool::new(1).expect("threads"), &RunControl::default());
    let individual = report.expect("not cancelled").champion.expect("one is healthy");
    let name = format!("crashed-1-{}.ron", individual.origin.individual);
    let crash = Crash { individual: individual.clone(), message: "overflow".to_owned() };
    let said = run.recorder.record_crash(&crash);
    assert!(said.contains("(overflow)") && said.contains(&name), "{said}");
    let loaded = snakes_core::save::load_champion(&run.recorder.folder().join(name)).expect("read");
    assert_eq!(loaded.champion.genome, individual.genome);
}

#[test]
fn the_list_of_runs_leaves_out_other_folders() {
    let folder = tempfile::tempdir().expect("a folder");
    let saves = SavesFolder::find(Some(folder.path()));
    for seed in [2, 1] {
        let source = RunSource::in_saves(&saves, RunPlan { seed, ..plan() }, ExistingRun::Keep);
        source.open("a test").expect("opened");
    }
    fs::create_dir(folder.path().join("no run")).expect("created");
    fs::create_dir(folder.path().join("damaged")).expect("created");
    fs::write(folder.path().join("damaged/run.ron"), "(").expect("written");
    let runs = saves.runs();
    assert_eq!(runs.iter().map(|run| run.plan.seed).collect::<Vec<u64>>(), [1, 2]);
    assert!(runs.iter().all(RunSummary::is_stopped));
}

#[test]
fn the_log_alone_can_be_read_and_damage_to_it_is_reported() {
    let (saves, run) = evolved(1);
    let folder = run.recorder.folder().to_owned();
    let (found, records) = load_log(&folder).expect("a run");
    assert_eq!((found, records.len()), (plan(), 1));
    let log = folder.join("log.jsonl");
    let text = fs::read_to_string(&log).expect("read");
    fs::write(&log, text.replace("\"evaluations\":8", "\"evaluations\":9")).expect("written");
    let problem = load_log(&folder).expect_err("damaged").to_string();
    assert!(problem.contains("log.jsonl: damaged"), "{problem}");
    let problem = load_log(&saves.path().join("none")).expect_err("nothing there").to_string();
    assert!(problem.contains("cannot be read"), "{problem}");
}
