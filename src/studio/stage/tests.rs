//! The stage without a window, frame by frame.

mod staged_world;
mod what_if;

use std::time::Duration;

use bevy::time::TimeUpdateStrategy;

use super::selection::HeldLimb;
use super::*;
use snakes_core::evolve::Champion;
use snakes_core::save::{LoadedChampion, shipped_champion};
use snakes_core::score::{Recording, Rollout, evaluate};
use snakes_core::world::{Pose, Pull, Vector};

fn shipped() -> LoadedChampion {
    shipped_champion().expect("well formed")
}

/// Returns the shipped champion with a recording by another version of the engine.
fn recorded() -> LoadedChampion {
    let mut loaded = shipped();
    let Champion { genome, trial, .. } = &loaded.champion;
    loaded.recording = Some(Recording::of(genome, trial));
    loaded.engine.version = 1;
    loaded
}

/// Returns the rollout of a champion after this number of steps.
fn rollout_after(champion: &Champion, steps: u32) -> Rollout {
    let mut rollout = Rollout::new(&champion.genome, &champion.trial);
    while rollout.step() < steps {
        assert!(rollout.advance());
    }
    rollout
}

/// Creates a headless stage on which these champions race.
fn stage_of(opening: Vec<LoadedChampion>) -> App {
    let saved = |loaded| ("a champion".to_owned(), loaded);
    let mut app = App::new();
    app.add_plugins(MinimalPlugins)
        .add_message::<Show>()
        .init_resource::<Notices>()
        .init_resource::<Playback>()
        .init_resource::<StageMode>()
        .init_resource::<Selection>()
        .insert_resource(OpeningChampions(opening.into_iter().map(saved).collect()))
        .add_systems(Startup, show_opening)
        .add_systems(Update, (put_on_stage, advance).chain());
    frame(&mut app, 0.0);
    app
}

/// Runs a frame of this length, in seconds.
fn frame(app: &mut App, length_s: f32) {
    let length = Duration::from_secs_f32(length_s);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
    app.update();
}

/// Runs frames of these lengths in turn until the first lane meets the condition.
fn play(app: &mut App, frames_s: &[f32], until: impl Fn(&Lane) -> bool) {
    for frame_s in frames_s.iter().cycle().take(10_000) {
        frame(app, *frame_s);
        if until(lane(app)) {
            return;
        }
    }
    panic!("the stage never got there");
}

/// Returns the lanes by number, with their entities.
fn lanes_of(app: &mut App) -> Vec<(Entity, &Lane)> {
    let mut query = app.world_mut().query::<(Entity, &Lane)>();
    query.iter(app.world()).sort_by_key::<&Lane, _>(|lane| lane.number).collect()
}

fn lane(app: &mut App) -> &Lane {
    lanes_of(app)[0].1
}

fn clock(app: &mut App) -> Mut<'_, Playback> {
    app.world_mut().resource_mut::<Playback>()
}

/// Waits until the lookahead of all lanes has finished.
fn finish_lookahead(app: &mut App) {
    frame(app, 0.0);
    let mut lanes = app.world_mut().query::<&mut Lane>();
    lanes.iter_mut(app.world_mut()).for_each(|mut lane| lane.finish_lookahead());
}

fn is_over(lane: &Lane) -> bool {
    lane.replay.is_over()
}

#[test]
fn a_replay_is_bit_identical_to_the_headless_run_at_any_frame_rate_and_speed() {
    let opening = shipped().champion;
    let headless = evaluate(&opening.genome, &opening.trial);
    for (frames_s, speed) in [
        (&[1.0 / 60.0][..], 1.0),
        (&[0.25], 1.0),
        (&[0.004, 0.1, 0.031], 1.0),
        (&[0.1], 16.0),
        (&[0.4], 0.1),
    ] {
        let mut app = stage_of(vec![shipped()]);
        clock(&mut app).set_speed(speed);
        play(&mut app, frames_s, is_over);
        assert_eq!(
            lane(&mut app).evaluation(),
            headless,
            "frames of {frames_s:?} s, times {speed}"
        );
    }
}

#[test]
fn seeking_gives_the_played_state_bit_for_bit() {
    let champion = shipped().champion;
    let mut app = stage_of(vec![shipped()]);
    finish_lookahead(&mut app);
    clock(&mut app).toggle(1.0e9);
    let steps = champion.trial.steps();
    let step_s = 1.0 / f64::from(champion.trial.physics.steps_per_s);
    for target in [steps / 2, steps, 3, steps - 1, 0, steps / 2 + 1] {
        clock(&mut app).seek(f64::from(target) * step_s, 1.0e9);
        frame(&mut app, 0.016);
        let played = rollout_after(&champion, target);
        let shown = lane(&mut app);
        assert_eq!(shown.replay.step(), target);
        assert_eq!(shown.replay.poses(), played.poses(), "step {target}");
        assert_eq!(shown.evaluation(), played.evaluation(), "step {target}");
        let drawn: Vec<Pose> = shown.drawn_poses().collect();
        assert_eq!(drawn, played.poses(), "held on a step, that step is drawn");
    }
}

#[test]
fn a_replay_that_differs_from_its_record_is_reported_once() {
    let honest = shipped();
    let mut edited = honest.clone();
    edited.champion.genome.body.density_kg_m3 *= 1.2;
    for (loaded, notices) in [(honest, 0), (edited, 1)] {
        let mut app = stage_of(vec![loaded]);
        play(&mut app, &[0.1], is_over);
        (0..40).for_each(|_| frame(&mut app, 0.1));
        assert_eq!(app.world().resource::<Notices>().len(), notices);
    }
}

#[test]
fn a_champion_of_another_engine_plays_its_recording_and_can_be_simulated() {
    let mut loaded = recorded();
    let recording = loaded.recording.take().expect("recorded");
    // The recording is shifted sideways by a metre.
    let aside = |pose: &Pose| Pose { translation: pose.translation + Vec3::X, ..*pose };
    let poses = recording.frames().flatten().map(aside).collect();
    loaded.recording = Recording::new(recording.every_steps(), recording.parts(), poses);
    let last = loaded.recording.as_ref().expect("whole frames").at(1.0e9);
    let mut app = stage_of(vec![loaded.clone()]);
    play(&mut app, &[0.1], is_over);
    assert_eq!(app.world().resource::<Notices>().len(), 1, "it says so, and finds no fault");
    let shown = lane(&mut app);
    for (drawn, recorded) in shown.drawn_poses().zip(last) {
        assert!((drawn.translation - recorded.translation).length() < 1e-5);
    }
    assert!(shown.staged.caption().contains("as recorded by engine 1"));
    let simulated = shown.staged.simulated();
    app.world_mut().write_message(Show::solo(simulated));
    clock(&mut app).restart();
    frame(&mut app, 0.0);
    play(&mut app, &[0.1], is_over);
    let shown = lane(&mut app);
    assert_eq!(shown.evaluation().trace_hash, loaded.champion.evaluation.trace_hash);
    assert!(shown.staged.could_be_as_found());
}

#[test]
fn drawn_poses_lie_between_the_last_two_steps() {
    let mut app = stage_of(vec![shipped()]);
    play(&mut app, &[0.0251], |lane| lane.replay.step() > 60);
    let time_s = clock(&mut app).time_s();
    let shown = lane(&mut app);
    let place = time_s / shown.step_s;
    let share = (place - place.floor()) as f32;
    assert!((0.1..0.9).contains(&share), "the frame ends {share} of the way through a step");
    let champion = shown.staged.champion();
    let mut rollout = Rollout::new(&champion.genome, &champion.trial);
    let mut head = || {
        rollout.advance();
        rollout.poses()[0].translation.y
    };
    let (before, after) = (0..place.ceil() as u32).fold((0.0, 0.0), |(_, last), _| (last, head()));
    let drawn = shown.drawn_poses().next().expect("a head").translation.y;
    let expected = before + (after - before) * share;
    assert!((after - before).abs() > 1e-4, "the head moves: {before} to {after}");
    assert!((drawn - expected).abs() < 1e-4, "{drawn} for {expected}");
}

#[test]
fn ten_lanes_stand_side_by_side_and_stay_bit_identical() {
    let champion = shipped().champion;
    let mut app = stage_of(vec![shipped(); 12]);
    assert_eq!(*app.world().resource::<StageMode>(), StageMode::Race);
    play(&mut app, &[0.05], |lane| lane.replay.step() > 60);
    let lanes: Vec<&Lane> = lanes_of(&mut app).into_iter().map(|(_, lane)| lane).collect();
    assert_eq!(lanes.len(), MAX_LANES, "and no more");
    let xs: Vec<f32> = lanes.iter().map(|lane| lane.offset().x).collect();
    let spacing_m = champion.trial.stairs.width_m + GAP_M;
    for pair in xs.windows(2) {
        assert!((pair[0] - pair[1] - spacing_m).abs() < 1e-4, "{xs:?}");
    }
    assert!((xs[0] + xs[9]).abs() < 1e-4, "around the middle");
    for lane in &lanes {
        assert_eq!(lane.evaluation(), lanes[0].evaluation());
    }
}

#[test]
fn a_genome_that_does_not_fit_is_reported_and_the_others_are_shown() {
    let mut unfit = shipped();
    unfit.champion.trial.agent.limbs = 7;
    let mut app = stage_of(vec![shipped(), unfit.clone()]);
    assert_eq!(app.world().resource::<Notices>().len(), 1);
    assert_eq!(*app.world().resource::<StageMode>(), StageMode::Solo);
    let champions = vec![StagedChampion::from_file(&unfit, 0, "unfit")];
    let (lanes, problems) = lanes(champions, &StageMode::Solo, &mut []);
    assert!(lanes.is_empty());
    let problem = &problems[0];
    for part in ["unfit cannot be shown", "joints is 4 joints", "allowed: 6"] {
        assert!(problem.contains(part), "{part:?} in {problem}");
    }
    // The earlier lanes stay if the new ones cannot be shown.
    app.world_mut().write_message(Show::solo(StagedChampion::from_file(&unfit, 0, "unfit")));
    frame(&mut app, 0.1);
    assert_eq!(lane(&mut app).staged.name(), "a champion");
}

/// Holds the head of the only snake with the mouse, and pulls it this far.
fn pull(app: &mut App, way_m: Vector) {
    let [(entity, lane)] = lanes_of(app)[..] else { panic!("one lane") };
    let to_m = lane.replay.poses()[0].translation + way_m;
    let pull = Pull { part: 0, held_at_m: Vector::ZERO, to_m };
    let held = HeldLimb { lane: entity, pull, pressed_at: Vec2::ZERO, is_pulling: true };
    app.world_mut().resource_mut::<Selection>().grab(0, 0, held);
}

#[test]
fn a_pulled_snake_is_disturbed_until_a_seek_and_is_not_compared_with_its_record() {
    let mut app = stage_of(vec![shipped()]);
    finish_lookahead(&mut app);
    play(&mut app, &[0.05], |lane| lane.replay.step() > 60);
    pull(&mut app, Vector::new(0.0, -2.0, 2.0));
    (0..20).for_each(|_| frame(&mut app, 0.05));
    assert!(lane(&mut app).replay.is_disturbed());
    app.world_mut().resource_mut::<Selection>().held = None;
    play(&mut app, &[0.1], is_over);
    (0..10).for_each(|_| frame(&mut app, 0.05));
    assert_eq!(app.world().resource::<Notices>().len(), 0, "the record is not checked");
    let recorded = lane(&mut app).staged.champion().evaluation;
    assert!(!lane(&mut app).evaluation().agrees_with(&recorded), "the pull changed the result");
    clock(&mut app).seek(1.0, 1.0e9);
    frame(&mut app, 0.0);
    assert!(!lane(&mut app).replay.is_disturbed(), "undisturbed before the pull");
    clock(&mut app).set_speed(16.0);
    play(&mut app, &[0.1], is_over);
    assert!(lane(&mut app).evaluation().agrees_with(&recorded));
}

#[test]
fn a8_no_pull_ends_a_trial_and_a_pull_plays_a_paused_stage() {
    let mut loaded = shipped();
    loaded.champion.trial.health.arena_half_width_m = 3.0;
    loaded.champion.trial.health.speed_m_s = 15.0;
    let mut app = stage_of(vec![loaded]);
    finish_lookahead(&mut app);
    play(&mut app, &[0.05], |lane| lane.replay.step() > 60);
    clock(&mut app).hold_at(1.0);
    frame(&mut app, 0.1);
    pull(&mut app, Vector::new(60.0, 0.0, 0.0));
    (0..80).for_each(|_| frame(&mut app, 0.1));
    assert!(clock(&mut app).is_playing, "or nothing would move");
    let lane = lane(&mut app);
    assert_eq!(lane.evaluation().disqualified, None);
    assert!(lane.replay.is_disturbed() && lane.replay.poses()[0].translation.x.abs() > 3.0);
}

#[test]
fn a_high_step_rate_can_be_pulled_without_jumping_back() {
    let mut loaded = shipped();
    loaded.champion.trial.physics.steps_per_s = 1000;
    let mut app = stage_of(vec![loaded]);
    finish_lookahead(&mut app);
    play(&mut app, &[0.1], |lane| lane.replay.step() > 300);
    pull(&mut app, Vector::new(0.0, 0.0, 2.0));
    frame(&mut app, 0.1);
    assert!(lane(&mut app).replay.is_disturbed(), "pulled during all hundred steps of the frame");
}

#[test]
fn a_disturbed_lane_spreads_a_long_seek_over_several_frames() {
    let mut loaded = shipped();
    loaded.champion.trial.duration_s = 300.0;
    let mut app = stage_of(vec![loaded]);
    play(&mut app, &[0.05], |lane| lane.replay.step() > 60);
    pull(&mut app, Vector::ZERO);
    frame(&mut app, 0.05);
    app.world_mut().resource_mut::<Selection>().held = None;
    let before = lane(&mut app).replay.step();
    clock(&mut app).hold_at(250.0);
    frame(&mut app, 0.05);
    let after = lane(&mut app).replay.step();
    assert!(after - before <= MAX_STEPS_PER_FRAME, "{before} to {after}");
    play(&mut app, &[0.05], |lane| lane.replay.is_over() || lane.replay.step() == 15_000);
}

#[test]
fn a_recording_has_a_landing_time_and_a_trail() {
    let mut app = stage_of(vec![recorded(), shipped()]);
    finish_lookahead(&mut app);
    clock(&mut app).hold_at(1.0e9);
    (0..10).for_each(|_| frame(&mut app, 0.1));
    let lanes = lanes_of(&mut app);
    let landed: Vec<f64> = lanes.iter().filter_map(|(_, lane)| lane.landed_s(1.0e9)).collect();
    let [first, second] = landed[..] else { panic!("both land: {landed:?}") };
    assert!((first - second).abs() < 0.05, "{landed:?}");
    assert!(lane(&mut app).trail_m().len() > 100);
}
