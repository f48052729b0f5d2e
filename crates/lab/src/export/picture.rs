//! A picture of a rollout at its present moment, computed ray by ray: it needs no graphics device, and equal states have equal pixels.

use std::ops::RangeInclusive;

use super::mjcf::{LIMB_COLORS, STEP_COLORS};
use crate::mesh::{Eyes, LIMB_EDGE};
use snakes_core::save::Picture;
use snakes_core::score::Rollout;
use snakes_core::world::{Pose, Vector};

/// Range of the width and the height of a picture, in pixels.
pub const PICTURE_SIDES: RangeInclusive<u64> = 16..=4096;

/// Vertical field of view of the camera, in rad.
const VIEW_RAD: f32 = 0.7;
/// Direction in which the camera looks.
const GAZE: Vector = Vector::new(-0.84, 0.32, -0.44);
/// Direction of the sun.
const SUN: Vector = Vector::new(0.5, -0.6, 1.0);
/// Share of its colour that a surface in the shadow keeps.
const SHADOW: f32 = 0.55;
/// Least distance of the camera from the middle of the snake, in metres.
const NEAREST_M: f32 = 11.0;
/// Distance at which the ground fades into the haze, in metres.
const HAZE_M: f32 = 80.0;
/// Least distance at which a ray meets a surface after it left another, in metres.
const APART_M: f32 = 1.0e-3;

const HAZE: Vector = Vector::new(0.89, 0.93, 0.96);
const ZENITH: Vector = Vector::new(0.52, 0.70, 0.90);
const GROUND: [Vector; 2] = [Vector::new(0.60, 0.63, 0.58), Vector::new(0.55, 0.58, 0.53)];
const EYE: Vector = Vector::new(0.97, 0.97, 0.97);
const PUPIL: Vector = Vector::new(0.05, 0.05, 0.06);

/// Draws the snake of a rollout and its stairs from the side. The camera follows the snake.
pub fn snapshot(rollout: &Rollout, width: u32, height: u32) -> Picture {
    let solids = solids(rollout);
    let camera = Camera::of(rollout, width, height);
    let sun = SUN.normalize();
    // A ray through each corner of a pixel; neighbours share it. The mean of four smooths the edges.
    let across = width as usize + 1;
    let corners: Vec<Vector> = (0..=height)
        .flat_map(|row| (0..=width).map(move |column| [column, row]))
        .map(|corner| {
            let direction = camera.direction(corner.map(|at| at as f32));
            color_along(&solids, camera.place, direction, sun)
        })
        .collect();
    let mut picture = Picture::new(width, height);
    for (index, pixel) in picture.rgb.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        let first = index / width as usize * across + index % width as usize;
        let four = [first, first + 1, first + across, first + across + 1];
        let sum: Vector = four.iter().filter_map(|corner| corners.get(*corner)).sum();
        *pixel = (sum / 4.0 * 255.0).to_array().map(|part| part.round() as u8);
    }
    picture
}

/// A camera that looks at the snake.
struct Camera {
    place: Vector,
    /// Directions to the middle of the picture, one pixel to the right, and one pixel down.
    axes: [Vector; 3],
    middle: [f32; 2],
}

impl Camera {
    fn of(rollout: &Rollout, width: u32, height: u32) -> Self {
        let limbs = rollout.body().limb_poses(rollout.poses());
        let places = limbs.iter().map(|pose| pose.translation);
        let middle_m = places.clone().sum::<Vector>() / limbs.len().max(1) as f32;
        let reach_m = places.map(|place| place.distance(middle_m)).fold(0.0, f32::max);
        let forward = GAZE.normalize();
        let right = forward.cross(Vector::Z).normalize();
        let pixel = 2.0 * libm::tanf(VIEW_RAD / 2.0) / height as f32;
        // A narrow picture shows the whole snake, too.
        let away = (height as f32 / width as f32).max(1.0);
        let place = middle_m - forward * NEAREST_M.max(reach_m * 2.8) * away;
        Self {
            place,
            axes: [forward, right * pixel, forward.cross(right) * pixel],
            middle: [width as f32 / 2.0, height as f32 / 2.0],
        }
    }

    fn direction(&self, [across, down]: [f32; 2]) -> Vector {
        let [forward, right, low] = self.axes;
        (forward + right * (across - self.middle[0]) + low * (down - self.middle[1])).normalize()
    }
}

/// A box or a ball.
struct DrawnSolid {
    centre: Vector,
    /// Directions of its edges.
    axes: [Vector; 3],
    /// Half its edges; 0 for a ball.
    half_m: Vector,
    /// Radius of the ball; 0 for a box.
    ball_m: f32,
    /// Radius of a ball around the whole solid, in metres.
    around_m: f32,
    color: Vector,
}

impl DrawnSolid {
    fn block(pose: Pose, half_m: Vector, color: Vector) -> Self {
        let axes = [Vector::X, Vector::Y, Vector::Z].map(|axis| pose.rotation * axis);
        let (centre, around_m) = (pose.translation, half_m.length());
        Self { centre, axes, half_m, ball_m: 0.0, around_m, color }
    }

    fn ball(centre: Vector, ball_m: f32, color: Vector) -> Self {
        let axes = [Vector::X, Vector::Y, Vector::Z];
        Self { centre, axes, half_m: Vector::ZERO, ball_m, around_m: ball_m, color }
    }

    /// Returns the distance at which a ray meets the solid from outside, and the normal of the surface there.
    fn meets(&self, from: Vector, direction: Vector) -> Option<(f32, Vector)> {
        let to = self.centre - from;
        let along_m = to.dot(direction);
        let beside_m2 = to.length_squared() - along_m * along_m;
        if beside_m2 > self.around_m * self.around_m || along_m < -self.around_m {
            return None;
        }
        if self.ball_m > 0.0 {
            let distance_m = along_m - (self.ball_m * self.ball_m - beside_m2).max(0.0).sqrt();
            return Some((distance_m, (direction * distance_m - to).normalize()));
        }
        let half_m = self.half_m.to_array();
        let (mut enters_m, mut leaves_m, mut normal) =
            (f32::NEG_INFINITY, f32::INFINITY, Vector::Z);
        for (axis, half_m) in self.axes.into_iter().zip(half_m) {
            let (away_m, speed) = (axis.dot(to), axis.dot(direction));
            let to_faces = [(away_m - half_m) / speed, (away_m + half_m) / speed];
            let (near_m, far_m) = (to_faces[0].min(to_faces[1]), to_faces[0].max(to_faces[1]));
            if near_m > enters_m {
                (enters_m, normal) = (near_m, axis * -speed.signum());
            }
            leaves_m = leaves_m.min(far_m);
        }
        if enters_m > leaves_m {
            return None;
        }
        Some((enters_m, normal))
    }
}

fn solids(rollout: &Rollout) -> Vec<DrawnSolid> {
    let colors = |colors: [[f32; 3]; 2]| colors.map(Vector::from);
    let (steps, limbs) = (colors(STEP_COLORS), colors(LIMB_COLORS));
    let stairs = rollout.stairs().solids().into_iter();
    let mut solids: Vec<DrawnSolid> = stairs
        .map(|of| DrawnSolid::block(of.pose, of.half_m, steps[of.step as usize % 2]))
        .collect();
    for (pose, part) in rollout.poses().iter().zip(&rollout.body().parts) {
        let half_m = Vector::from(part.size_m()) / 2.0;
        solids.push(DrawnSolid::block(*pose, half_m, limbs[part.limb % 2]));
    }
    if let Some((pose, head)) = rollout.poses().first().zip(rollout.body().parts.first()) {
        let size_m = Vector::from(head.size_m());
        let eyes = Eyes::of(size_m, size_m.min_element() * LIMB_EDGE);
        let balls = eyes.centres_m.map(|centre| (centre, eyes.radius_m, EYE)).into_iter();
        let pupils = eyes.pupils_m().map(|(centre, radius_m)| (centre, radius_m, PUPIL));
        let balls = balls.chain(pupils);
        solids.extend(
            balls.map(|(at, radius_m, color)| DrawnSolid::ball(*pose * at, radius_m, color)),
        );
    }
    solids
}

/// Returns the first surface that a ray meets: its distance, its normal and its colour.
fn first(
    solids: &[DrawnSolid],
    from: Vector,
    direction: Vector,
) -> Option<(f32, Vector, &DrawnSolid)> {
    let met = solids.iter().filter_map(|solid| {
        let (distance_m, normal) = solid.meets(from, direction)?;
        (distance_m > APART_M).then_some((distance_m, normal, solid))
    });
    met.min_by(|(a, ..), (b, ..)| a.total_cmp(b))
}

/// Returns the colour that a ray sees, each part from 0 to 1.
fn color_along(solids: &[DrawnSolid], from: Vector, direction: Vector, sun: Vector) -> Vector {
    let to_ground_m = if direction.z < 0.0 { -from.z / direction.z } else { f32::INFINITY };
    let met = first(solids, from, direction).filter(|(distance_m, ..)| *distance_m < to_ground_m);
    let (distance_m, normal, color) = match met {
        Some((distance_m, normal, solid)) => (distance_m, normal, solid.color),
        None if to_ground_m.is_finite() => {
            let at = from + direction * to_ground_m;
            let square = (at.x.floor() + at.y.floor()).rem_euclid(2.0) as usize;
            (to_ground_m, Vector::Z, GROUND[square.min(1)])
        }
        None => return HAZE.lerp(ZENITH, direction.z.clamp(0.0, 1.0).sqrt()),
    };
    let at = from + direction * distance_m + normal * APART_M;
    let towards = normal.dot(sun).max(0.0);
    let is_lit = towards > 0.0 && first(solids, at, sun).is_none();
    let light = if is_lit { SHADOW + (1.0 - SHADOW) * (0.25 + 0.75 * towards) } else { SHADOW };
    (color * light).lerp(HAZE, (distance_m / HAZE_M).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::shipped_champion;

    #[test]
    fn r10_a_picture_shows_red_and_blue_limbs_before_stairs_ground_and_sky() {
        let champion = shipped_champion().expect("well formed").champion;
        let mut rollout = Rollout::new(&champion.genome, &champion.trial);
        let first = snapshot(&rollout, 120, 80);
        assert_eq!(first, snapshot(&rollout, 120, 80), "equal states have equal pixels");
        let share = |picture: &Picture, is: fn(&[i32; 3]) -> bool| {
            let pixels = picture.rgb.as_chunks::<3>().0;
            let count = pixels.iter().filter(|pixel| is(&pixel.map(i32::from))).count();
            count as f32 / pixels.len() as f32
        };
        let red = share(&first, |[r, g, b]| r - g > 60 && r - b > 60);
        let blue = share(&first, |[r, g, b]| b - r > 60 && b - g > 40);
        assert!((0.02..0.4).contains(&red), "{red} of the picture is red");
        assert!((0.01..0.4).contains(&blue), "{blue} of the picture is blue");
        for _ in 0..120 {
            assert!(rollout.advance());
        }
        assert_ne!(first, snapshot(&rollout, 120, 80), "the snake has moved");
    }
}
