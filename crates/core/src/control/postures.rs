//! The postures among which decisions choose, as bends of the joints.
//!
//! A snake climbs by folding: neighbouring joints bend to opposite sides, and the fold travels along the body. The gaits
//! that evolution finds move between such folds and a straight body, so the postures are folds of parts of the body.

/// Returns the bend of a joint in a posture, as a share of a full bend, from -1 to 1. A negative bend of the first joint raises the head.
/// An index beyond the postures is straight.
pub fn bend(posture: usize, joint: usize, joints: usize) -> f32 {
    let side = if joint.is_multiple_of(2) { -1.0 } else { 1.0 };
    let is_front = 2 * joint < joints;
    let is_outer = joint == 0 || joint + 1 == joints;
    let parts = |front: f32, rear: f32| side * if is_front { front } else { rear };
    let only = |is_there: bool, bend: f32| if is_there { bend } else { 0.0 };
    match posture {
        1 => parts(1.0, 0.0),
        2 => only(!is_outer, side),
        3 => parts(0.0, 1.0),
        4 => parts(1.0, 1.0),
        5 => parts(0.5, 0.5),
        6 => parts(1.0, 0.5),
        7 => parts(0.5, 1.0),
        8 => only(joint == 0, -0.5),
        9 => only(joint == 0, 0.5),
        10 => only(joint + 1 == joints, side),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::controllers::POSTURES;

    fn bends(name: &str) -> [f32; 4] {
        let posture = POSTURES.iter().position(|known| *known == name).expect("known");
        [0, 1, 2, 3].map(|joint| bend(posture, joint, 4))
    }

    #[test]
    fn postures_have_the_bends_that_their_names_say() {
        assert_eq!(bends("straight"), [0.0; 4]);
        assert_eq!(bends("fold in front"), [-1.0, 1.0, 0.0, 0.0]);
        assert_eq!(bends("fold in the middle"), [0.0, 1.0, -1.0, 0.0]);
        assert_eq!(bends("fold behind"), [0.0, 0.0, -1.0, 1.0]);
        assert_eq!(bends("fold all"), [-1.0, 1.0, -1.0, 1.0]);
        assert_eq!(bends("fold all by half"), [-0.5, 0.5, -0.5, 0.5]);
        assert_eq!(bends("fold in front, half behind"), [-1.0, 1.0, -0.5, 0.5]);
        assert_eq!(bends("half in front, fold behind"), [-0.5, 0.5, -1.0, 1.0]);
        assert_eq!(bends("head up"), [-0.5, 0.0, 0.0, 0.0]);
        assert_eq!(bends("head down"), [0.5, 0.0, 0.0, 0.0]);
        assert_eq!(bends("tail down"), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn every_posture_exists_for_every_snake() {
        for posture in 0..POSTURES.len() {
            for joints in 1..=11 {
                for joint in 0..joints {
                    assert!(bend(posture, joint, joints).abs() <= 1.0);
                }
            }
        }
    }
}
