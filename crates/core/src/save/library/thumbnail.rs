//! Thumbnails: small pictures of a champion's movement from the side, as points for a later drawing.

use crate::evolve::Champion;
use crate::score::{KeyframeHistory, Recording, Trial};
use crate::world::{BodyPlan, Pose, Vector};

/// Movement of a champion, seen from the side. All points are y and z, in metres.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Thumbnail {
    /// Outline of the stairs, from the first riser's foot to the end of the landing.
    pub stairs_m: Vec<[f32; 2]>,
    /// Path of the middle limb; empty without a recording.
    pub way_m: Vec<[f32; 2]>,
    /// Parts at the end, head first: the index of the limb, and the corners in order. Empty without a recording.
    pub parts_m: Vec<(usize, [[f32; 2]; 4])>,
}

/// Number of points of the path.
const PATH_POINTS: usize = 20;

impl Thumbnail {
    /// Makes a thumbnail of the stairs of a trial, without a snake.
    pub fn of_trial(trial: &Trial) -> Self {
        Self { stairs_m: stairs(trial), ..Self::default() }
    }

    /// Makes a thumbnail of the stairs and the recorded motion of a champion.
    pub fn of_champion(champion: &Champion, recording: Option<&Recording>) -> Self {
        let empty = Self::of_trial(&champion.trial);
        let Some(recording) = recording else { return empty };
        let body = champion.body();
        let frames: Vec<&[Pose]> = recording.frames().collect();
        let Some(end) = frames.last() else { return empty };
        let middle = |frame: usize| frames[frame].get(body.middle_part);
        let path = samples(frames.len() - 1).into_iter().filter_map(middle);
        Self {
            way_m: path.map(|pose| side(pose.translation)).collect(),
            parts_m: quads(&body, end),
            ..empty
        }
    }

    /// Makes a thumbnail of the stairs and the simulated motion of a champion. Simulates at most the distance between two keyframes.
    pub fn of_history(champion: &Champion, history: &KeyframeHistory) -> Self {
        let empty = Self::of_trial(&champion.trial);
        let middles = history.middles_m();
        let Some(last) = middles.len().checked_sub(1) else { return empty };
        let end = history.rollout_at(history.evaluation().steps);
        Self {
            way_m: samples(last).into_iter().map(|sample| side(middles[sample])).collect(),
            parts_m: quads(&champion.body(), end.poses()),
            ..empty
        }
    }
}

/// Returns the indices of the path's points among samples up to the index `last`.
fn samples(last: usize) -> Vec<usize> {
    let mut samples: Vec<usize> = (0..PATH_POINTS).map(|i| i * last / (PATH_POINTS - 1)).collect();
    samples.dedup();
    samples
}

/// Returns the index of the limb and the corners of each part.
fn quads(body: &BodyPlan, poses: &[Pose]) -> Vec<(usize, [[f32; 2]; 4])> {
    let parts = poses.iter().zip(&body.parts);
    parts.map(|(pose, part)| (part.limb, quad(pose, part.size_m()))).collect()
}

fn stairs(trial: &Trial) -> Vec<[f32; 2]> {
    let mut outline = trial.stairs.outline_m();
    outline.push([trial.stairs.end_y_m(), 0.0]);
    outline
}

fn side(at_m: Vector) -> [f32; 2] {
    [at_m.y, at_m.z]
}

/// Returns the corners of a part seen from the side: the largest of the three cross-sections through its middle.
fn quad(pose: &Pose, [width_m, length_m, height_m]: [f32; 3]) -> [[f32; 2]; 4] {
    let half = |x, y, z| side(pose.rotation * Vector::new(x, y, z) / 2.0);
    let across = half(width_m, 0.0, 0.0);
    let along = half(0.0, length_m, 0.0);
    let up = half(0.0, 0.0, height_m);
    let area = |[a, b]: [[f32; 2]; 2]| (a[0] * b[1] - a[1] * b[0]).abs();
    let cuts = [[along, up], [along, across], [across, up]];
    let [a, b] = cuts.into_iter().fold(cuts[0], |best, cut| {
        // Only a clear gain in area counts, so that rounding errors do not choose the cross-section of a straight limb.
        if area(cut) > area(best) * 1.01 { cut } else { best }
    });
    let [y, z] = side(pose.translation);
    [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
        .map(|(of_a, of_b)| [y + of_a * a[0] + of_b * b[0], z + of_a * a[1] + of_b * b[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::world::Rotation;

    #[test]
    fn the_shipped_champions_path_leads_from_its_start_to_the_landing() {
        let loaded = shipped_champion().expect("well formed");
        let trial = &loaded.champion.trial;
        let Thumbnail { stairs_m, way_m, parts_m } =
            Thumbnail::of_champion(&loaded.champion, loaded.recording.as_ref());
        assert_eq!(stairs_m.len(), 22);
        assert_eq!((stairs_m[0], stairs_m[21]), ([3.0, 0.0], [trial.stairs.end_y_m(), 0.0]));
        assert_eq!(way_m.len(), 20);
        assert!((way_m[0][0] - trial.start_y_m).abs() < 0.01, "{way_m:?}");
        assert!((way_m[19][0] - loaded.champion.evaluation.centre_y_m).abs() < 0.01);
        assert_eq!(parts_m.len(), 5);
        let middle = parts_m[2].1.iter().fold([0.0, 0.0], |[y, z], at| [y + at[0], z + at[1]]);
        assert!((middle[0] / 4.0 - way_m[19][0]).abs() < 0.01, "about its centre");
        let history = KeyframeHistory::of(&loaded.champion.genome, trial, |_| true);
        let simulated = Thumbnail::of_history(&loaded.champion, &history.expect("not cancelled"));
        assert_eq!(simulated.way_m.len(), 20);
        let corners = |parts: &[(usize, [[f32; 2]; 4])]| {
            parts.iter().flat_map(|(_, corners)| *corners).collect::<Vec<_>>()
        };
        for (recorded, found) in corners(&parts_m).iter().zip(&corners(&simulated.parts_m)) {
            let is_near = recorded.iter().zip(found).all(|(a, b)| (a - b).abs() < 0.01);
            assert!(is_near, "the same end: {found:?} instead of {recorded:?}");
        }
        let without = Thumbnail::of_champion(&loaded.champion, None);
        assert_eq!((without.way_m.len(), without.parts_m.len()), (0, 0), "nothing is simulated");
    }

    #[test]
    fn a_limbs_corners_match_its_projection() {
        let size = [1.0, 2.0, 0.5];
        let extent = |rotation| {
            let corners = quad(&Pose::from_parts(Vector::new(9.0, 3.0, 1.0), rotation), size);
            [0, 1].map(|axis| {
                let of = corners.map(|corner| corner[axis]);
                of.into_iter().fold(f32::MIN, f32::max) - of.into_iter().fold(f32::MAX, f32::min)
            })
        };
        let quarter = std::f32::consts::FRAC_PI_2;
        for (rotation, expected) in [
            (Rotation::IDENTITY, [2.0, 0.5]),
            (Rotation::from_rotation_x(quarter), [0.5, 2.0]),
            (Rotation::from_rotation_y(quarter), [2.0, 1.0]),
            (Rotation::from_rotation_z(quarter), [1.0, 0.5]),
        ] {
            let found = extent(rotation);
            let is_near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1.0e-5);
            assert!(is_near, "{found:?} instead of {expected:?}");
        }
    }
}
