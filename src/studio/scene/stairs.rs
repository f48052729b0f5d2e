//! Shapes of the stairs of a lane and of the strip of ground before them.

use bevy::prelude::*;

use snakes_core::world::{StairBox, Stairs};
use snakes_lab::mesh::MeshBuilder;

/// Width by which the strip of ground extends beyond the stairs on each side, in metres.
pub(crate) const STRIP_ASIDE_M: f32 = 0.4;
/// Length of the strip of ground behind the snake, in metres.
const STRIP_BEHIND_M: f32 = 3.0;
/// Length of the strip of ground ahead of the snake where there are no stairs, in metres.
const STRIP_AHEAD_M: f32 = 40.0;
/// Height of the strip of ground above the ground, in metres: below the lines of the grid.
const STRIP_M: f32 = 0.004;
/// Brightness factor of every other step, so that adjacent treads of the same material can be told apart.
const OTHER_STEP: f32 = 0.86;

/// Brightness factor in the corner between a tread and the next riser, where less of the sky is seen.
const CORNER: f32 = 0.6;
/// Distance from that corner at which the shade ends on the tread, in metres.
const CORNER_M: f32 = 0.5;

/// Builds the stairs as one closed solid. Adjacent boxes would have hidden faces, which would cast shadows on the visible ones.
pub(super) fn solid(stairs: &Stairs) -> MeshBuilder {
    let mut solid = MeshBuilder::default();
    let half_m = stairs.width_m / 2.0;
    let outline = stairs.outline_m();
    let mut corner = 0;
    for step in 0..stairs.steps {
        solid.tone(tone_of(step));
        // The faces of a step: the riser or slope, two faces of a nosing if there is one, and the tread.
        let faces = if stairs.step_nosing_m(step) > 0.0 { 4 } else { 2 };
        for ends in outline[corner..=corner + faces].windows(2) {
            let [from, to] = [ends[0], ends[1]].map(|[y_m, z_m]| Vec3::new(0.0, y_m, z_m));
            // A tread at ground level is drawn with the strip of ground.
            if from == to || from.z.max(to.z) <= 0.0 {
                continue;
            }
            // A deep tread has a line of vertices where the shade of its corner ends.
            let reach = CORNER_M / from.distance(to);
            let middle = if reach < 1.0 { to.lerp(from, reach) } else { from };
            for (from, to) in [(from, middle), (middle, to)] {
                if from != to {
                    solid.sheet((from + to) / 2.0, Vec3::X * half_m, (to - from) / 2.0);
                }
            }
        }
        corner += faces;
    }
    // The corners between a tread and the next riser, where the outline turns upward.
    let points: Vec<Vec2> = outline.iter().map(|point| Vec2::from(*point)).collect();
    let turns_up = |of: &&[Vec2]| (of[1] - of[0]).perp_dot(of[2] - of[1]) > 0.0;
    let inner: Vec<Vec2> = points.windows(3).filter(turns_up).map(|of| of[1]).collect();
    solid.shade(
        |at| if inner.iter().any(|of| at.yz().distance(*of) < 1.0e-3) { CORNER } else { 1.0 },
    );
    sides(&mut solid, stairs);
    if let Some([end_m, top_m]) = outline.last().filter(|[_, top_m]| *top_m > 0.0) {
        let back = Vec3::new(0.0, *end_m, top_m / 2.0);
        solid.sheet(back, Vec3::NEG_X * half_m, Vec3::Z * top_m / 2.0);
    }
    for [from_m, to_m] in raised_m(stairs) {
        let bottom = Vec3::new(0.0, (from_m + to_m) / 2.0, 0.0);
        solid.sheet(bottom, Vec3::NEG_X * half_m, Vec3::Y * (to_m - from_m) / 2.0);
    }
    solid
}

/// Returns the brightness factor of a step for red, green and blue.
fn tone_of(step: u32) -> Vec3 {
    Vec3::splat(if step.is_multiple_of(2) { 1.0 } else { OTHER_STEP })
}

/// Returns the ranges of y, in metres, where the stairs touch the ground: those of their boxes, and of slopes that
/// begin or end at ground level.
fn raised_m(stairs: &Stairs) -> Vec<[f32; 2]> {
    let boxes = stairs.boxes().into_iter().filter(|of| of.min_m[2] == 0.0);
    let slopes_here = |step: &u32| {
        let lower_m = stairs.height_m(*step).min(stairs.height_m(step + 1));
        stairs.step_slope_m(*step) > 0.0 && lower_m == 0.0
    };
    let slopes = (0..stairs.steps).filter(slopes_here);
    let slopes = slopes.map(|step| [stairs.riser_y_m(step), stairs.tread_y_m(step)]);
    boxes.map(|of| [of.min_m[1], of.max_m[1]]).chain(slopes).collect()
}

/// Adds both sides of the stairs, down to the ground.
fn sides(solid: &mut MeshBuilder, stairs: &Stairs) {
    let half_m = stairs.width_m / 2.0;
    for StairBox { step, min_m, max_m } in stairs.boxes() {
        solid.tone(tone_of(step));
        let (middle, half) =
            ((Vec3::from(min_m) + Vec3::from(max_m)) / 2.0, Vec3::from(max_m) - Vec3::from(min_m));
        let (along, up) = (Vec3::Y * half.y / 2.0, Vec3::Z * half.z / 2.0);
        for side in [1.0, -1.0] {
            solid.sheet(middle.with_x(half_m * side), along * side, up);
        }
    }
    for step in (0..stairs.steps).filter(|&step| stairs.step_slope_m(step) > 0.0) {
        solid.tone(tone_of(step));
        let foot = [stairs.riser_y_m(step), stairs.height_m(step)];
        let top = [stairs.tread_y_m(step), stairs.height_m(step + 1)];
        // The triangle above the lower level of the slope. On a slope down, its corner is below the upper end.
        let corner = if top[1] > foot[1] { [top[0], foot[1]] } else { [foot[0], top[1]] };
        for x_m in [half_m, -half_m] {
            let [foot, corner, top] = [foot, corner, top].map(|[y, z]| Vec3::new(x_m, y, z));
            solid.triangle(if x_m > 0.0 { [foot, corner, top] } else { [foot, top, corner] });
        }
    }
}

/// Returns the start and the end of the strip of ground along y, in metres. The snake's tail begins at `start_m`.
pub(crate) fn strip_y_m(stairs: &Stairs, start_m: f32) -> [f32; 2] {
    let from_m = start_m - STRIP_BEHIND_M;
    let to_m = if stairs.steps == 0 { start_m + STRIP_AHEAD_M } else { stairs.first_riser_y_m };
    [from_m, to_m.max(from_m)]
}

/// Builds the strip of ground before the stairs, and the treads at ground level. The physical ground is infinite; the
/// strip shows its surface.
pub(super) fn strip(stairs: &Stairs, start_m: f32) -> MeshBuilder {
    let mut solid = MeshBuilder::default();
    let [from_m, to_m] = strip_y_m(stairs, start_m);
    let middle = Vec3::new(0.0, (from_m + to_m) / 2.0, STRIP_M);
    let half_width = Vec3::X * (stairs.width_m / 2.0 + STRIP_ASIDE_M);
    solid.sheet(middle, half_width, Vec3::Y * (to_m - from_m) / 2.0);
    let outline = stairs.outline_m();
    for ends in outline.windows(2).filter(|ends| ends[0][1] == 0.0 && ends[1][1] == 0.0) {
        let [from_m, to_m] = [ends[0][0], ends[1][0]];
        let middle = Vec3::new(0.0, (from_m + to_m) / 2.0, STRIP_M);
        solid.sheet(middle, Vec3::X * stairs.width_m / 2.0, Vec3::Y * (to_m - from_m) / 2.0);
    }
    solid
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples() -> [Stairs; 3] {
        [Stairs::default(), Stairs { nosing_m: 0.3, ..Stairs::default() }, Stairs::uneven()]
    }

    #[test]
    fn every_point_of_the_stairs_lies_on_the_solids_of_the_physics() {
        for stairs in samples() {
            let solids = stairs.solids();
            for at in &solid(&stairs).positions {
                let is_on = |of: &snakes_core::world::StairSolid| {
                    (of.pose.inverse() * *at).abs().cmple(of.half_m + 1.0e-4).all()
                };
                assert!(solids.iter().any(is_on), "{at} of {stairs:?}");
            }
        }
        let top_m = solid(&Stairs::default()).positions.iter().map(|at| at.z).fold(0.0, f32::max);
        assert_eq!(top_m, 5.0);
    }

    #[test]
    fn the_stairs_have_the_volume_below_their_outline_and_face_outward() {
        for stairs in samples() {
            let solid = solid(&stairs);
            let volume = solid.volume_m3();
            // The area between the outline and the ground, as a sum of trapezia.
            let outline = stairs.outline_m();
            let area: f32 = outline
                .windows(2)
                .map(|ends| (ends[1][0] - ends[0][0]) * (ends[0][1] + ends[1][1]) / 2.0)
                .sum();
            let expected = area * stairs.width_m;
            assert!((volume / expected - 1.0).abs() < 1.0e-4, "{volume} of {expected}");
        }
    }

    #[test]
    fn the_strip_of_ground_reaches_from_behind_the_snake_to_the_first_riser() {
        let stairs = Stairs::default();
        assert_eq!(strip_y_m(&stairs, -12.0), [-15.0, 3.0]);
        let flat = Stairs { steps: 0, ..Stairs::default() };
        assert!(strip_y_m(&flat, -12.0)[1] > 20.0);
    }
}
