//! Labels on the ground and the stairs: a scale of distances along the lane, and step numbers.

use bevy::prelude::*;

use super::text::{TextMeshBuilder, TextMeshes, TextPlacement};
use crate::studio::stage::lane::Lane;
use snakes_core::world::Stairs;

/// Distance between the numbers of the scale, in metres.
const NUMBER_EVERY_M: i32 = 5;
/// Height of the scale's digits, in metres.
const DIGIT_M: f32 = 0.7;
/// Distance between the scale and the stairs, in metres.
const ASIDE_M: f32 = 0.5;
/// Length of the scale's marks at numbers, and of those at each metre between them, in metres.
const LONG_MARK_M: f32 = 0.7;
const SHORT_MARK_M: f32 = 0.3;
/// Width of a mark of the scale, in metres.
const MARK_M: f32 = 0.07;
/// Opacity of the scale, as a fraction of the step numbers' opacity.
const SCALE_OPACITY: f32 = 0.62;
/// Height of painted labels above their surface, in metres: above the grid.
const PAINT_M: f32 = 0.015;
/// Height of a step's number, as a fraction of the step's rise.
const NUMBER_SHARE: f32 = 0.5;
/// Maximum height of a step's number, in metres.
const MAX_NUMBER_M: f32 = 0.5;
/// Distance from the right edge of the stairs to the middle of a step's number, in metres.
const NUMBER_ASIDE_M: f32 = 0.45;

/// Builds the labels of a lane.
pub(super) fn labels(lane: &Lane, lettering: &TextMeshes) -> Mesh {
    let mut writing = lettering.begin();
    if lane.number == 0 {
        // Only the nearest lane is labelled. The scale's large digits need less contrast than small ones.
        writing.opacity = SCALE_OPACITY;
        scale(&mut writing, lane);
        writing.opacity = 1.0;
    }
    numbers(&mut writing, &lane.trial().stairs);
    writing.into_mesh()
}

/// Adds the scale of distances along the lane, readable from the right of the stairs.
fn scale(writing: &mut TextMeshBuilder<'_>, lane: &Lane) {
    let trial = lane.trial();
    let start_m = trial.start_y_m - lane.body.length_m() / 2.0;
    let begin = (start_m / NUMBER_EVERY_M as f32).floor() as i32 * NUMBER_EVERY_M;
    let end = trial.stairs.end_y_m() as i32;
    let edge_m = trial.stairs.width_m / 2.0 + ASIDE_M;
    let place = |x_m: f32, y_m: i32| TextPlacement {
        middle: Vec3::new(x_m, y_m as f32, PAINT_M),
        right: Dir3::Y,
        up: Dir3::NEG_X,
    };
    for y_m in begin..=end {
        let is_numbered = y_m % NUMBER_EVERY_M == 0;
        let length_m = if is_numbered { LONG_MARK_M } else { SHORT_MARK_M };
        writing.bar(MARK_M, length_m, place(edge_m + length_m / 2.0, y_m));
        if is_numbered {
            let below_m = edge_m + LONG_MARK_M + DIGIT_M;
            writing.text(&format!("{y_m} m"), DIGIT_M, place(below_m, y_m));
        }
    }
}

/// Adds step numbers on the risers, under the nosings, and on the slopes. Steps that lead down have none, because they face away.
fn numbers(writing: &mut TextMeshBuilder<'_>, stairs: &Stairs) {
    for step in (0..stairs.steps).filter(|&step| stairs.step_rise_m(step) > 0.0) {
        let (rise_m, slope_m) = (stairs.step_rise_m(step), stairs.step_slope_m(step));
        let (below_m, nosing_m) = (stairs.height_m(step), stairs.step_nosing_m(step));
        let digit_m = (rise_m * NUMBER_SHARE).min(MAX_NUMBER_M);
        let riser = Vec3::new(0.0, slope_m, rise_m);
        // Under a nosing, the number is on the lower part of the riser, which is visible from far away.
        let share = if nosing_m > 0.0 { 0.3 } else { 0.46 };
        let foot =
            Vec3::new(stairs.width_m / 2.0 - NUMBER_ASIDE_M, stairs.riser_y_m(step), below_m);
        let up = Dir3::new(riser).unwrap_or(Dir3::Z);
        let out = Vec3::X.cross(*up) * -PAINT_M;
        let place = TextPlacement { middle: foot + riser * share - out, right: Dir3::X, up };
        writing.text(&(step + 1).to_string(), digit_m, place);
    }
}
