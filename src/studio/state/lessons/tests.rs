//! Tests of the lessons.

use std::sync::OnceLock;

use super::lesson::Shows;
use super::*;
use crate::studio::stage::playback::REST_S;
use crate::studio::state::current_run::prepared_run;
use snakes_core::evolve::Champion;
use snakes_core::save::load_preset;
use snakes_core::score::{Evaluation, evaluate};
use snakes_lab::run::{Experiment, LocalPool, RunControl};

/// Returns the results of a scene, which are computed once.
pub(super) fn result(lesson: usize, scene: usize) -> &'static Progress {
    static KNOWN: [[OnceLock<Progress>; 3]; LESSONS.len()] =
        [const { [const { OnceLock::new() }; 3] }; LESSONS.len()];
    let LessonScene { shows, question, sides, .. } = &LESSONS[lesson].scenes[scene];
    KNOWN[lesson][scene].get_or_init(|| match shows {
        Shows::Champion(champion) => {
            let staged = champions(champion, sides).expect("they fit");
            let of = |staged: &StagedChampion| (staged.label().to_owned(), staged.shown_result());
            let plays = match question.as_ref().map(|question| question.asks) {
                Some(Asks::PlaybackSpeed) => played(&staged[0], &[1.0, 4.0]),
                _ => Plays::default(),
            };
            let trial = Some(staged[0].trial().clone());
            Progress { lanes: staged.iter().map(of).collect(), plays, trial, ..Progress::default() }
        }
        Shows::Runs(common) => Progress { runs: outcome(common, sides), ..Progress::default() },
    })
}

/// Plays a snake to its end at each of these speeds, at 60 frames per second.
fn played(staged: &StagedChampion, speeds: &[f32]) -> Plays {
    let (mut plays, mut playback) = (Plays::default(), Playback::default());
    for speed in speeds {
        let mut lane = Lane::new(staged.clone(), 0);
        playback.set_speed(*speed);
        playback.restart();
        while !lane.replay.is_over() {
            playback.pass(1.0 / 60.0, 1.0, lane.end_s(), REST_S);
            lane.show(playback.time_s(), None, 1000).expect("it simulates");
            plays.follow_stage(&playback, &[&lane]);
        }
    }
    plays
}

/// Evolves the runs of a scene, and returns their results.
fn outcome(common: &lesson::CommonPlan, sides: &[lesson::Side]) -> Vec<Found> {
    sides
        .iter()
        .map(|side| {
            let (plan, threads) = plan(common, side).expect("allowed");
            let pool = LocalPool::new(threads).expect("threads");
            let mut experiment = Experiment::new(plan);
            let mut found = Found::of(side.name);
            while !experiment.is_over() {
                let report = experiment.run_generation(&pool, &RunControl::default());
                found.reports.push(report.expect("not cancelled"));
            }
            found.run_hash = Some(experiment.run_hash());
            found
        })
        .collect()
}

/// Returns the final distance of the middle limb in each lane of a scene, in metres.
fn ends_m(lesson: usize, scene: usize) -> Vec<f32> {
    result(lesson, scene).lanes.iter().map(|(_, evaluation)| evaluation.centre_y_m).collect()
}

/// Returns, for each lane of a scene, the number of steps that the snake climbed and whether it is on the landing.
fn places(lesson: usize, scene: usize) -> Vec<(u32, bool)> {
    let LessonScene { shows: Shows::Champion(champion), sides, .. } =
        &LESSONS[lesson].scenes[scene]
    else {
        panic!("no lanes")
    };
    let staged = champions(champion, sides).expect("they fit");
    let place = |(staged, (_, of)): (&StagedChampion, &(String, Evaluation))| {
        let climbed = of.behaviour.expect("measured").steps_climbed;
        (climbed, of.is_on_landing(&staged.trial().stairs))
    };
    staged.iter().zip(&result(lesson, scene).lanes).map(place).collect()
}

/// Returns the best champion of a run.
fn best(found: &Found) -> &Champion {
    found.best().expect("a champion")
}

/// Returns the right answer to a scene's question.
fn answer(lesson: usize, scene: usize) -> &'static str {
    let shown = &LESSONS[lesson].scenes[scene];
    let asks = shown.question.as_ref().expect("a question").asks;
    shown.answers()[result(lesson, scene).truth(asks).expect("known").answer]
}

#[test]
fn the_conclusion_about_friction_is_true() {
    let ends = ends_m(0, 0);
    let [little, original, much] = ends[..] else { panic!("three lanes") };
    assert!(original > 21.0, "the original stands on the landing");
    assert!(little < original - 10.0 && much < original - 10.0, "{ends:?}");
    assert_eq!(answer(0, 0), "original");
    let near = ends_m(0, 1);
    let landing_m = robust().trial().stairs.landing_y_m();
    assert!(near.iter().all(|end| *end > landing_m), "{near:?}");
    assert!(near[0] < near[1] && near[2] < near[1], "{near:?}");
    let landed = &result(0, 1).lanes[1].1;
    assert!(landed.fitness < landed.centre_y_m, "it does not count the whole way");
}

/// Returns the snake of the first lesson.
fn robust() -> StagedChampion {
    let original = [LESSONS[0].scenes[0].sides[1].clone()];
    champions("robust", &original).expect("it fits").remove(0)
}

#[test]
fn the_smallest_friction_that_still_lands_is_the_stated_one() {
    let staged = robust();
    let lands = |tenths: u32| {
        let mut trial = staged.trial().clone();
        trial.surface.friction = tenths as f32 / 10.0;
        evaluate(&staged.champion().genome, &trial).is_on_landing(&trial.stairs)
    };
    let least = (1..10).find(|tenths| lands(*tenths)).expect("0.7 lands");
    let stated = format!("0.{least} is the smallest friction");
    assert!(LESSONS[0].worksheet.contains(&stated), "{stated}");
    assert!(!LESSONS[0].conclusion.contains("smallest"), "the reader is to find it");
}

#[test]
fn the_conclusion_about_the_frame_rate_is_true() {
    let ends = ends_m(7, 0);
    assert!(ends[2] < ends[0] - 10.0, "{ends:?}");
    assert_eq!(answer(7, 0), "120 physics steps/s");
    // The mean over the last half second, of which it is on the stairs for a moment.
    let fallen = result(7, 0).lanes[1].1.fitness;
    assert!((3.0..10.0).contains(&fallen), "hardly further than the first riser: {fallen}");
    for side in LESSONS[7].scenes[0].sides {
        let staged = champions("robust", std::slice::from_ref(side)).expect("it fits").remove(0);
        let seen = evaluate(&staged.champion().genome, staged.trial());
        assert!(seen.is_on_landing(&staged.trial().stairs), "{}", side.name);
    }
    assert_eq!(answer(7, 1), "yes, in every digit");
}

#[test]
fn the_conclusion_about_limits_is_true() {
    let [with, without] = &result(5, 1).runs[..] else { panic!("two runs") };
    let last = |of: &Found| of.reports.last().and_then(|report| report.statistics);
    let [most, least] = [with, without].map(|of| last(of).expect("a healthy snake").best);
    assert!(most > least + 3.0, "{most} and {least}");
    let out = |of: &Found| of.reports.iter().map(|report| report.disqualified).sum::<u32>();
    assert!(out(without) > out(with), "{} and {}", out(without), out(with));
    assert_eq!(answer(5, 1), "with limits");
    let (reached, said) = (best(with).reached(), "lies beside step 2 of the stairs");
    assert!(reached.ends_with(said), "as the finding says: {reached}");
}

#[test]
fn the_conclusion_about_halving_is_true() {
    let [halved, kept] = &result(1, 1).runs[..] else { panic!("two runs") };
    let [halved, kept] = [halved, kept].map(|of| best(of).evaluation.fitness);
    assert!(kept > halved + 3.0, "{kept} and {halved}");
    assert_eq!(answer(1, 1), "range shrinks slowly");
}

#[test]
fn the_conclusion_about_bits_is_true() {
    assert_eq!(answer(8, 1), "the same hash");
    assert_eq!(answer(8, 2), "different hashes");
}

#[test]
fn the_conclusion_about_one_motion_for_all_stairs_is_true() {
    assert_eq!(places(2, 0), [(10, true), (10, true), (5, false)], "as the finding says");
    assert_eq!(places(2, 1), [(10, true), (10, true)]);
    assert_eq!([answer(2, 0), answer(2, 1)], ["original", "both within 1 m of each other"]);
}

#[test]
fn the_conclusion_about_the_senses_is_true() {
    assert_eq!(answer(3, 0), "both within 1 m of each other");
    let sight = &result(3, 0).lanes;
    assert_eq!(sight[0].1.trace_hash, sight[1].1.trace_hash, "exactly alike");
    assert_eq!(answer(3, 1), "original");
    let [(all, _), (touchless, _), (dizzy, _)] = places(3, 1)[..] else { panic!("three lanes") };
    assert_eq!(all, 10);
    assert!(touchless + 2 < dizzy && dizzy < all, "{touchless} and {dizzy} steps");
}

#[test]
fn the_conclusion_about_protection_is_true() {
    assert_eq!([answer(6, 0), answer(6, 1)], ["original", "with protection"]);
    let [original, more, less] = ends_m(6, 0)[..] else { panic!("three lanes") };
    let first_riser_m = champions("tapered", &[lesson::side("original", &[])]).expect("it fits")[0]
        .trial()
        .stairs
        .first_riser_y_m;
    assert!(original > 23.0 && more.max(less) < first_riser_m, "{original}, {more}, {less}");
    let [with, without] = &result(6, 1).runs[..] else { panic!("two runs") };
    assert!(with.late_body_changes() >= 2 && without.late_body_changes() == 0);
    let fitness = |of: &Found| best(of).evaluation.fitness;
    assert!(fitness(with) < fitness(without), "as the finding says");
}

#[test]
fn the_conclusion_about_a_ladder_is_true() {
    assert_eq!(places(4, 0), [(10, true), (0, false)]);
    assert_eq!([answer(4, 0), answer(4, 1)], ["steps 0.2 m high", "by a ladder"]);
    let [direct, ladder] = &result(4, 1).runs[..] else { panic!("two runs") };
    let goal = &load_preset("house").expect("shipped").settings.trial.stairs;
    let lands = |of: &Found| best(of).evaluation.is_on_landing(goal);
    assert_eq!(best(ladder).trial.stairs, *goal, "the ladder has grown to its end");
    assert!(lands(ladder) && !lands(direct));
    let reached = best(direct).reached();
    assert!(reached.ends_with("climbs 4 steps"), "as the finding says: {reached}");
}

#[test]
fn after_a_lesson_settings_are_as_they_were() {
    let mut run = prepared_run();
    let next = run.plan_next.clone();
    let mut lessons = Lessons::default();
    let mut history = UndoHistory::default();
    let shown = lessons.begin(0, &mut run, &mut history);
    assert_eq!(shown.expect("allowed").expect("a scene").champions.len(), 3);
    run.set_field("surface.friction", "0.2").expect("allowed");
    lessons.begin(1, &mut run, &mut history).expect("allowed");
    assert_eq!(run.plan_next, next, "the next lesson starts with the user's settings");
    run.set_field("surface.friction", "0.3").expect("allowed");
    lessons.leave(&mut run, &mut history).expect("allowed");
    assert_eq!(run.plan_next, next);
    assert!(lessons.view().is_none());
}

/// Begins the first lesson. Returns the lessons and a prepared run.
fn first_lesson() -> (Lessons, CurrentRun) {
    let (mut lessons, mut run) = (Lessons::default(), prepared_run());
    lessons.begin(0, &mut run, &mut UndoHistory::default()).expect("allowed");
    (lessons, run)
}

fn apply(lessons: &mut Lessons, run: &mut CurrentRun, command: LessonCommand) -> Option<Show> {
    lessons.apply(&command, run, &mut UndoHistory::default()).expect("allowed")
}

#[test]
fn a_race_waits_for_a_guess_and_starts_after_it() {
    let (mut lessons, mut run) = first_lesson();
    assert!(lessons.awaits_guess() && lessons.hides_result());
    let race = apply(&mut lessons, &mut run, LessonCommand::Guess(1)).expect("a race");
    assert_eq!(race.champions.len(), 3);
    assert!(!lessons.awaits_guess());
    assert!(lessons.hides_result(), "the race was not watched yet");
    apply(&mut lessons, &mut run, LessonCommand::Guess(0));
    assert_eq!(lessons.view().expect("begun").progress.guess, Some(1), "a first guess stands");
}

#[test]
fn the_fitness_of_a_snake_is_that_of_the_trial_on_the_stage() {
    // The record of this snake is the mean of four trials.
    for (name, result) in &result(3, 1).lanes {
        let counted_m = result.centre_y_m.min(26.0);
        assert!((result.fitness - counted_m).abs() < 2.0, "{name}: {result:?}");
    }
}

#[test]
fn the_result_appears_once_all_lanes_of_the_scene_were_watched_to_their_end() {
    let (mut lessons, mut run) = first_lesson();
    let is_revealed = |lessons: &Lessons| lessons.view().expect("begun").progress.is_revealed;
    let names = ["friction 0.1", "original", "friction 5"].map(Some);
    for ended in [&[][..], &names[..2], &[Some("Generation 3")], &[names[0], None, names[2]]] {
        lessons.see(ended);
        assert!(!is_revealed(&lessons), "{ended:?}");
    }
    lessons.see(&names);
    assert!(is_revealed(&lessons), "watched without a guess");
    assert!(!lessons.hides_result());
    assert!(!lessons.view().expect("begun").shows_conclusion, "another experiment is to come");
    // Another scene does not inherit the result.
    apply(&mut lessons, &mut run, LessonCommand::ShowScene(1));
    assert!(!is_revealed(&lessons) && lessons.awaits_guess());
    apply(&mut lessons, &mut run, LessonCommand::ShowScene(0));
    assert!(is_revealed(&lessons), "kept");
}

#[test]
fn runs_start_only_after_a_guess_and_finished_ones_are_not_repeated() {
    let (mut lessons, mut run) = first_lesson();
    apply(&mut lessons, &mut run, LessonCommand::Begin(8));
    assert!(apply(&mut lessons, &mut run, LessonCommand::ShowScene(1)).is_none());
    assert!(!lessons.view().expect("begun").is_busy && lessons.awaits_guess());
    apply(&mut lessons, &mut run, LessonCommand::Guess(0));
    assert!(lessons.view().expect("begun").is_busy);
    apply(&mut lessons, &mut run, LessonCommand::ShowResult);
    assert!(!lessons.view().expect("begun").progress.is_revealed, "not known yet");
    let race = loop {
        if let Some(show) = lessons.take_in().expect("the runs succeed") {
            break show;
        }
    };
    assert_eq!(race.champions.len(), 2);
    let view = lessons.view().expect("begun");
    assert!(view.progress.is_revealed && !view.shows_conclusion);
    assert!(apply(&mut lessons, &mut run, LessonCommand::ShowScene(1)).is_some());
    assert!(!lessons.view().expect("begun").is_busy);
}

#[test]
fn watching_the_snake_alone_shows_no_conclusion_and_results_need_a_guess_or_the_end() {
    let (mut lessons, mut run) = first_lesson();
    apply(&mut lessons, &mut run, LessonCommand::Begin(5));
    lessons.see(&[Some("original")]);
    assert!(!lessons.view().expect("begun").shows_conclusion);
    apply(&mut lessons, &mut run, LessonCommand::Begin(0));
    for command in [LessonCommand::ShowResult, LessonCommand::Watch, LessonCommand::ShowResult] {
        apply(&mut lessons, &mut run, command);
        assert!(!lessons.view().expect("begun").progress.is_revealed);
    }
}

#[test]
fn a29_the_race_of_a_lesson_stops_at_its_finish_until_the_reader_plays_again() {
    let (lessons, _run) = first_lesson();
    let mut app = App::new();
    app.add_message::<Show>().insert_resource(lessons).init_resource::<Notices>();
    let mut lane = Lane::new(robust(), 0);
    lane.skip_to(f64::MAX);
    let end_s = lane.end_s();
    let mut playback = Playback::default();
    playback.seek(end_s, end_s);
    app.world_mut().spawn(lane);
    app.insert_resource(playback).add_systems(Update, take_in);
    app.update();
    let mut playback = app.world_mut().resource_mut::<Playback>();
    assert_eq!((playback.is_playing, playback.time_s()), (false, end_s));
    playback.toggle(end_s);
    app.update();
    let playback = app.world().resource::<Playback>();
    assert_eq!((playback.is_playing, playback.time_s()), (true, 0.0));
}
