//! What is kept of a run is enough to go on with it, bit for bit, whenever it was stopped.

use super::*;
use crate::evolve::{Founder, Settings, StrategyKind};
use crate::genome::ControllerKind;
use crate::run::{Control, pool};
use crate::save::names_in;
use std::fs;

fn plan() -> RunPlan {
    let mut settings = Settings::default();
    settings.evolution.population = 8;
    settings.evolution.generations = 6;
    settings.trial.duration_s = 0.5;
    RunPlan::new("test", 1, settings)
}

fn source(folder: &Path, earlier: Earlier) -> RunSource {
    RunSource::in_saves(&SavesFolder::find(Some(folder)), plan(), earlier)
}

/// Evolves `generations` of a kept run, or to its end.
fn evolve(run: &mut KeptRun, generations: u32) {
    let pool = pool(2).expect("a pool");
    let control = Control::default();
    for _ in 0..generations {
        if run.experiment.is_over() {
            break;
        }
        let keeper = &run.keeper;
        let note = |g, i, evaluation: &Evaluation| keeper.note(g, i, evaluation);
        let report = run.experiment.run_generation_noting(&pool, &control, note);
        run.keeper.keep(&run.experiment, &report.expect("not cancelled")).expect("kept");
    }
}

fn undisturbed(plan: &RunPlan) -> Experiment {
    let mut experiment = Experiment::new(plan.clone());
    while !experiment.is_over() {
        let pool = pool(1).expect("a pool");
        experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
    }
    experiment
}

#[test]
fn a_run_that_is_stopped_after_any_generation_goes_on_bit_for_bit() {
    for strategy in StrategyKind::ALL {
        for controller in [ControllerKind::Signal, ControllerKind::Gait] {
            let mut plan = plan();
            plan.settings.evolution.strategy = strategy;
            plan.settings.genome.controller = controller;
            stops_and_goes_on(&plan);
        }
    }
}

fn stops_and_goes_on(plan: &RunPlan) {
    let expected = undisturbed(plan);
    let source = |saves: &Path| {
        RunSource::in_saves(&SavesFolder::find(Some(saves)), plan.clone(), Earlier::Keep)
    };
    for stop in 1..=expected.finished() {
        let saves = tempfile::tempdir().expect("a folder");
        let mut first = source(saves.path()).open("a test").expect("opened");
        evolve(&mut first, stop);
        drop(first);
        let mut again = source(saves.path()).open("a test").expect("opened");
        assert_eq!(again.reports.len() as u32, stop);
        let places = |experiment: &Experiment| -> Vec<_> {
            let descent = experiment.descent();
            descent.line.iter().map(|ancestor| (ancestor.place, ancestor.fitness)).collect()
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
fn checkpoints_are_thinned_and_champions_are_not() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut run, 6);
    let files = names_in(run.keeper.folder());
    let of = |prefix: &str| files.iter().filter(|name| name.starts_with(prefix)).count();
    assert_eq!(of("generation-"), 6, "{files:?}");
    let checkpoints: Vec<&String> =
        files.iter().filter(|name| name.starts_with("checkpoint-")).collect();
    let kept = ["1", "2", "4", "5", "6"].map(|number| format!("checkpoint-{number}.ron"));
    assert_eq!(checkpoints, kept.iter().collect::<Vec<_>>());
}

#[test]
fn without_its_latest_checkpoint_a_run_goes_on_from_an_earlier_one() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut run, 4);
    let folder = run.keeper.folder().to_owned();
    drop(run);
    for removed in ["checkpoint-4.ron", "checkpoint-3.ron"] {
        fs::remove_file(folder.join(removed)).expect("removed");
    }
    let mut again = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    assert_eq!(again.reports.len(), 2);
    evolve(&mut again, 6);
    assert_eq!(again.experiment.run_hash(), undisturbed(&plan()).run_hash());
}

#[test]
fn what_is_done_with_an_earlier_run_depends_on_what_is_asked() {
    let saves = tempfile::tempdir().expect("a folder");
    let open = |earlier, generations| {
        let mut run = source(saves.path(), earlier).open("a test").expect("opened");
        let found = run.reports.len();
        evolve(&mut run, generations);
        found
    };
    assert_eq!(open(Earlier::Keep, 2), 0);
    assert_eq!(open(Earlier::Keep, 0), 2, "stopped: it goes on");
    assert_eq!(open(Earlier::Discard, 6), 0, "thrown away");
    assert_eq!(open(Earlier::Keep, 0), 6, "finished, and left so");
    assert_eq!(open(Earlier::Discard, 0), 0, "thrown away again");
}

#[test]
fn a_folder_of_another_run_is_refused() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut source = source(saves.path(), Earlier::Keep);
    source.clone().open("a test").expect("opened");
    source.plan.seed = 2;
    let error = source.open("a test").err().expect("refused").to_string();
    assert!(error.contains("holds another run"), "{error}");
}

#[test]
fn a_run_whose_settings_were_edited_does_not_go_on_as_another() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut run, 2);
    let folder = run.keeper.folder().to_owned();
    drop(run);
    let file = folder.join("run.ron");
    let text = fs::read_to_string(&file).expect("read");
    fs::write(&file, text.replace("seed: 1", "seed: 2")).expect("written");
    let edited = RunSource::in_folder(&folder).expect("well formed").open("a test");
    let error = edited.err().expect("refused").to_string();
    assert!(error.contains("checkpoint-2.ron: plan is") && error.contains("run.ron"), "{error}");
}

#[test]
fn damaged_notes_of_the_generation_under_way_are_no_harm() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut run, 1);
    let folder = run.keeper.folder().to_owned();
    drop(run);
    for damage in [vec![0; 500], b"{}\n{}\n".to_vec(), vec![b'x'; 11 * 1024 * 1024]] {
        fs::write(folder.join("evaluations.jsonl"), damage).expect("written");
        let again = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
        assert_eq!(again.reports.len(), 1);
    }
    let mut again = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut again, 6);
    assert_eq!(again.experiment.run_hash(), undisturbed(&plan()).run_hash());
}

/// Before which generation, which setting, to what.
type MadeBefore = (u32, &'static str, &'static str);

/// What is changed of a run of each method.
const CHANGES: [(StrategyKind, &[MadeBefore]); 6] = [
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

/// Evolves a kept run to its end or to the end of a generation, and makes the changes on the way that it does
/// not know yet.
fn evolve_changing(run: &mut KeptRun, changes: &[MadeBefore], last: u32) {
    while !run.experiment.is_over() && run.experiment.finished() < last {
        let next = run.experiment.finished() + 1;
        for (_, field, value) in changes.iter().filter(|(of, _, _)| *of == next) {
            let field = format!("evolution.{field}");
            let known = run.keeper.changes().iter().any(|known| known.field == field);
            let made = run.keeper.amend(&mut run.experiment, &field, value).expect("allowed");
            assert_ne!(made.is_some(), known, "made once: {field}");
        }
        evolve(run, 1);
    }
}

#[test]
fn a_setting_changed_there_and_back_counts_the_same_after_a_resume() {
    let plan = changing_plan(StrategyKind::Halving);
    let hash = |is_stopped: bool| {
        let saves = tempfile::tempdir().expect("a folder");
        let folder = SavesFolder::find(Some(saves.path()));
        let source = RunSource::in_saves(&folder, plan.clone(), Earlier::Keep);
        let mut run = source.clone().open("a test").expect("opened");
        evolve(&mut run, 1);
        for parents in ["1", "4"] {
            let field = "evolution.halving.parents";
            run.keeper.amend(&mut run.experiment, field, parents).expect("allowed");
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
fn a_changed_run_that_is_stopped_after_any_generation_goes_on_bit_for_bit() {
    for (strategy, changes) in CHANGES {
        let plan = changing_plan(strategy);
        let source = |saves: &Path| {
            RunSource::in_saves(&SavesFolder::find(Some(saves)), plan.clone(), Earlier::Keep)
        };
        let saves = tempfile::tempdir().expect("a folder");
        let mut whole = source(saves.path()).open("a test").expect("opened");
        evolve_changing(&mut whole, changes, u32::MAX);
        let expected = &whole.experiment;
        assert_ne!(expected.run_hash(), undisturbed(&plan).run_hash(), "{strategy}");
        let generations = changes.iter().find(|(_, field, _)| *field == "generations");
        if let Some((_, _, generations)) = generations {
            assert!(expected.finished().to_string() == *generations, "{strategy}");
        }
        for stop in 0..expected.finished() {
            let saves = tempfile::tempdir().expect("a folder");
            let mut first = source(saves.path()).open("a test").expect("opened");
            evolve_changing(&mut first, changes, stop);
            drop(first);
            // Once more, right after the changes of the next generation were written down.
            let mut again = source(saves.path()).open("a test").expect("opened");
            assert_eq!(again.reports.len() as u32, stop);
            for (_, field, value) in changes.iter().filter(|(of, _, _)| *of == stop + 1) {
                let field = format!("evolution.{field}");
                again.keeper.amend(&mut again.experiment, &field, value).expect("allowed");
            }
            drop(again);
            let mut again = source(saves.path()).open("a test").expect("opened");
            evolve_changing(&mut again, changes, u32::MAX);
            let what = format!("{strategy}, stopped after {stop}");
            assert_eq!(again.experiment.run_hash(), expected.run_hash(), "{what}");
            assert_eq!(again.experiment.knowledge(), expected.knowledge(), "{what}");
            assert_eq!(again.keeper.changes(), whole.keeper.changes(), "{what}");
            assert_eq!(again.experiment.next_plan(), expected.next_plan(), "{what}");
        }
    }
}

#[test]
fn a_changed_run_without_its_latest_checkpoints_makes_its_changes_again_at_their_generations() {
    for (strategy, changes) in CHANGES {
        let plan = changing_plan(strategy);
        let saves = tempfile::tempdir().expect("a folder");
        let source =
            RunSource::in_saves(&SavesFolder::find(Some(saves.path())), plan, Earlier::Keep);
        let mut run = source.clone().open("a test").expect("opened");
        evolve_changing(&mut run, changes, u32::MAX);
        let (hash, folder) = (run.experiment.run_hash(), run.keeper.folder().to_owned());
        drop(run);
        for number in 2..=9 {
            let _ = fs::remove_file(folder.join(format!("checkpoint-{number}.ron")));
        }
        let mut again = source.open("a test").expect("opened");
        assert_eq!(again.reports.len(), 1);
        let later = changes.iter().any(|(generation, _, _)| *generation > 2);
        let field = "evolution.generations";
        let refused = again.keeper.amend(&mut again.experiment, field, "30").err();
        assert_eq!(refused.is_some(), later, "{strategy}: nothing before what is ahead");
        if refused.is_some() {
            evolve(&mut again, 30);
            assert_eq!(again.experiment.run_hash(), hash, "{strategy}");
        }
    }
}

#[test]
fn a_finished_run_can_be_made_longer() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut run, 9);
    assert!(run.experiment.is_over());
    let field = "evolution.generations";
    run.keeper.amend(&mut run.experiment, field, "8").expect("allowed").expect("a change");
    assert!(!run.experiment.is_over());
    drop(run);
    let mut again = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut again, 9);
    assert_eq!(again.experiment.finished(), 8);
    let mut plan = plan();
    plan.settings.evolution.generations = 8;
    assert_eq!(again.experiment.run_hash(), undisturbed(&plan).run_hash());
}

#[test]
fn evaluations_from_before_a_change_are_not_taken_for_those_after_it() {
    let plan = changing_plan(StrategyKind::Halving);
    let saves = tempfile::tempdir().expect("a folder");
    let source = RunSource::in_saves(&SavesFolder::find(Some(saves.path())), plan, Earlier::Keep);
    let (field, notes) = ("evolution.halving.mutation_range_nm", "evaluations.jsonl");
    // With the change from the beginning of the second generation on.
    let other = tempfile::tempdir().expect("a folder");
    let mut straight = RunSource { folder: other.path().to_owned(), ..source.clone() }
        .open("a test")
        .expect("opened");
    evolve(&mut straight, 1);
    straight.keeper.amend(&mut straight.experiment, field, "700").expect("allowed");
    evolve(&mut straight, 1);
    // With the notes of another second generation in its way.
    let mut run = source.clone().open("a test").expect("opened");
    evolve(&mut run, 1);
    let mut old = source.clone();
    old.folder = saves.path().join("old");
    fs::create_dir(&old.folder).expect("created");
    for file in names_in(run.keeper.folder()) {
        let from = run.keeper.folder().join(&file);
        fs::copy(from, old.folder.join(&file)).expect("copied");
    }
    let mut old = old.open("a test").expect("opened");
    let noted = std::sync::Mutex::new(Vec::new());
    let note = |g, i, evaluation: &Evaluation| {
        noted.lock().expect("no panic").push((g, i, *evaluation));
    };
    let pool = pool(1).expect("a pool");
    old.experiment.run_generation_noting(&pool, &Control::default(), note).expect("fine");
    for (generation, individual, evaluation) in noted.into_inner().expect("no panic") {
        run.keeper.note(generation, individual, &evaluation);
    }
    let folder = run.keeper.folder().to_owned();
    let of_before = fs::read(folder.join(notes)).expect("noted");
    drop(run);
    // Known when it is opened, forgotten when it is changed; nor are they believed when they come back.
    let mut run = source.clone().open("a test").expect("opened");
    run.keeper.amend(&mut run.experiment, field, "700").expect("allowed");
    drop(run);
    fs::write(folder.join(notes), of_before).expect("written");
    let mut run = source.open("a test").expect("opened");
    evolve(&mut run, 1);
    assert_eq!(run.experiment.run_hash(), straight.experiment.run_hash());
}

#[test]
fn a_run_whose_changes_were_edited_does_not_go_on_as_another() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    evolve(&mut run, 1);
    let field = "evolution.halving.parents";
    run.keeper.amend(&mut run.experiment, field, "2").expect("allowed");
    evolve(&mut run, 2);
    let file = run.keeper.folder().join("changes.jsonl");
    drop(run);
    fs::remove_file(&file).expect("removed");
    let error = source(saves.path(), Earlier::Keep).open("a test").err().expect("refused");
    assert!(error.to_string().contains("checkpoint-3.ron: plan is"), "{error}");
    fs::write(&file, "").expect("written");
    // Whoever begins anew begins with what it began with.
    let anew = source(saves.path(), Earlier::Discard).open("a test").expect("opened");
    assert_eq!((anew.keeper.changes().len(), anew.reports.len()), (0, 0));
    assert!(!file.exists());
}

#[test]
fn a_run_with_a_founder_is_stopped_and_goes_on_bit_for_bit_and_is_another_than_without() {
    let mut rng = crate::rng::stream(9, 1, 0, crate::rng::Purpose::Birth);
    for strategy in StrategyKind::ALL {
        for controller in [ControllerKind::Signal, ControllerKind::Gait] {
            let mut plan = plan();
            plan.settings.evolution.strategy = strategy;
            plan.settings.evolution.generations = 3;
            plan.settings.genome.controller = controller;
            let without = undisturbed(&plan).run_hash();
            let descent = plan.settings.trial.descent();
            let genome = plan.settings.genome.birth(descent, &mut rng);
            let founded = plan.clone().founded_by(Founder::new("x", genome)).expect("fits");
            assert_ne!(undisturbed(&founded).run_hash(), without, "{strategy}");
            stops_and_goes_on(&founded);
            let saves = SavesFolder::find(Some(Path::new("x")));
            assert_ne!(saves.of_run(&founded), saves.of_run(&plan), "a folder of its own");
            // And it is read back from its folder as it was.
            let folder = tempfile::tempdir().expect("a folder");
            let saves = SavesFolder::find(Some(folder.path()));
            let source = RunSource::in_saves(&saves, founded, Earlier::Keep);
            drop(source.clone().open("a test").expect("opened"));
            assert_eq!(RunSource::in_folder(&source.folder).expect("read"), source);
        }
    }
}

#[test]
fn a_crashed_genome_is_saved_so_that_it_can_be_replayed() {
    let saves = tempfile::tempdir().expect("a folder");
    let mut run = source(saves.path(), Earlier::Keep).open("a test").expect("opened");
    let report = run.experiment.run_generation(&pool(1).expect("a pool"), &Control::default());
    let individual = report.expect("not cancelled").champion.expect("somebody was healthy");
    let name = format!("crashed-1-{}.ron", individual.origin.individual);
    let crash = Crash { individual: individual.clone(), message: "overflow".to_owned() };
    let said = run.keeper.keep_crash(&crash);
    assert!(said.contains("(overflow)") && said.contains(&name), "{said}");
    let loaded = crate::save::load_champion(&run.keeper.folder().join(name)).expect("read");
    assert_eq!(loaded.champion.genome, individual.genome);
}
