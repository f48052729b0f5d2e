//! Copies with a changed world that begin in the middle of the original's replay.

use super::*;
use crate::studio::state::current_run::climber;
use snakes_core::evolve::{Settings, with_field};
use snakes_core::score::Trial;

/// Physics step at which the world of the copies changes.
const MOMENT: u32 = 312;

/// Returns the trial of a champion with another value of a setting.
fn changed(loaded: &LoadedChampion, field: &str, text: &str) -> Trial {
    let settings = Settings { trial: loaded.champion.trial.clone(), ..Settings::default() };
    with_field(&settings, field, text).expect("allowed").trial
}

/// Returns the original's rollout after this number of steps.
fn original_at(step: u32) -> Rollout {
    rollout_after(&shipped().champion, step)
}

/// Returns a copy with this friction from [`MOMENT`] on.
fn copy(friction: &str) -> StagedChampion {
    let trial = changed(&shipped(), "surface.friction", friction);
    let label = format!("friction {friction}");
    climber(0).in_world_from(Some(&original_at(MOMENT)), &trial, label)
}

/// Returns a what-if of the original and copies with these frictions, of which the latest is not kept.
fn what_if(frictions: &[&str]) -> Show {
    let plan = RunPlan::new("climb", 1, Settings::default());
    let mut champions = vec![climber(0)];
    champions.extend(frictions.iter().map(|friction| copy(friction)));
    let beside = vec![plan.clone(); frictions.len() - 1];
    let mode = StageMode::WhatIf { before: Box::new(plan), beside, current: frictions.len() };
    Show { champions, mode }
}

/// Returns the time of a step of the original, in seconds.
fn time_of(step: u32) -> f64 {
    let step_s = 1.0 / f64::from(shipped().champion.trial.physics.steps_per_s);
    f64::from(step) * step_s
}

/// Shows champions, and plays from this time on, in seconds.
fn present_at(app: &mut App, show: Show, moment_s: f64) {
    app.world_mut().write_message(show);
    clock(app).play_change(moment_s, moment_s);
    frame(app, 0.0);
}

/// Shows champions, and plays from [`MOMENT`] on.
fn present(app: &mut App, show: Show) {
    present_at(app, show, time_of(MOMENT));
}

/// Creates a stage that has played a champion to this time, in seconds.
fn stage_at(loaded: LoadedChampion, moment_s: f64) -> App {
    let mut app = stage_of(vec![loaded]);
    finish_lookahead(&mut app);
    clock(&mut app).hold_at(moment_s);
    frame(&mut app, 0.0);
    app
}

/// Creates a stage that has played the original to [`MOMENT`].
fn stage_at_moment() -> App {
    stage_at(shipped(), time_of(MOMENT))
}

#[test]
fn a_copy_starts_at_the_moment_with_the_state_of_the_original_while_it_plays_on() {
    let mut app = stage_at_moment();
    present(&mut app, what_if(&["0.3"]));
    assert!(clock(&mut app).is_playing);
    assert_eq!(clock(&mut app).time_s(), time_of(MOMENT));
    let [(_, first), (_, second)] = lanes_of(&mut app)[..] else { panic!("two lanes") };
    assert_eq!((first.replay.step(), second.replay.step()), (MOMENT, MOMENT));
    assert_eq!(first.replay.poses(), original_at(MOMENT).poses());
    assert_eq!(second.replay.poses(), first.replay.poses());
    (0..40).for_each(|_| frame(&mut app, 0.05));
    let [(_, first), (_, second)] = lanes_of(&mut app)[..] else { panic!("two lanes") };
    assert_eq!(first.replay.poses(), original_at(first.replay.step()).poses());
    let apart_m = first.drawn_middle().distance(second.drawn_middle());
    assert!(apart_m > 0.1, "{apart_m} m apart after two seconds on ice");
}

#[test]
fn a_copy_in_the_other_engine_goes_on_with_the_same_motion() {
    let trial = changed(&shipped(), "physics.engine", "lanes");
    let copy = climber(0).in_world_from(Some(&original_at(MOMENT)), &trial, "lanes".to_owned());
    assert!(copy.is_changed());
    let (mut in_rapier, mut in_lanes) = (climber(0).rollout(), copy.rollout());
    let middle = |rollout: &Rollout| rollout.poses()[2].translation;
    let mut moved_m = 0.0;
    while in_rapier.step() < MOMENT + 6 {
        let before = middle(&in_rapier);
        assert!(in_rapier.advance() && in_lanes.advance());
        if in_rapier.step() <= MOMENT {
            assert_eq!(in_rapier.poses(), in_lanes.poses(), "step {}", in_rapier.step());
        } else {
            moved_m += middle(&in_rapier).distance(before);
        }
    }
    let apart_m = middle(&in_rapier).distance(middle(&in_lanes));
    assert!(apart_m > 0.0 && apart_m < 0.1 * moved_m, "{apart_m} m apart after {moved_m} m");
}

#[test]
fn seeking_in_a_copy_shows_the_past_of_the_original_and_always_the_same_bits() {
    let mut played = copy("0.3").rollout();
    let mut expected = Vec::new();
    while played.advance() {
        expected.push(played.poses().to_vec());
    }
    let steps = [MOMENT + 90, 40, MOMENT, MOMENT + 1, MOMENT - 1, MOMENT + 300, MOMENT + 90];
    for is_history_known in [false, true] {
        let mut app = stage_at_moment();
        present(&mut app, what_if(&["0.3"]));
        if is_history_known {
            finish_lookahead(&mut app);
        }
        for step in steps {
            clock(&mut app).hold_at(time_of(step));
            frame(&mut app, 0.0);
            let lanes = lanes_of(&mut app);
            let shown = lanes[1].1;
            assert_eq!(shown.replay.step(), step);
            assert_eq!(shown.replay.poses(), expected[step as usize - 1], "step {step}");
            if step <= MOMENT {
                assert_eq!(shown.replay.poses(), original_at(step).poses(), "step {step}");
            }
        }
    }
}

#[test]
fn while_a_copy_starts_over_the_other_lanes_stay() {
    let mut app = stage_at_moment();
    present(&mut app, what_if(&["0.3", "2"]));
    let entities: Vec<Entity> = lanes_of(&mut app).iter().map(|(entity, _)| *entity).collect();
    finish_lookahead(&mut app);
    (0..10).for_each(|_| frame(&mut app, 0.05));
    present(&mut app, what_if(&["0.3", "3"]));
    let lanes = lanes_of(&mut app);
    let [(first, original), (second, fixed), (third, changed)] = lanes[..] else {
        panic!("three lanes")
    };
    assert_eq!([first, second], entities[..2]);
    assert_ne!(third, entities[2]);
    assert_eq!(changed.staged.label(), "friction 3");
    for lane in [original, fixed, changed] {
        assert_eq!(lane.replay.step(), MOMENT);
        assert_eq!(lane.replay.poses(), original_at(MOMENT).poses());
    }
    assert!(original.history().is_some() && fixed.history().is_some(), "not computed again");
}

#[test]
fn the_end_of_a_copy_is_not_compared_with_the_record() {
    let mut app = stage_at_moment();
    present(&mut app, what_if(&["0.3"]));
    finish_lookahead(&mut app);
    clock(&mut app).hold_at(1.0e9);
    (0..5).for_each(|_| frame(&mut app, 0.1));
    let lanes = lanes_of(&mut app);
    assert!(lanes.iter().all(|(_, lane)| lane.replay.is_over()));
    let ends = lanes.iter().map(|(_, lane)| lane.evaluation());
    let recorded = shipped().champion.evaluation;
    let agree: Vec<bool> = ends.map(|end| end.agrees_with(&recorded)).collect();
    assert_eq!(agree, [true, false]);
    assert_eq!(app.world().resource::<Notices>().len(), 0, "no message about a difference");
}

#[test]
fn a_copy_starts_at_the_moment_without_simulating_its_past() {
    // The trial takes ten minutes and the change is near its end: simulating the steps before would take hundreds of frames.
    let mut long = shipped();
    long.champion.trial.duration_s = 600.0;
    let moment_s = 590.0;
    let mut app = stage_at(long.clone(), moment_s);
    let original = StagedChampion::from_file(&long, 0, "a champion");
    let step = lane(&mut app).replay.step();
    let moment = lane(&mut app).rollout_at(step);
    let copies = ["0.3", "0.4", "0.5"].map(|friction| {
        let trial = changed(&long, "surface.friction", friction);
        let copy = original.in_world_from(Some(&moment), &trial, friction.to_owned());
        let mode = StageMode::what_if(RunPlan::new("climb", 1, Settings::default()));
        Show { champions: vec![original.clone(), copy], mode }
    });
    for show in copies {
        present_at(&mut app, show, moment_s);
        let lanes = lanes_of(&mut app);
        let steps: Vec<u32> = lanes.iter().map(|(_, lane)| lane.replay.step()).collect();
        assert_eq!(steps, [step; 2], "both are there within one frame");
    }
}
