//! Plants around the lanes: grass, bushes and trees. They have no physics, and stand away from the snakes' ways and from the usual places
//! of the camera.

use bevy::prelude::*;

use super::meshes::to_mesh;
use super::props::{Props, piece};
use super::surface_texture::random;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::theme::palette::TRUNK_TONE;
use snakes_lab::mesh::MeshBuilder;

/// Plants around the lanes of the stage.
#[derive(Component, Debug)]
pub(super) struct Plants;

/// Least side of the squares of which each has at most one plant, in metres. Beside long stairs, squares are larger.
const SQUARE_M: f32 = 3.0;
/// Maximum number of squares along the lanes.
const MOST_SQUARES: f32 = 40.0;
/// Number of squares around the lanes in the directions of -x, which is behind the lanes in the default view, +x, -y and +y.
const SQUARES: [i32; 4] = [18, 9, 6, 14];
/// Distances from the lanes beyond which there are grass, bushes and trees, in metres.
const GRASS_M: f32 = 2.0;
const BUSHES_M: f32 = 5.0;
const TREES_M: f32 = 20.0;

/// Plants the surroundings of the lanes anew after their area has changed.
pub(super) fn plant(
    lanes: Query<&Lane>,
    props: Res<Props>,
    plants: Query<Entity, With<Plants>>,
    mut planted: Local<Option<Rect>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut commands: Commands,
) {
    let ways = lanes.iter().filter(|lane| !lane.is_ghost).map(|lane| {
        let (trial, x_m) = (lane.trial(), lane.offset().x);
        let half_m = trial.stairs.width_m / 2.0;
        let start = Vec2::new(x_m - half_m, trial.start_y_m - lane.body.length_m() / 2.0);
        Rect::from_corners(start, Vec2::new(x_m + half_m, trial.stairs.end_y_m()))
    });
    let area = ways.reduce(|all, way| all.union(way));
    let Some(area) = area.filter(|area| *planted != Some(*area)) else { return };
    *planted = Some(area);
    plants.iter().for_each(|plants| commands.entity(plants).despawn());
    commands.spawn((Plants, piece(&meshes.add(to_mesh(around(area))), &props.leaves)));
}

/// Builds the plants around an area of x and y, in metres. The same area always has the same plants.
fn around(area: Rect) -> MeshBuilder {
    let mut solid = MeshBuilder::default();
    let [behind, before, back, ahead] = SQUARES;
    let square_m = (area.size().max_element() / MOST_SQUARES).max(SQUARE_M);
    let squares = |m: f32| libm::ceilf(m / square_m) as i32;
    let (across, along) = (squares(area.width()), squares(area.height()));
    for column in -behind..across + before {
        for row in -back..along + ahead {
            let chance = |salt: u32| random(column as u32, row as u32, 71 + salt);
            let in_square = Vec2::new(column as f32 + chance(0), row as f32 + chance(1));
            let at = area.min + in_square * square_m;
            let aside_m = at.distance(at.clamp(area.min, area.max));
            // The camera is usually on the side of +x, where high plants would hide the snakes.
            let is_behind = at.x < area.min.x || at.y > area.max.y + BUSHES_M;
            let at = at.extend(0.0);
            if is_behind && aside_m > TREES_M && chance(2) < 0.07 {
                tree(&mut solid, at, 2.6 + 2.4 * chance(3), &chance);
            } else if is_behind && aside_m > BUSHES_M && chance(4) < 0.12 {
                bush(&mut solid, at, 0.35 + 0.5 * chance(5), &chance);
            } else if aside_m > GRASS_M && chance(6) < 0.55 {
                grass(&mut solid, at, &chance);
            }
        }
    }
    solid
}

/// Adds a tuft of grass whose blades bend outward.
fn grass(solid: &mut MeshBuilder, at: Vec3, chance: &dyn Fn(u32) -> f32) {
    let first = solid.positions.len();
    for blade in 0..5 + (chance(10) * 4.0) as u32 {
        let salt = 20 + blade * 4;
        let (sin, cos) = libm::sincosf(chance(salt) * std::f32::consts::TAU);
        let foot = at + Vec3::new(cos, sin, 0.0) * 0.16 * chance(salt + 1);
        let (right, out) = (Vec3::new(-sin, cos, 0.0) * 0.035, Vec3::new(cos, sin, 0.0));
        let tip = foot + out * 0.14 + Vec3::Z * (0.18 + 0.22 * chance(salt + 2));
        solid.tone(Vec3::splat(0.85 + 0.6 * chance(salt + 3)));
        solid.triangle([foot - right, foot + right, tip]);
    }
    // Blades that are lit as the ground is do not flicker when the camera turns.
    solid.normals[first..].fill(Vec3::Z);
}

/// Adds a bush of several balls of leaves.
fn bush(solid: &mut MeshBuilder, at: Vec3, size_m: f32, chance: &dyn Fn(u32) -> f32) {
    for ball in 0..4 {
        let salt = 60 + ball * 4;
        let aside = Vec3::new(chance(salt) - 0.5, chance(salt + 1) - 0.5, 0.0) * size_m * 2.2;
        let radius_m = size_m * (0.6 + 0.4 * chance(salt + 2));
        solid.tone(Vec3::splat(0.7 + 0.4 * chance(salt + 3)));
        solid.ball(at + aside + Vec3::Z * radius_m * 0.55, radius_m, 8);
    }
}

/// Adds a tree with a trunk and a crown of several balls of leaves.
fn tree(solid: &mut MeshBuilder, at: Vec3, height_m: f32, chance: &dyn Fn(u32) -> f32) {
    solid.tone(TRUNK_TONE);
    solid.cylinder(at, at + Vec3::Z * height_m * 0.7, height_m * 0.05);
    for ball in 0..5 {
        let salt = 80 + ball * 4;
        let share = ball as f32 / 4.0;
        let aside = Vec3::new(chance(salt) - 0.5, chance(salt + 1) - 0.5, 0.0);
        let middle = at
            + aside * height_m * 0.42 * (1.1 - share)
            + Vec3::Z * height_m * (0.62 + 0.42 * share);
        // The crown is darker below, where less light arrives.
        solid.tone(Vec3::splat(0.62 + 0.35 * share + 0.15 * chance(salt + 2)));
        solid.ball(middle, height_m * (0.28 - 0.09 * share), 10);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plants_leave_the_ways_of_the_snakes_free_and_the_view_from_the_right_open() {
        let area = Rect::new(-2.5, -15.0, 2.5, 43.0);
        let plants = around(area);
        let aside_m = |at: &Vec3| at.truncate().distance(at.truncate().clamp(area.min, area.max));
        assert!(plants.positions.iter().all(|at| aside_m(at) > GRASS_M - 0.4));
        let hides = |at: &Vec3| at.x > area.max.x && at.y < area.max.y && at.z > 0.5;
        assert!(!plants.positions.iter().any(hides));
        assert!(
            plants.positions.iter().all(|at| at.is_finite()) && plants.positions.len() < 50_000
        );
        assert_eq!(plants.positions, around(area).positions);
        let long = around(Rect::new(-50.0, -15.0, 50.0, 2_100.0));
        assert!(long.positions.len() < 200_000, "{}", long.positions.len());
    }
}
