//! Tests of the lessons.

use super::*;
use crate::run::{Experiment, LocalPool, RunControl};
use crate::studio::state::current_run::prepared_run;

/// Evolves the runs of a scene.
fn outcome(sides: &[Side]) -> Vec<Found> {
    sides
        .iter()
        .map(|side| {
            let (plan, threads) = plan(side).expect("allowed");
            let pool = LocalPool::new(threads).expect("threads");
            let mut experiment = Experiment::new(plan);
            let mut found = found(side);
            while !experiment.is_over() {
                let report = experiment.run_generation(&pool, &RunControl::default());
                found.reports.push(report.expect("not cancelled"));
            }
            found.run_hash = Some(experiment.run_hash());
            found
        })
        .collect()
}

/// Final distance of the centre in each lane of a scene, in metres.
fn ends_m(champion: &'static str, lanes: &[Side]) -> Vec<f32> {
    let champions = champions(champion, lanes).expect("they fit");
    let evaluate = |staged: &StagedChampion| evaluate(&staged.champion().genome, staged.trial());
    champions.iter().map(|staged| evaluate(staged).centre_y_m).collect()
}

fn lanes(lesson: usize, scene: usize) -> &'static [Side] {
    let LessonScene::Lanes { lanes, .. } = &LESSONS[lesson].scenes[scene] else { panic!("lanes") };
    lanes
}

fn runs(lesson: usize, scene: usize) -> &'static [Side] {
    let LessonScene::Runs { runs, .. } = &LESSONS[lesson].scenes[scene] else { panic!("runs") };
    runs
}

#[test]
fn the_conclusion_about_friction_is_true() {
    let ends = ends_m("robust", lanes(0, 0));
    let [little, original, much] = ends[..] else { panic!("three lanes") };
    assert!(original > 21.0, "the original stands on the landing");
    assert!(little < original - 10.0 && much < original - 10.0, "{ends:?}");
    let near = ends_m("robust", lanes(0, 1));
    assert!(near.iter().all(|end| *end > 18.0), "{near:?}");
}

#[test]
fn the_conclusion_about_the_frame_rate_is_true() {
    let ends = ends_m("climber", lanes(1, 0));
    assert!(ends[1..].iter().all(|end| (end - ends[0]).abs() > 0.5), "{ends:?}");
}

#[test]
fn the_conclusion_about_limits_is_true() {
    let found = outcome(runs(2, 1));
    let last = |of: &Found| of.reports.last().and_then(|report| report.statistics);
    let [with, without] = &found[..] else { panic!("two runs") };
    let best = |of: &Found| last(of).expect("a healthy snake").best;
    assert!(best(with) > best(without) + 3.0, "{} and {}", best(with), best(without));
    let out = |of: &Found| of.reports.iter().map(|report| report.disqualified).sum::<u32>();
    assert!(out(without) > out(with), "{} and {}", out(without), out(with));
}

#[test]
fn the_conclusion_about_halving_is_true() {
    let found = outcome(runs(3, 1));
    let [halved, kept] = &found[..] else { panic!("two runs") };
    let best = |of: &Found| of.best().expect("a champion").evaluation.fitness;
    assert!(best(kept) > best(halved) + 3.0, "{} and {}", best(kept), best(halved));
}

#[test]
fn the_conclusion_about_bits_is_true() {
    let twice = outcome(runs(4, 1));
    assert_eq!(twice[0].run_hash, twice[1].run_hash);
    let apart = outcome(runs(4, 2));
    assert_ne!(apart[0].run_hash, apart[1].run_hash);
}

#[test]
fn every_scene_of_every_lesson_can_be_shown() {
    for lesson in &LESSONS {
        for scene in lesson.scenes {
            match scene {
                LessonScene::Lanes { lanes, champion, .. } => {
                    champions(champion, lanes).expect(lesson.title);
                }
                LessonScene::Runs { runs, .. } => {
                    runs.iter().for_each(|side| drop(plan(side).expect(lesson.title)));
                }
            }
        }
    }
}

#[test]
fn after_a_lesson_stage_and_settings_are_as_they_were() {
    let mut run = prepared_run();
    let own = champions("climber", &[lanes(0, 0)[1].clone()]).expect("it fits");
    let next = run.next_plan().clone();
    let mut lessons = Lessons::default();
    let stage = |champions: Vec<StagedChampion>| Show { champions, mode: StageMode::Solo };
    let mut history = UndoHistory::default();
    let shown = lessons.begin(0, &mut run, stage(own.clone()), &mut history);
    assert_eq!(shown.expect("allowed").expect("a scene").champions.len(), 3);
    run.set_field("surface.friction", "0.2").expect("allowed");
    lessons.begin(1, &mut run, stage(Vec::new()), &mut history).expect("allowed");
    assert_eq!(*run.next_plan(), next, "the next lesson starts with the user's settings");
    run.set_field("surface.friction", "0.3").expect("allowed");
    let back = lessons.leave(&mut run, &mut history).expect("allowed").expect("the earlier stage");
    assert_eq!(*run.next_plan(), next);
    assert_eq!(back.mode, StageMode::Solo);
    assert_eq!(back.champions.len(), own.len());
    assert!(lessons.view().is_none());
}
