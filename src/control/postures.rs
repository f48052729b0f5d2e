//! The postures among which decisions choose, as bends of the joints.

use std::f32::consts::FRAC_PI_2;

/// The bend of a joint in a posture, as a share of a full bend; none if the posture keeps the bends. A positive bend
/// raises the joint over its neighbours.
pub fn bend(posture: usize, joint: usize, joints: usize) -> Option<f32> {
    let wave = |quarter: usize| libm::sinf((quarter as f32 - joint as f32) * FRAC_PI_2);
    let arch = |is_there: bool| if is_there { 1.0 } else { 0.0 };
    let first = |raised: f32| if joint == 0 { raised } else { 0.0 };
    let (front, rear) = (2 * joint < joints, 2 * (joint + 1) > joints);
    let is_outer = joint == 0 || joint + 1 == joints;
    Some(match posture {
        1 => 0.0,
        2 => first(-1.0),
        3 => first(1.0),
        4 => arch(front && !(rear && joints > 1)),
        5 => arch(!is_outer || joints < 3),
        6 => arch(rear && !(front && joints > 1)),
        7..=10 => wave(posture - 7),
        11 => -0.6,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::controllers::POSTURES;

    fn bends(posture: usize) -> Vec<f32> {
        (0..4).map(|joint| bend(posture, joint, 4).expect("a posture")).collect()
    }

    #[test]
    fn postures_have_the_bends_that_their_names_say() {
        let named = |name: &str| POSTURES.iter().position(|known| *known == name).expect("known");
        assert_eq!(bend(named("hold"), 0, 4), None);
        assert_eq!(bends(named("straight")), [0.0; 4]);
        assert_eq!(bends(named("head up")), [-1.0, 0.0, 0.0, 0.0]);
        assert_eq!(bends(named("arch in front")), [1.0, 1.0, 0.0, 0.0]);
        assert_eq!(bends(named("arch in the middle")), [0.0, 1.0, 1.0, 0.0]);
        assert_eq!(bends(named("arch behind")), [0.0, 0.0, 1.0, 1.0]);
        // A wave runs towards the tail: each joint has the bend that the one ahead had a quarter before.
        for quarter in 8..=10 {
            for joint in 1..4 {
                let (now, ahead_before) = (bends(quarter)[joint], bends(quarter - 1)[joint - 1]);
                assert!((now - ahead_before).abs() < 1e-6);
            }
        }
        for (posture, name) in POSTURES.iter().enumerate().skip(1) {
            for joints in 1..=11 {
                let all = (0..joints).map(|joint| bend(posture, joint, joints).expect("a bend"));
                assert!(all.into_iter().all(|bend| bend.abs() <= 1.0), "{name} of {joints}");
            }
        }
    }
}
