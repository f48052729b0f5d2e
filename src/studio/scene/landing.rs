//! Fittings of the stairs: a railing, a finish at the last step, and a wall with a doorway and
//! a light behind it, as the goal. The door has the size of a real door, which shows the scale of the scene.
//!
//! The fittings have no physics; they are beside and above the snake's way. Each lane has five meshes, which lanes
//! with the same stairs share.

use bevy::prelude::*;

use super::meshes::{BALL_SIDES, to_fading_mesh, to_mesh};
use snakes_core::schema::PerPart;
use snakes_core::world::Stairs;
use snakes_lab::mesh::MeshBuilder;

/// Height of the railing above treads and landing, in metres.
const RAIL_M: f32 = 1.0;
/// Radius of the railing's bars, in metres.
const RAIL_RADIUS_M: f32 = 0.04;
/// Maximum distance between the posts of the railing, in metres.
const POST_EVERY_M: f32 = 4.0;
/// Distance of the railing and of the finish's posts from the edge of the stairs, in metres.
const INSIDE_M: f32 = 0.1;
/// Clear height of the finish above the landing, in metres: a rearing snake fits below it.
pub(crate) const FINISH_M: f32 = 4.0;
/// Height of the finish's chequered board, in metres.
const BOARD_M: f32 = 0.5;
/// Distance of the finish behind the edge of the last step, in metres: behind the strip on the edge.
const BEHIND_EDGE_M: f32 = 0.2;
/// Radius of the lamps on the posts of the finish, in metres.
const LAMP_M: f32 = 0.14;
/// Depth of the chequered line on the floor, in metres.
const LINE_M: f32 = 0.5;
/// Height above the landing of the wall at its end, and thickness of the wall, in metres.
const WALL_M: f32 = 3.2;
const WALL_THICK_M: f32 = 0.25;
/// Width and height of the door, in metres.
const DOOR_M: [f32; 2] = [1.1, 2.1];
/// Distance that the light from the door reaches on the landing, in metres, and its opacity at the door.
const SHINE_M: f32 = 4.0;
const SHINE: f32 = 0.32;
/// Height of painted areas above their surface, in metres.
const PAINT_M: f32 = 0.006;
/// Minimum depth of a landing with a finish, in metres.
const SHORTEST_M: f32 = 1.0;

/// Returns the meshes of the fittings: those of wood, the wall, the white details, the lamps, and their light.
pub(super) fn fittings(stairs: &Stairs) -> [Mesh; 5] {
    let [wall, white, lamps] = goal(stairs).map(to_mesh);
    [to_mesh(railing(stairs)), wall, white, lamps, shine(stairs)]
}

/// Builds the railing on the left, which is behind the snake in the default view.
fn railing(stairs: &Stairs) -> MeshBuilder {
    let mut solid = MeshBuilder::default();
    let x_m = INSIDE_M - stairs.width_m / 2.0;
    let top_m = stairs.height_m(stairs.steps);
    let end_m = stairs.end_y_m();
    let at = |y_m: f32, z_m: f32| Vec3::new(x_m, y_m, z_m);
    // The handrail connects the middles of the treads, then follows the landing.
    let on_tread = |step: u32| {
        at(stairs.riser_y_m(step) + stairs.step_tread_m(step) / 2.0, stairs.height_m(step + 1))
    };
    let last = stairs.steps.saturating_sub(1);
    let mut bends: Vec<Vec3> = match (&stairs.rise_m, &stairs.tread_m) {
        (PerPart::All(_), PerPart::All(_)) => vec![on_tread(0), on_tread(last)],
        _ => (0..=last).map(on_tread).collect(),
    };
    bends.push(at(end_m, top_m));
    let straights = || bends.windows(2).map(|ends| (ends[0], ends[1]));
    let bar = |solid: &mut MeshBuilder, from: Vec3, to: Vec3, height_m: f32, radius_m: f32| {
        if from.distance(to) > 0.01 {
            solid.cylinder(from + Vec3::Z * height_m, to + Vec3::Z * height_m, radius_m);
        }
    };
    for (height_m, radius_m) in [(RAIL_M, RAIL_RADIUS_M), (RAIL_M / 2.0, RAIL_RADIUS_M * 0.6)] {
        straights().for_each(|(from, to)| bar(&mut solid, from, to, height_m, radius_m));
    }
    for (from, to) in straights() {
        let parts = (from.distance(to) / POST_EVERY_M).ceil().max(1.0) as usize;
        for part in 0..=parts {
            let on_bar = from.lerp(to, part as f32 / parts as f32);
            let foot = on_bar.with_z(stairs.surface_z_m(x_m, on_bar.y.min(end_m)).min(on_bar.z));
            solid.cylinder(foot, on_bar + Vec3::Z * RAIL_M, RAIL_RADIUS_M);
            solid.ball(on_bar + Vec3::Z * RAIL_M, RAIL_RADIUS_M * 1.4, BALL_SIDES);
        }
    }
    solid
}

/// Builds the light that falls out of the door onto the landing and onto the wall around the door.
fn shine(stairs: &Stairs) -> Mesh {
    let [width_m, height_m] = door_m(stairs);
    let (front_m, top_m) = (stairs.end_y_m() - WALL_THICK_M, stairs.height_m(stairs.steps));
    let last_m = stairs.step_tread_m(stairs.steps.saturating_sub(1));
    let reach_m = SHINE_M.min((stairs.landing_m + last_m - WALL_THICK_M) * 0.8).max(0.0);
    let half_m = stairs.width_m / 2.0;
    let [on_floor, on_wall] = [top_m + PAINT_M * 1.5, front_m - PAINT_M];
    let mut lit = MeshBuilder::default();
    lit.patch(8, 6, |column, row| {
        let (across, along) = (column as f32 / 4.0 - 1.0, 1.0 - row as f32 / 6.0);
        let x_m = across * (width_m / 2.0 + (half_m - width_m / 2.0) * along);
        [Vec3::new(x_m, front_m - reach_m * along, on_floor), Vec3::Z]
    });
    lit.patch(24, 4, |side, ring| {
        let (sin, cos) = libm::sincosf(std::f32::consts::PI * (1.0 - side as f32 / 24.0));
        let far = ring as f32 / 4.0;
        let x_m = cos * (width_m / 2.0 + (half_m - width_m / 2.0) * far);
        let z_m = sin * (height_m + (WALL_M - height_m) * far);
        [Vec3::new(x_m, on_wall, top_m + z_m), Vec3::NEG_Y]
    });
    let out_m = |at: &Vec3| (at.x.abs() - width_m / 2.0).max(0.0);
    to_fading_mesh(lit, |at| {
        let far = if at.z == on_floor {
            Vec2::new(out_m(at), front_m - at.y).length() / reach_m.max(0.01)
        } else {
            let above = ((at.z - top_m - height_m) / (WALL_M - height_m)).max(0.0);
            above.max(out_m(at) / (half_m - width_m / 2.0).max(0.01))
        };
        let left = (1.0 - far).clamp(0.0, 1.0);
        SHINE * left * left
    })
}

/// Returns the width and height of the door, in metres. The door is narrower on narrow stairs.
fn door_m(stairs: &Stairs) -> [f32; 2] {
    [DOOR_M[0].min(stairs.width_m * 0.6), DOOR_M[1]]
}

/// Builds the parts of the goal by their materials: the wall at the end of the landing, with the posts and the board of the
/// finish; in white, the chequered line on the floor, the squares on both sides of the board, and the door's frame; and as
/// lamps, the lit doorway, and the lamps on the posts and below the board.
fn goal(stairs: &Stairs) -> [MeshBuilder; 3] {
    let [mut wall, mut white, mut lamps] = <[MeshBuilder; 3]>::default();
    let (top_m, half_m) = (stairs.height_m(stairs.steps), stairs.width_m / 2.0);
    let middle = Vec3::new(0.0, stairs.end_y_m() - WALL_THICK_M / 2.0, top_m + WALL_M / 2.0);
    wall.rounded_box(middle, Vec3::new(stairs.width_m, WALL_THICK_M, WALL_M), 0.03, 1);
    let threshold = Vec3::new(0.0, stairs.end_y_m() - WALL_THICK_M, top_m);
    let [door_width_m, door_height_m] = door_m(stairs);
    let middle = threshold + Vec3::new(0.0, -PAINT_M, door_height_m / 2.0);
    lamps.sheet(middle, Vec3::X * door_width_m / 2.0, Vec3::Z * door_height_m / 2.0);
    let last = stairs.steps.saturating_sub(1);
    if stairs.landing_m + stairs.step_tread_m(last) - stairs.step_slope_m(last) >= SHORTEST_M {
        let floor = Vec3::new(0.0, finish_y_m(stairs), top_m);
        let below_board = floor + Vec3::Z * FINISH_M;
        let half = Vec3::X * (half_m - INSIDE_M);
        lamps.cylinder(below_board - half, below_board + half, LAMP_M / 4.0);
        for end in [half, -half] {
            wall.cylinder(floor + end, below_board + end + Vec3::Z * BOARD_M, 0.07);
            lamps.ball(below_board + end + Vec3::Z * (BOARD_M + LAMP_M), LAMP_M, BALL_SIDES);
        }
        let board = below_board + Vec3::Z * BOARD_M / 2.0;
        wall.rounded_box(board, Vec3::new(stairs.width_m, 0.06, BOARD_M), 0.01, 1);
        let line = floor + Vec3::new(0.0, LINE_M / 2.0, PAINT_M);
        let out = Vec3::Y * 0.036;
        for (middle, right, up) in [
            (line, Vec3::X, Vec3::Y * LINE_M / 2.0),
            (board - out, Vec3::X, Vec3::Z * BOARD_M / 2.0),
            (board + out, Vec3::NEG_X, Vec3::Z * BOARD_M / 2.0),
        ] {
            squares(&mut white, middle, right * half_m, up);
        }
    }
    // A bright frame around the door.
    white.tone(Vec3::ONE);
    for side in [1.0, -1.0] {
        let aside_m = (door_width_m / 2.0 + 0.06) * side;
        let post = threshold + Vec3::new(aside_m, 0.0, door_height_m / 2.0);
        white.rounded_box(post, Vec3::new(0.12, 0.08, door_height_m), 0.01, 1);
    }
    let lintel = threshold + Vec3::Z * (door_height_m + 0.06);
    white.rounded_box(lintel, Vec3::new(door_width_m + 0.24, 0.08, 0.12), 0.01, 1);
    [wall, white, lamps]
}

/// Adds two rows of white and dark squares around `middle`. `right` and `up` lead from the middle to the edges.
fn squares(solid: &mut MeshBuilder, middle: Vec3, right: Vec3, up: Vec3) {
    let columns = (right.length() / up.length() * 2.0).round().max(2.0) as usize;
    let (half, tall) = (right / columns as f32, up / 2.0);
    for column in 0..columns {
        for row in 0..2 {
            let is_dark = (column + row) % 2 == 0;
            solid.tone(Vec3::splat(if is_dark { 0.02 } else { 1.0 }));
            let across = (column as f32 + 0.5) * 2.0 - columns as f32;
            let at = middle + half * across + tall * (row as f32 * 2.0 - 1.0);
            solid.sheet(at, half, tall);
        }
    }
}

/// Returns the position of the finish on the y axis, in metres: behind the edge of the last step. A snake has landed
/// when its middle block is at this position.
pub(crate) fn finish_y_m(stairs: &Stairs) -> f32 {
    stairs.landing_y_m() + BEHIND_EDGE_M
}

/// Returns the middle and half the size of a box around the last riser and the finish, in metres; `None` without stairs.
pub(super) fn gate(stairs: &Stairs) -> Option<[Vec3; 2]> {
    let last_m = stairs.height_m(stairs.steps.checked_sub(1)?);
    let top_m = stairs.height_m(stairs.steps) + FINISH_M + BOARD_M;
    let middle = Vec3::new(0.0, finish_y_m(stairs), (last_m + top_m) / 2.0);
    Some([middle, Vec3::new(stairs.width_m / 2.0, BEHIND_EDGE_M, (top_m - last_m) / 2.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(stairs: &Stairs) -> [MeshBuilder; 4] {
        let [wall, white, lamps] = goal(stairs);
        [railing(stairs), wall, white, lamps]
    }

    #[test]
    fn nothing_stands_in_the_way_of_the_snake() {
        let stairs = Stairs { landing_m: 40.0, ..Stairs::default() };
        for solid in parts(&stairs) {
            for at in &solid.positions {
                let is_on_way = at.x.abs() < stairs.width_m / 2.0 - 0.3
                    && at.y < stairs.end_y_m() - 0.5
                    && (0.02..FINISH_M - 0.1).contains(&(at.z - stairs.surface_z_m(at.x, at.y)));
                assert!(!is_on_way, "{at}");
            }
        }
    }

    #[test]
    fn the_gate_is_around_the_board_and_the_last_edge() {
        let stairs = Stairs::default();
        let [middle, half] = gate(&stairs).expect("stairs");
        let [from, to] = [middle - half, middle + half];
        let top_m = stairs.height_m(stairs.steps);
        assert!(from.y <= stairs.landing_y_m() && from.z < top_m && to.z >= top_m + FINISH_M);
        assert!(gate(&Stairs { steps: 0, ..stairs }).is_none(), "flat ground");
    }

    #[test]
    fn stairs_of_any_shape_have_finite_fittings_within_their_width() {
        for (steps, width_m, landing_m, tread_m) in
            [(1, 1.0, 0.0, 0.1), (100, 100.0, 100.0, 20.0), (3, 5.0, 0.5, 2.0)]
        {
            let tread_m = PerPart::All(tread_m);
            let stairs = Stairs { steps, width_m, landing_m, tread_m, ..Stairs::default() };
            for at in parts(&stairs).iter().flat_map(|solid| &solid.positions) {
                assert!(at.is_finite() && at.x.abs() <= width_m / 2.0 + 0.05, "{at} of {stairs:?}");
            }
        }
    }
}
