//! Constructed trajectories of each kind.

use super::*;
use crate::score::way_up::tests::body;
use crate::world::{Rotation, Vector};

/// A single block of 2 m on the default stairs of ten steps, 0.5 m high and 2 m deep, from y = 3 m on.
fn watched(way: &[([f32; 3], f32)], flies: impl Fn(f32) -> bool) -> Ending {
    watched_until(way, flies, None)
}

/// Watches a block that moves from point to point. Each point has a place, in m, and a time, in s.
fn watched_until(
    way: &[([f32; 3], f32)],
    flies: impl Fn(f32) -> bool,
    reason: Option<Disqualification>,
) -> Ending {
    let mut watch = Watch::new(&body(&[2.0]), &Stairs::default(), 9.81);
    let mut poses = [Pose::from_parts(Vector::ZERO, Rotation::IDENTITY)];
    let end_s = way.last().map_or(0.0, |(_, at_s)| *at_s);
    for step in 0..=(end_s * 60.0) as u32 {
        let now_s = step as f32 / 60.0;
        let before = way.iter().rev().find(|(_, at_s)| *at_s <= now_s).expect("a start");
        let after = way.iter().find(|(_, at_s)| *at_s > now_s).unwrap_or(before);
        let share = ((now_s - before.1) / (after.1 - before.1).max(1.0e-6)).clamp(0.0, 1.0);
        let at_m = Vector::from(before.0).lerp(Vector::from(after.0), share);
        poses[0].translation = at_m;
        let touches = if flies(now_s) { 0..0 } else { 0..1 };
        watch.observe(now_s, &poses, touches, flies(now_s));
    }
    watch.ending(reason, &poses)
}

/// A point on the stairs, above the step under it.
fn on(y_m: f32, at_s: f32) -> ([f32; 3], f32) {
    let stairs = Stairs::default();
    let steps = stairs.steps_climbed(f64::from(y_m));
    ([0.0, y_m, stairs.height_m(steps) + 1.0], at_s)
}

/// A climb at an even pace, step by step, up to y.
fn climb(to_y_m: f32, until_s: f32) -> Vec<([f32; 3], f32)> {
    let way_m = to_y_m + 7.0;
    let point = |number: u32| {
        let share = number as f32 / 400.0;
        on(-7.0 + way_m * share, until_s * share)
    };
    (0..=400).map(point).collect()
}

fn then(mut way: Vec<([f32; 3], f32)>, more: &[([f32; 3], f32)]) -> Vec<([f32; 3], f32)> {
    way.extend_from_slice(more);
    way
}

const NEVER: fn(f32) -> bool = |_| false;

#[test]
fn a_snake_on_the_landing_has_landed() {
    let ending = watched(&then(climb(24.0, 10.0), &[on(25.0, 15.0)]), NEVER);
    assert_eq!(ending.words(), "landed");
    assert_eq!((ending.kind, ending.step), (EndingKind::Landed, 10));
}

#[test]
fn a_snake_that_leaves_over_an_edge_fell_off_the_side_from_the_step_before() {
    // At y = 10 there are four steps below.
    let fall = [([2.4, 10.0, 3.0], 9.0), ([3.5, 10.0, 0.5], 10.0)];
    assert_eq!(
        watched(&then(climb(10.0, 8.0), &fall), NEVER).words(),
        "fell off the side from step 4"
    );
    // It crawls back in front of the stairs, which changes nothing.
    let crawl = then(climb(10.0, 8.0), &[fall[0], fall[1], ([3.5, 0.0, 0.5], 14.0)]);
    assert_eq!(watched(&crawl, NEVER).words(), "fell off the side from step 4");
    // It climbs again.
    let again = [fall[0], fall[1], ([3.0, 2.0, 0.5], 11.0), ([0.0, 2.5, 0.5], 12.0), on(3.5, 13.0)];
    assert_eq!(watched(&then(climb(10.0, 8.0), &again), NEVER).kind, EndingKind::FellBack);
    // The far end of the landing is an edge, too.
    let end_y_m = Stairs::default().end_y_m();
    let over = [on(end_y_m - 0.5, 10.0), ([0.0, end_y_m + 0.5, 0.5], 12.0)];
    assert_eq!(
        watched(&then(climb(24.0, 8.0), &over), NEVER).words(),
        "fell off the side from step 10"
    );
}

#[test]
fn a_snake_that_was_higher_fell_back() {
    let back = watched(&then(climb(12.0, 8.0), &[on(6.0, 9.0), on(6.0, 12.0)]), NEVER);
    assert_eq!(back.words(), "fell back to step 2");
    let to_ground = watched(&then(climb(8.0, 8.0), &[on(2.0, 9.0), on(2.0, 9.2)]), NEVER);
    assert_eq!(to_ground.words(), "fell back to the ground");
    // On the ground it rolls aside and past the stairs.
    let aside = [on(2.0, 9.0), ([4.0, 2.0, 0.5], 10.0), ([4.0, 6.0, 0.5], 11.0)];
    assert_eq!(watched(&then(climb(8.0, 8.0), &aside), NEVER).kind, EndingKind::FellBack);
}

#[test]
fn a_snake_without_progress_at_a_riser_is_stuck_and_elsewhere_out_of_time() {
    // The front is 0.2 m before the fourth riser, at y = 9.
    let stuck = then(climb(7.8, 8.0), &[on(7.8, 12.0)]);
    assert_eq!(watched(&stuck, NEVER).words(), "stuck with its front at riser 4");
    assert_eq!(watched(&stuck[..stuck.len() - 1], NEVER).words(), "out of time on step 3");
    // Rocking is no progress.
    let mut rocks = climb(7.8, 8.0);
    (0..9)
        .for_each(|count| rocks.push(on(7.8 - 0.4 * (count % 2) as f32, 8.5 + 0.5 * count as f32)));
    assert_eq!(watched(&rocks, NEVER).words(), "stuck with its front at riser 4");
    assert_eq!(watched(&[on(-7.0, 0.0), on(-7.0, 15.0)], NEVER).words(), "out of time");
    assert_eq!(watched(&climb(1.8, 4.0), NEVER).words(), "out of time");
    assert_eq!(
        watched(&then(climb(1.8, 4.0), &[on(1.8, 9.0)]), NEVER).words(),
        "stuck with its front at riser 1"
    );
}

#[test]
fn a_snake_that_is_beside_the_stairs_without_having_climbed_passed_them() {
    let way = [([0.0, -7.0, 0.5], 0.0), ([4.0, 0.0, 0.5], 5.0), ([4.0, 12.0, 0.5], 12.0)];
    assert_eq!(watched(&way, NEVER).words(), "passed the stairs, went around");
    let way = [([0.0, -7.0, 0.5], 0.0), ([4.0, 0.0, 0.5], 5.0), ([4.0, 5.0, 0.5], 12.0)];
    assert_eq!(watched(&way, NEVER).words(), "passed the stairs");
}

#[test]
fn a_snake_that_flies_for_longer_than_a_fall_left_the_ground() {
    let up = then(climb(5.0, 8.0), &[([0.0, 9.0, 20.0], 10.0)]);
    assert_eq!(watched(&up, |now_s| now_s > 8.0).kind, EndingKind::LeftTheGround);
    assert_ne!(watched(&up, |now_s| now_s > 9.0).kind, EndingKind::LeftTheGround);
}

#[test]
fn a_disqualified_snake_has_its_reason() {
    let ending = watched_until(&climb(6.0, 8.0), NEVER, Some(Disqualification::TooFast));
    assert_eq!(ending.words(), "disqualified: speed limit exceeded");
    assert_eq!(ending.reason, Some(Disqualification::TooFast));
}

#[test]
fn tricks_are_told_apart_from_climbing() {
    let fair = watched(&climb(24.0, 10.0), NEVER);
    assert_eq!(fair.tricks, [false; 3]);
    // One flight from the second step to the landing.
    let flight = then(climb(6.0, 5.0), &[([0.0, 14.0, 9.0], 5.5), on(24.0, 6.0), on(24.0, 8.0)]);
    let flung = watched(&flight, |now_s| now_s > 5.0 && now_s < 6.0);
    assert_eq!(flung.words(), "landed, leapt over steps, was flung");
    // Three steps in one flight are a leap, as is every second step.
    let leaps = then(climb(6.0, 5.0), &[on(12.0, 5.5), on(24.0, 12.0)]);
    assert_eq!(watched(&leaps, |now_s| now_s > 5.0 && now_s < 5.5).tricks, [false; 3]);
    // It falls off, and then gets ahead beside the stairs.
    let around = [([3.5, 10.0, 0.5], 9.0), ([3.5, 20.0, 0.5], 14.0)];
    let around = watched(&then(climb(10.0, 8.0), &around), NEVER);
    assert_eq!(around.words(), "fell off the side from step 4, went around");
}

#[test]
fn trials_are_counted_by_how_they_ended_with_the_median_of_their_steps() {
    let of = |kind, step| Ending {
        kind,
        step,
        at_s: 0.0,
        reason: None,
        tricks: [step > 4, false, false],
    };
    let all =
        [of(EndingKind::OffTheSide, 2), of(EndingKind::Landed, 10), of(EndingKind::OffTheSide, 5)];
    let endings = Endings::of(all.iter());
    let counts: Vec<_> =
        endings.counts.iter().map(|count| (count.kind, count.trials, count.step)).collect();
    assert_eq!(counts, [(EndingKind::Landed, 1, 10.0), (EndingKind::OffTheSide, 2, 3.5)]);
    assert_eq!((endings.tricks, endings.count(EndingKind::Stuck)), ([2, 0, 0], 0));
    assert_eq!(endings.check(3), Ok(()));
    assert!(
        endings.check(1).expect_err("more than there were").to_string().contains("trials is 2")
    );
}

#[test]
fn a_trial_that_begins_on_the_stairs_has_neither_leapt_over_steps_nor_been_flung() {
    let ending = watched(&[on(18.5, 0.0), on(30.0, 4.0)], |_| false);
    assert_eq!((ending.kind, ending.tricks), (EndingKind::Landed, [false; 3]));
}
