//! Outlines of a body's limbs at rest, from above and from the side.

use snakes_core::world::{BodyPlan, Pose, Vector};

/// Corners of all limbs of a body at rest.
#[derive(Debug)]
pub struct Outlines {
    corners_m: Vec<[Vector; 8]>,
    least_m: Vector,
    most_m: Vector,
}

impl Outlines {
    /// Computes the outlines of a body.
    pub fn of(body: &BodyPlan) -> Self {
        let poses = body.limb_poses(&body.rest_poses());
        let corners = |(limb, pose): (usize, &Pose)| -> [Vector; 8] {
            let half_m = Vector::from(body.limb_size_m(limb)) / 2.0;
            std::array::from_fn(|corner| {
                let side = |axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
                let at = Vector::new(side(0), side(1), side(2)) * half_m;
                pose.translation + pose.rotation * at
            })
        };
        let corners_m: Vec<[Vector; 8]> = poses.iter().enumerate().map(corners).collect();
        let all = || corners_m.iter().flatten().copied();
        let least_m = all().reduce(Vector::min).unwrap_or_default();
        let most_m = all().reduce(Vector::max).unwrap_or_default();
        Self { least_m, most_m, corners_m }
    }

    /// Returns the size of the whole body across, along and upwards, in metres.
    pub fn size_m(&self) -> [f32; 3] {
        (self.most_m - self.least_m).to_array()
    }

    /// Returns the outline of each limb as a convex polygon, with the head on the right as on the stage. A point is its
    /// distance to the right of the body's rear end and below its uppermost point, in metres. `side` is the axis of view:
    /// 0 is from above, and 2 is from the side.
    pub fn seen(&self, side: usize) -> Vec<Vec<[f32; 2]>> {
        let point = |at: &Vector| {
            let down = if side == 0 { at.x - self.least_m.x } else { self.most_m.z - at.z };
            [at.y - self.least_m.y, down]
        };
        self.corners_m.iter().map(|corners| hull(corners.iter().map(point).collect())).collect()
    }
}

/// Computes the convex hull of points, with its corners in order, by the monotone chain of Andrew (1979).
fn hull(mut points: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    points.sort_by(|[a, b], [c, d]| a.total_cmp(c).then(b.total_cmp(d)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = [f32; 2]>| {
        let mut chain: Vec<[f32; 2]> = Vec::new();
        for point in points {
            while let [.., before, last] = chain[..] {
                let cross = (last[0] - before[0]) * (point[1] - before[1])
                    - (last[1] - before[1]) * (point[0] - before[0]);
                // Opposite corners of a box can coincide in this view, apart from rounding errors.
                if cross > 1.0e-5 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut all = half(&mut points.iter().copied());
    all.extend(half(&mut points.iter().rev().copied()));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::shipped_champion;

    #[test]
    fn a22_a_chain_is_a_row_of_rectangles_with_the_head_on_the_right() {
        let body = shipped_champion().expect("shipped").champion.body();
        let outlines = Outlines::of(&body);
        assert_eq!(outlines.size_m(), [1.0, 10.0, 1.0]);
        for side in [0, 2] {
            let seen = outlines.seen(side);
            assert_eq!(seen.len(), 5);
            for (limb, corners) in seen.iter().rev().enumerate() {
                assert_eq!(corners.len(), 4, "{corners:?}");
                let along = corners.iter().map(|[along_m, _]| *along_m);
                assert_eq!(along.clone().fold(f32::MAX, f32::min), limb as f32 * 2.0);
                assert_eq!(along.fold(0.0, f32::max), limb as f32 * 2.0 + 2.0);
            }
        }
    }

    #[test]
    fn a_hull_has_the_outermost_points_in_order() {
        let points = vec![[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0], [2.0, 2.0]];
        assert_eq!(hull(points), [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
    }
}
