//! Colours of lanes side by side: a collar on each snake, and stripes on the ground beside its lane.

use bevy::prelude::*;

use super::stairs::{STRIP_ASIDE_M, strip_y_m};
use crate::studio::stage::lane::Lane;
use snakes_core::world::Stairs;
use snakes_lab::mesh::MeshBuilder;

/// Marks an entity that shows the colour of its lane. It is hidden while there is only one lane.
#[derive(Component, Debug)]
pub(crate) struct LaneMark;

/// Width of a stripe, in metres.
const STRIPE_M: f32 = 0.16;
/// Height of a stripe above the ground, in metres: above the grid.
const STRIPE_HEIGHT_M: f32 = 0.013;

/// Builds a stripe on each side of a lane, from behind the snake to the end of the landing.
pub(super) fn stripes(stairs: &Stairs, start_m: f32) -> MeshBuilder {
    let mut solid = MeshBuilder::default();
    let [from_m, to_m] = strip_y_m(stairs, start_m);
    let to_m = if stairs.steps == 0 { to_m } else { stairs.end_y_m() };
    let aside_m = stairs.width_m / 2.0 + STRIP_ASIDE_M - STRIPE_M / 2.0;
    for side in [1.0, -1.0] {
        let middle = Vec3::new(aside_m * side, (from_m + to_m) / 2.0, STRIPE_HEIGHT_M);
        solid.sheet(middle, Vec3::X * STRIPE_M / 2.0, Vec3::Y * (to_m - from_m) / 2.0);
    }
    solid
}

/// Shows the lanes' colours while several snakes are side by side, and hides them otherwise.
pub(super) fn show(lanes: Query<&Lane>, mut marks: Query<&mut Visibility, With<LaneMark>>) {
    let are_many = lanes.iter().filter(|lane| !lane.is_ghost).nth(1).is_some();
    let wanted = if are_many { Visibility::Inherited } else { Visibility::Hidden };
    marks.iter_mut().for_each(|mut mark| {
        mark.set_if_neq(wanted);
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::climber;

    #[test]
    fn marks_are_shown_only_beside_other_lanes_and_ghosts_are_none() {
        let lane = |number| Lane::new(climber(number), number);
        let mut app = App::new();
        app.add_systems(Update, show);
        let mark = app.world_mut().spawn((LaneMark, Visibility::Hidden)).id();
        let seen = |app: &mut App| {
            app.update();
            *app.world().entity(mark).get::<Visibility>().expect("it has one")
        };
        app.world_mut().spawn(lane(0));
        app.world_mut().spawn(lane(1).into_ghost());
        assert_eq!(seen(&mut app), Visibility::Hidden);
        app.world_mut().spawn(lane(2));
        assert_eq!(seen(&mut app), Visibility::Inherited);
    }

    #[test]
    fn stripes_accompany_the_lane_from_the_start_to_the_end_of_the_landing() {
        let stripes = stripes(&Stairs::default(), -12.0);
        let ys = || stripes.positions.iter().map(|at| at.y);
        assert_eq!(ys().fold(f32::MAX, f32::min), -15.0);
        assert_eq!(ys().fold(f32::MIN, f32::max), Stairs::default().end_y_m());
        assert!(stripes.positions.iter().all(|at| (2.7..3.0).contains(&at.x.abs())));
    }
}
