//! What is painted beside and on the stairs: the distance along the lane, and the steps' numbers.

use bevy::light::NotShadowCaster;
use bevy::prelude::*;

use super::Frame;
use super::lane::Lane;
use super::lettering::{Lettering, Place, Writing};
use crate::score::Trial;
use crate::world::Stairs;

/// Every so many metres a number.
const NUMBER_EVERY_M: i32 = 5;
/// Height of the ground's digits, in metres.
const DIGIT_M: f32 = 0.7;
/// How far beside the stairs the scale runs, in metres.
const ASIDE_M: f32 = 0.35;
/// Length of the mark at each number, in metres, and at each metre between them.
const LONG_MARK_M: f32 = 0.7;
const SHORT_MARK_M: f32 = 0.3;
/// Width of a mark, in metres.
const MARK_M: f32 = 0.07;
/// How much of the numbers' paint the scale has.
const SCALE_OPACITY: f32 = 0.62;
/// How far paint is above what it is painted on, in metres: higher than the ground's grid.
const PAINT_M: f32 = 0.015;
/// A step's number is so high, as a share of its rise.
const NUMBER_SHARE: f32 = 0.5;
/// The most height of a step's number, in metres.
const MOST_NUMBER_M: f32 = 0.5;
/// From the stairs' right edge to the middle of a step's number, in metres.
const NUMBER_ASIDE_M: f32 = 0.45;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, paint.in_set(Frame::Draw));
}

/// Paints the lane of a lane that is new.
fn paint(
    lanes: Query<(Entity, &Lane), Added<Lane>>,
    lettering: Res<Lettering>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut commands: Commands,
) {
    for (entity, lane) in &lanes {
        let mut writing = lettering.begin();
        if lane.number() == 0 {
            // The nearest one's serves all. What is large needs less paint to be read than what is small.
            writing.thin(SCALE_OPACITY);
            scale(&mut writing, lane.trial());
            writing.thin(1.0);
        }
        numbers(&mut writing, &lane.trial().stairs);
        commands.entity(entity).with_child((
            Mesh3d(meshes.add(writing.into_mesh())),
            MeshMaterial3d(lettering.paint.clone()),
            NotShadowCaster,
        ));
    }
}

/// Metres along the lane, to be read from the right of the stairs.
fn scale(writing: &mut Writing<'_>, trial: &Trial) {
    let start_m = trial.start_y_m - trial.agent.length_m() / 2.0;
    let begin = (start_m / NUMBER_EVERY_M as f32).floor() as i32 * NUMBER_EVERY_M;
    let end = trial.stairs.end_y_m() as i32;
    let edge_m = trial.stairs.width_m / 2.0 + ASIDE_M;
    let place = |x_m: f32, y_m: i32| Place {
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

/// The steps' numbers on their risers.
fn numbers(writing: &mut Writing<'_>, stairs: &Stairs) {
    let digit_m = (stairs.rise_m * NUMBER_SHARE).min(MOST_NUMBER_M);
    for step in 0..stairs.steps {
        let place = Place {
            middle: Vec3::new(
                stairs.width_m / 2.0 - NUMBER_ASIDE_M,
                stairs.riser_y_m(step) - PAINT_M,
                stairs.rise_m * (step as f32 + 0.46),
            ),
            right: Dir3::X,
            up: Dir3::Z,
        };
        writing.text(&(step + 1).to_string(), digit_m, place);
    }
}
