//! How recorded trials ended, by the classification and by a rule of another kind.

use crate::score::{EndingKind, ExamEnd, PerturbationRange, Rollout, varied};
use crate::world::{BodyPlan, PartPlan, Pose, Stairs, Vector};

/// Finds the kind and the step of an ending from recorded poses alone, beginning with the last one.
fn from_pictures(
    frames: &[Vec<Pose>],
    body: &BodyPlan,
    stairs: &Stairs,
    frames_per_s: f32,
) -> (EndingKind, u32) {
    let risers_m: Vec<f32> = (0..stairs.steps).map(|step| stairs.riser_y_m(step)).collect();
    let passed = |y_m: f32| risers_m.iter().filter(|riser_m| **riser_m <= y_m).count() as u32;
    let middles: Vec<Vector> =
        frames.iter().map(|poses| poses[body.middle_part].translation).collect();
    let is_within = |at: &Vector| at.x.abs() <= stairs.width_m / 2.0 && at.y <= stairs.end_y_m();
    let levels: Vec<u32> =
        middles
            .iter()
            .map(|at| {
                if is_within(at) && at.z > stairs.height_m(passed(at.y)) { passed(at.y) } else { 0 }
            })
            .collect();
    let corners = |poses: &[Pose]| -> Vec<Vec<Vector>> {
        let of = |(pose, part): (&Pose, &PartPlan)| {
            let [x, y, z] = part.size_m().map(|size_m| size_m / 2.0);
            let corner = |bits: u32| {
                let sign = |bit: u32| if bits >> bit & 1 == 0 { -1.0 } else { 1.0 };
                *pose * Vector::new(sign(0) * x, sign(1) * y, sign(2) * z)
            };
            (0..8).map(corner).collect()
        };
        poses.iter().zip(&body.parts).map(of).collect()
    };
    let last = frames.len() - 1;
    let since = |time_s: f32| last.saturating_sub((time_s * frames_per_s) as usize);
    if levels[last] == stairs.steps {
        return (EndingKind::Landed, stairs.steps);
    }
    let is_high = |poses: &Vec<Pose>| {
        corners(poses).concat().iter().all(|at| at.z > stairs.surface_z_m(at.x, at.y) + 0.1)
    };
    if frames[since(1.2)..].iter().all(is_high) {
        return (EndingKind::LeftTheGround, levels[last]);
    }
    if levels[last] == 0 {
        return match levels.iter().rposition(|level| *level > 0) {
            Some(before) if middles[before + 1].y > risers_m[0] => {
                (EndingKind::OffTheSide, levels[before])
            }
            Some(_) => (EndingKind::FellBack, 0),
            None if middles[last].y > risers_m[0] => (EndingKind::Beside, 0),
            None => on_the_way(&middles, &corners(&frames[last]), &risers_m, since(3.0), 0),
        };
    }
    let highest = |levels: &[u32]| levels.iter().copied().max().unwrap_or(0);
    if highest(&levels) > highest(&levels[since(1.0)..]) {
        return (EndingKind::FellBack, levels[last]);
    }
    on_the_way(&middles, &corners(&frames[last]), &risers_m, since(3.0), levels[last])
}

/// Tells a stuck snake from one that is on its way.
fn on_the_way(
    middles: &[Vector],
    corners: &[Vec<Vector>],
    risers_m: &[f32],
    since: usize,
    level: u32,
) -> (EndingKind, u32) {
    let furthest_m = |of: &[Vector]| of.iter().map(|at| at.y).fold(f32::MIN, f32::max);
    let gained_m = furthest_m(&middles[since..]) - furthest_m(&middles[..since]);
    let front_m = furthest_m(&corners.concat());
    let centre_m = |corners: &Vec<Vector>| corners.iter().map(|at| at.y).sum::<f32>() / 8.0;
    let foremost_m = corners.iter().map(centre_m).fold(f32::MIN, f32::max);
    let next = risers_m.iter().position(|riser_m| *riser_m > foremost_m);
    match next {
        Some(next) if gained_m < 0.25 && risers_m[next] - front_m < 0.5 => {
            (EndingKind::Stuck, next as u32 + 1)
        }
        _ => (EndingKind::OutOfTime, level),
    }
}

/// Five trials of each of twenty built-in champions, with other frictions, rises and directions at the start, so that many of them fail.
#[test]
fn a_hundred_recorded_trials_are_judged_as_from_pictures() {
    let range = PerturbationRange { friction: 0.5, turn_deg: 20.0, ..Default::default() };
    let (mut agree, mut table) = (0, std::collections::BTreeMap::new());
    let mut differing = Vec::new();
    for (name, loaded) in crate::save::library::shipped_champions().into_iter().take(20) {
        let champion = loaded.champion;
        for condition in varied(&champion.trial, &range, 5, 46) {
            let found = ExamEnd::of(&champion.genome, &condition);
            let trial = &condition.trial;
            let mut rollout = Rollout::perturbed(&champion.genome, trial, &condition.perturbation);
            let mut frames = vec![rollout.poses().to_vec()];
            while rollout.advance() {
                frames.push(rollout.poses().to_vec());
            }
            let seen = match rollout.evaluation().disqualified {
                Some(_) => (EndingKind::Disqualified, found.ending.step),
                None => {
                    let frames_per_s = trial.physics.steps_per_s as f32;
                    from_pictures(&frames, rollout.body(), rollout.stairs(), frames_per_s)
                }
            };
            assert_eq!(found.has_landed, found.ending.kind == EndingKind::Landed, "{name}");
            assert_eq!(found.is_disqualified, found.ending.kind == EndingKind::Disqualified);
            *table.entry((seen.0, found.ending.kind)).or_insert(0) += 1;
            if seen == (found.ending.kind, found.ending.step) {
                agree += 1;
            } else {
                differing.push(format!("{name}: {seen:?}, found: {}", found.ending.words()));
            }
        }
    }
    println!("{agree} of 100 agree; seen and found: {table:#?}\n{differing:#?}");
    assert!(agree >= 95, "{agree} of 100: {differing:#?}");
    let kinds = table.keys().map(|(seen, _)| seen).collect::<std::collections::BTreeSet<_>>();
    assert!(kinds.len() >= 5, "{kinds:?}");
}
